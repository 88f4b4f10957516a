# SPDX-License-Identifier: GPL-3.0-or-later
"""The installed add-on in a Blender of its own, where its core cannot work: one panel says why."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import bpy
import installed
from support import Skipped

SCRIPT = Path(__file__).parent / "installation_script.py"
ADDON = "sparse_mocap_addon"
EXPLAINED = ["SPARSEMOCAP_PT_installation"]
REINSTALL = "reinstall the add-on from the release file"
PYTHON = f"{sys.version_info.major}.{sys.version_info.minor}"


def _installed(folder: Path, *, is_extension: bool = False) -> tuple[Path, Path]:
    """The add-on as from the release file, and its compiled module."""
    import sparse_mocap._core

    if sys.platform == "win32":
        raise Skipped("what is broken here is broken as on Linux")
    addon = folder / "scripts" / "addons" / ADDON
    vendor = addon / "vendor" / "sparse_mocap"
    if is_extension:
        addon = folder / "extensions" / "user_default" / "sparse_mocap"
        wheels = folder / "extensions" / ".local" / "lib" / f"python{PYTHON}" / "site-packages"
        vendor = wheels / "sparse_mocap"
    ignored = shutil.ignore_patterns("__pycache__", "_core.*.so", "compiled_modules.txt", "vendor")
    shutil.copytree(Path(installed.module().__file__).parent, addon, ignore=ignored)
    shutil.copytree(Path(sparse_mocap.__file__).parent, vendor, ignore=ignored)
    manifest = addon / "blender_manifest.toml"
    if manifest.is_file():  # Blender would put wheels in their place again
        manifest.write_text(re.sub(r"(?s)\nwheels = \[.*?\]", "", manifest.read_text()))
    compiled = vendor / Path(sparse_mocap._core.__file__).name
    shutil.copy(sparse_mocap._core.__file__, compiled)
    return addon, compiled


def _run(folder: Path, *arguments: object, addon: str = ADDON, has_window: bool = False) -> dict:
    """What the script finds; no traceback is printed meanwhile."""
    command = [sys.executable, SCRIPT]
    if bpy.app.binary_path:
        options = ["--factory-startup", "-noaudio", "--python-exit-code", "1"]
        options += [] if has_window else ["-b"]
        command = [bpy.app.binary_path, *options, "--python", SCRIPT]
    own = {
        "HOME": str(folder),  # the report shows it as ~
        "BLENDER_USER_SCRIPTS": str(folder / "scripts"),
        "BLENDER_USER_CONFIG": str(folder),
        "BLENDER_USER_EXTENSIONS": str(folder / "extensions"),
        "LIBGL_ALWAYS_SOFTWARE": "1",
    }
    environment = {**os.environ, **own}
    for name in ("PYTHONPATH", "BLENDER_USER_RESOURCES"):
        environment.pop(name, None)
    done = subprocess.run(
        [*map(str, command), "--", addon, *map(str, arguments)],
        env=environment, capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert "Traceback" not in said, said
    [line] = [line for line in done.stdout.split("\n") if line.startswith("RESULT ")]
    outcome = json.loads(line.removeprefix("RESULT "))
    assert outcome["first"]["is_enabled"], said
    assert outcome["left"] == [], outcome
    return outcome


def _said(outcome: dict) -> str:
    """What the only panel says."""
    first = outcome["first"]
    assert first["panels"] == EXPLAINED, first
    assert first["operators"] == ["sparse_mocap.copy_report"]
    assert first["copied"] == ["FINISHED"]
    return first["says"]


def test_a_whole_installation_shows_the_steps(tmp_path):
    _installed(tmp_path)
    panels = _run(tmp_path)["first"]["panels"]
    assert "SPARSEMOCAP_PT_database" in panels
    assert "SPARSEMOCAP_PT_installation" not in panels


def test_the_compiled_module_was_removed_and_comes_back(tmp_path):
    _, compiled = _installed(tmp_path)
    removed = compiled.rename(tmp_path / compiled.name)
    outcome = _run(tmp_path, "replace", compiled, removed)
    assert _said(outcome) == (
        "The compiled file _core is missing in ~/scripts/addons/sparse_mocap_addon/vendor/"
        f"sparse_mocap, an antivirus may have removed it: allow it there and {REINSTALL}"
    )
    assert "SPARSEMOCAP_PT_database" in outcome["second"]["panels"]
    assert outcome["left_then"] == []


def test_only_the_module_of_another_python(tmp_path):
    _, compiled = _installed(tmp_path)
    number = PYTHON.replace(".", "")
    compiled.rename(compiled.with_name(compiled.name.replace(f"-{number}-", "-312-")))
    said = _said(_run(tmp_path))
    assert f"does not work with Python {PYTHON} of this Blender {bpy.app.version_string}" in said
    assert "only with Python 3.12: install the release for" in said


def test_the_module_of_this_python_was_removed_and_others_are_there(tmp_path):
    _, compiled = _installed(tmp_path)
    number = PYTHON.replace(".", "")
    other = compiled.with_name(compiled.name.replace(f"-{number}-", "-312-"))
    compiled.rename(other)
    (other.parent / "compiled_modules.txt").write_text(f"{compiled.name}\n{other.name}\n")
    assert _said(_run(tmp_path)).startswith("The compiled file _core is missing in ~/scripts/")


def test_without_numpy(tmp_path):
    _installed(tmp_path)
    assert _said(_run(tmp_path, "hide_numpy")).startswith("This Blender's Python has no NumPy: ")


def test_a_damaged_module(tmp_path):
    _, compiled = _installed(tmp_path)
    compiled.write_bytes(compiled.read_bytes()[:40])
    said = _said(_run(tmp_path))
    assert said == f"The installation is incomplete ({compiled.name}: file too short): {REINSTALL}"


def test_a_system_that_is_too_old(tmp_path):
    _, compiled = _installed(tmp_path)
    needed = compiled.read_bytes()
    newest = max(re.findall(rb"GLIBC_2\.[1-9]\d", needed))
    compiled.write_bytes(needed.replace(newest, b"GLIBC_9.99"))
    said = _said(_run(tmp_path))
    assert said.startswith("This system is too old for this release of Sparse Mocap (lib")
    assert f"version `GLIBC_9.99' not found (required by {compiled.name})): update" in said


def test_an_upgrade_in_a_running_session(tmp_path):
    addon, _ = _installed(tmp_path)
    told = addon / "blender_manifest.toml"
    version, later = r'(?m)^version = "(.*)"', 'version = "9.9.9"'
    if not told.is_file():  # add-ons of the older form say it in bl_info
        told, version, later = addon / "__init__.py", r'"version": \(.*\)', '"version": (9, 9, 9)'
    newer = tmp_path / "newer"
    newer.write_text(re.sub(version, later, told.read_text()))
    second = _run(tmp_path, "replace", told, newer)["second"]
    assert second["panels"] == EXPLAINED
    assert re.fullmatch(
        r"Sparse Mocap 9\.9\.9 was installed while \d\S+ was loaded: restart Blender",
        second["says"],
    )


def test_as_an_extension(tmp_path):
    if bpy.app.version < (4, 2):
        raise Skipped("this Blender has no extensions")
    addon = "bl_ext.user_default.sparse_mocap"
    _, compiled = _installed(tmp_path, is_extension=True)
    removed = compiled.rename(tmp_path / compiled.name)
    outcome = _run(tmp_path, "replace", compiled, removed, addon=addon)
    assert _said(outcome).startswith(
        f"The compiled file _core is missing in ~/extensions/.local/lib/python{PYTHON}/"
    )
    assert "SPARSEMOCAP_PT_database" in outcome["second"]["panels"]


def test_missing_files(tmp_path):
    addon, compiled = _installed(tmp_path)
    (addon / "ops" / "clips.py").unlink()
    said = _said(_run(tmp_path))
    assert said.startswith("The installation is incomplete (cannot import name 'clips'")
    assert said.endswith(REINSTALL)
    (compiled.parent / "take.py").unlink()
    assert "(sparse_mocap/take is missing)" in _said(_run(tmp_path))
    shutil.rmtree(addon / "vendor")
    assert "(sparse_mocap is missing)" in _said(_run(tmp_path))


def test_missing_files_of_what_explains(tmp_path):
    addon, _ = _installed(tmp_path)
    damaged = f"Files of Sparse Mocap are missing or damaged: {REINSTALL}"
    for name in ("session/core.py", "session/installation.py", "ops/copy_report.py", "ui/text.py"):
        if not name.startswith("session"):  # needed only where something else is wrong too
            shutil.rmtree(addon / "vendor", ignore_errors=True)
        lost = (addon / name).rename(tmp_path / "lost")
        first = _run(tmp_path)["first"]
        lost.rename(addon / name)
        assert (first["panels"], first["says"]) == (EXPLAINED, damaged), name
    (addon / "session" / "core.py").write_text("def (")
    assert _run(tmp_path)["first"]["says"] == damaged


def test_another_copy_was_imported_before(tmp_path):
    _, compiled = _installed(tmp_path)
    other = tmp_path / "other"
    shutil.copytree(compiled.parent, other / "sparse_mocap")
    said = _said(_run(tmp_path, "import_first", other))
    assert said.startswith("Sparse Mocap is installed twice, 0.")
    assert "in ~/scripts/addons/sparse_mocap_addon/vendor/sparse_mocap and 0." in said
    assert "in ~/other/sparse_mocap: remove the one" in said


def test_copy_report_fills_the_clipboard(tmp_path):
    if not bpy.app.binary_path:
        raise Skipped("a bpy module has no clipboard")
    if not os.environ.get("DISPLAY"):
        raise Skipped("there is no display")
    _, compiled = _installed(tmp_path)
    compiled.unlink()
    outcome = _run(tmp_path, has_window=True)
    copied = outcome["first"]["clipboard"]
    lines = copied.split("\n")
    assert lines[0].startswith("Sparse Mocap 0.")
    assert lines[0].endswith(f"as {ADDON} in ~/scripts/addons/{ADDON}")
    assert lines[1] == f"Blender {bpy.app.version_string}"
    assert f"Reason: {_said(outcome)}" in lines
    assert f"  ~/scripts/addons/{ADDON}/vendor/sparse_mocap: no compiled module" in lines
    assert str(tmp_path) not in copied
