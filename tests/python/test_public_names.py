# SPDX-License-Identifier: GPL-3.0-or-later
"""Each module of the package lists in __all__ what others may use of it."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
import sparse_mocap

PACKAGE = Path(sparse_mocap.__file__).parent
MODULES = [path for path in sorted(PACKAGE.rglob("*.py")) if path.name != "__main__.py"]


def names_of(tree: ast.Module) -> set[str]:
    """The public functions and classes that the module defines."""
    defined = [n for n in tree.body if isinstance(n, ast.FunctionDef | ast.ClassDef)]
    return {node.name for node in defined if not node.name.startswith("_")}


def listed_in(tree: ast.Module) -> list[str]:
    for node in tree.body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            names = ast.literal_eval(node.value)
            assert isinstance(names, list)
            return names
    return []


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_public_names_are_listed(path: Path) -> None:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    listed = listed_in(tree)
    assert sorted(names_of(tree) - set(listed)) == []
    assert [name for name in listed if name.startswith("_") and name != "__version__"] == []
    assert len(set(listed)) == len(listed)


def test_modules_are_found_and_told_apart() -> None:
    assert len(MODULES) > 50
    told = ast.parse("__all__ = ['walk']\ndef walk(): ...\nclass Run: ...\ndef _hop(): ...\n")
    assert names_of(told) == {"walk", "Run"}
    assert listed_in(told) == ["walk"]
