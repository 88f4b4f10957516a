# SPDX-License-Identifier: GPL-3.0-or-later
"""The repository's own rules: licence lines, files and functions that a reader can hold, modules
that use only those below them."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
ROOMS = ("core", "bindings", "blender_addon", ".dev/packaging", "tests")
MOST_LINES = 400
MOST_FUNCTION_LINES = 50
LICENCE = "SPDX-License-Identifier: GPL-3.0-or-later"

MODULES = (
    ("base",),
    ("motion",),
    ("retargeting",),
    ("formats",),
    ("sensors",),
    ("readings",),
    ("streams",),
    ("database",),
    ("reconstruction",),
    ("retrieval",),
    ("tautges2011", "path_regression", "liu2011", "eom2014"),
    ("methods",),
)
"""The modules of the core, lowest first; those of one level do not know each other."""
ONLY_BASE = ("streams",)


def sources(*endings: str) -> list[Path]:
    found = [path for room in ROOMS for path in sorted((ROOT / room).rglob("*"))]
    return [path for path in found if path.suffix in endings and "build" not in path.parts]


def test_every_source_names_its_licence() -> None:
    files = sources(".py", ".pyi", ".cpp", ".hpp")
    assert len(files) > 50
    heads = {path: path.read_text(encoding="utf-8").split("\n", 2)[:2] for path in files}
    missing = [path for path, head in heads.items() if LICENCE not in "\n".join(head)]
    assert [str(path.relative_to(ROOT)) for path in missing] == []


def test_no_source_is_too_long() -> None:
    lengths = {
        str(path.relative_to(ROOT)): path.read_text(encoding="utf-8").count("\n")
        for path in sources(".py", ".pyi", ".cpp", ".hpp")
    }
    assert {name: lines for name, lines in lengths.items() if lines > MOST_LINES} == {}


@pytest.mark.parametrize("room", ["bindings", "blender_addon", ".dev/packaging"])
def test_no_python_function_is_too_long(room: str) -> None:
    long = {}
    for path in sorted((ROOT / room).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                lines = (node.end_lineno or node.lineno) - node.lineno + 1
                if lines > MOST_FUNCTION_LINES:
                    long[f"{path.relative_to(ROOT)}:{node.lineno} {node.name}"] = lines
    assert long == {}


def core_includes() -> dict[tuple[str, str], list[str]]:
    """The files of the core by which module includes which."""
    found: dict[tuple[str, str], list[str]] = {}
    folder = ROOT / "core" / "sparse_mocap"
    for path in sorted([*folder.rglob("*.hpp"), *folder.rglob("*.cpp")]):
        module = path.relative_to(folder).parts[0]
        for used in re.findall(
            r'^\s*#\s*include\s*["<]sparse_mocap/([^/"<>]+)/', path.read_text(), re.MULTILINE
        ):
            found.setdefault((module, used), []).append(str(path.relative_to(folder)))
    return found


def test_no_module_of_the_core_includes_a_higher_one() -> None:
    level = {module: i for i, modules in enumerate(MODULES) for module in modules}
    includes = core_includes()
    assert len(includes) > 20
    unknown = {module for pair in includes for module in pair} - set(level)
    assert unknown == set(), "a new module of the core belongs into MODULES"
    wrong = {
        pair: files
        for pair, files in includes.items()
        if pair[0] != pair[1]
        and (level[pair[1]] >= level[pair[0]] or (pair[0] in ONLY_BASE and pair[1] != "base"))
    }
    assert wrong == {}


@pytest.mark.parametrize("room", ["bindings", "blender_addon"])
def test_times_are_read_from_the_clock_that_is_fine_on_every_system(room: str) -> None:
    """time.monotonic ticks every 15.6 ms in CPython 3.11 on Windows; samples come every 5 ms.

    perf_counter is a clock of the machine too: processes that compare their times must all use it.
    """
    files = sorted((ROOT / room).rglob("*.py"))
    assert len(files) > 20
    coarse = [path for path in files if re.search(r"\bmonotonic(_ns)?\(", path.read_text("utf-8"))]
    assert [str(path.relative_to(ROOT)) for path in coarse] == []
