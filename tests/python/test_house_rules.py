# SPDX-License-Identifier: GPL-3.0-or-later
"""The repository's own rules: licence lines, and files and functions that a reader can hold."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
ROOMS = ("core", "bindings", "blender_addon", "tests")
MOST_LINES = 400
MOST_FUNCTION_LINES = 50
LICENCE = "SPDX-License-Identifier: GPL-3.0-or-later"


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


@pytest.mark.parametrize("room", ["bindings", "blender_addon"])
def test_no_python_function_is_too_long(room: str) -> None:
    long = {}
    for path in sorted((ROOT / room).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
                lines = (node.end_lineno or node.lineno) - node.lineno + 1
                if lines > MOST_FUNCTION_LINES:
                    long[f"{path.relative_to(ROOT)}:{node.lineno} {node.name}"] = lines
    assert long == {}
