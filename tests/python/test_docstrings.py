# SPDX-License-Identifier: GPL-3.0-or-later
"""help() tells of everything public in the compiled core, in the words of its stub."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import sparse_mocap
from sparse_mocap import _core

PACKAGE = Path(sparse_mocap.__file__).parent
SIGNATURE = re.compile(r"\w+\(.*\)( -> .*)?$")


def text_of(doc: str | None) -> str:
    """A docstring on one line, without the signature that pybind11 puts before it."""
    lines = (doc or "").strip().splitlines()
    if lines and SIGNATURE.match(lines[0]):
        lines = lines[1:]
    return " ".join(" ".join(lines).split())


def is_public(name: str) -> bool:
    return not name.startswith("_")


def compiled() -> dict[str, Any]:
    """Each public function, class, method and property of the core by its dotted name."""
    found: dict[str, Any] = {}
    for name, value in vars(_core).items():
        if is_public(name) and callable(value):
            found[name] = value
            members = vars(value).items() if inspect.isclass(value) else ()
            found |= {f"{name}.{member}": what for member, what in members if is_public(member)}
    return found


def in_stub() -> Iterator[tuple[str, str]]:
    """The same of the stub, each with its docstring."""
    for path in sorted(PACKAGE.glob("_core*.pyi")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef) and is_public(node.name):
                yield node.name, text_of(ast.get_docstring(node))
            if isinstance(node, ast.ClassDef) and is_public(node.name):
                yield from members_in_stub(node)


def members_in_stub(of: ast.ClassDef) -> Iterator[tuple[str, str]]:
    for node in of.body:
        if isinstance(node, ast.FunctionDef) and is_public(node.name):
            yield f"{of.name}.{node.name}", text_of(ast.get_docstring(node))
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            yield f"{of.name}.{node.target.id}", ""


def test_the_stub_and_the_module_have_the_same_names() -> None:
    names = dict(in_stub())
    assert len(names) > 100
    assert sorted(names) == sorted(compiled())


def test_everything_compiled_has_a_docstring() -> None:
    # What FormatError carries are plain attributes.
    told = {name: what for name, what in compiled().items() if not isinstance(what, str | int)}
    assert len(told) > 100
    assert [name for name, what in told.items() if not text_of(what.__doc__)] == []


def test_docstrings_say_what_the_stub_says() -> None:
    documented = {name: text for name, text in in_stub() if text}
    assert len(documented) > 50
    module = compiled()
    differ = [n for n, text in documented.items() if text_of(module[n].__doc__) != text]
    assert differ == []


@pytest.mark.parametrize("name", sparse_mocap.__all__)
def test_every_public_name_of_the_package_has_a_docstring(name: str) -> None:
    value = getattr(sparse_mocap, name)
    assert not callable(value) or text_of(value.__doc__)


def test_signatures_are_told_from_docstrings() -> None:
    assert text_of("step(self: Reconstructor, x: float) -> Pose | None\n\nOne\nframe.\n") == (
        "One frame."
    )
    assert text_of("reversed(self: Motion) -> Motion\n") == ""
    assert text_of("What a skeleton does.") == "What a skeleton does."
