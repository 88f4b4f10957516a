# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the tests beside it in the Blender, or the module bpy, that runs this file.

blender -b --factory-startup --python-exit-code 1 --python tests/blender/run.py [-- WORD...]
python tests/blender/run.py [WORD...]

Only tests with one of the words in their names run, if any are given. A test is a function whose
name begins with test_; it may ask for tmp_path.
"""

import importlib
import inspect
import os
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import installed  # noqa: E402 - before bpy, which reads the user folders that it sets

installed.prepare_paths()

import bpy  # noqa: E402 - as a module it must be imported before its submodules
from loaded_module import NO_MODULE, loaded_module  # noqa: E402 - beside the tests' folder

Test = Callable[..., None]
_compiled: set[str] = set()  # what the tests had loaded; disabling the add-on unloads it


def main() -> int:
    """Run the tests and return how many failed."""
    installed.install()
    import support

    outcomes = {"passed": 0, "failed": 0, "skipped": 0}
    for module, name, test in _chosen_tests(_words()):
        start = time.perf_counter()
        outcome = _outcome(test, support)
        outcomes[outcome] += 1
        print(f"{outcome} {module}::{name} {time.perf_counter() - start:.2f} s", flush=True)
    print("\n".join(sorted(_compiled - {NO_MODULE}) or [NO_MODULE]))
    print(f"Blender {bpy.app.version_string}, Python {sys.version.split()[0]}")
    print(", ".join(f"{count} {name}" for name, count in outcomes.items()), flush=True)
    return outcomes["failed"] or int(outcomes["passed"] == 0)


def _words() -> list[str]:
    arguments = sys.argv[1:]
    if bpy.app.binary_path:
        arguments = arguments[arguments.index("--") + 1 :] if "--" in arguments else []
    return arguments


def _chosen_tests(words: list[str]) -> Iterator[tuple[str, str, Test]]:
    for path in sorted(HERE.glob("test_*.py")):
        module = importlib.import_module(path.stem)
        for name, test in inspect.getmembers(module, inspect.isfunction):
            is_chosen = not words or any(word in f"{path.stem}::{name}" for word in words)
            if is_chosen and name.startswith("test_") and test.__module__ == path.stem:
                yield path.stem, name, test


def _outcome(test: Test, support) -> str:
    try:
        is_windows = sys.platform == "win32"  # where files that are still open cannot be removed
        with (
            tempfile.TemporaryDirectory(ignore_cleanup_errors=is_windows) as folder,
            support.fresh_blender(),
        ):
            if "tmp_path" in inspect.signature(test).parameters:
                test(tmp_path=Path(folder))
            else:
                test()
            _compiled.add(loaded_module())
    except support.Skipped as reason:
        print(f"skipped: {reason}")
        return "skipped"
    except Exception:
        traceback.print_exc(file=sys.stdout)
        return "failed"
    return "passed"


if __name__ == "__main__":
    status = main()
    sys.stdout.flush()
    os._exit(min(status, 1))  # bpy modules may hang or crash at the interpreter's end
