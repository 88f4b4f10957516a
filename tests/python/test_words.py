# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts that people read use the glossary's words."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
GLOSSARY = ROOT / ".github" / "GLOSSARY.md"
DOCUMENTS = ("README.md", "CHANGELOG.md", ".github/CONTRIBUTING.md")
PYTHON = ("blender_addon", "bindings/sparse_mocap")
CPP = ("core/sparse_mocap", "bindings/src")
_STRING = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def banned() -> list[str]:
    """The phrases in the glossary's last column."""
    rows = [line.split("|") for line in GLOSSARY.read_text(encoding="utf-8").split("\n")]
    cells = [row[-2] for row in rows if len(row) == 5][2:]
    return [phrase.strip() for cell in cells for phrase in cell.split(",") if phrase.strip()]


def pattern() -> re.Pattern[str]:
    words = "|".join(re.escape(phrase).replace(r"\ ", r"\s+") for phrase in banned())
    return re.compile(rf"\b(?:{words})\b", re.IGNORECASE)


def python_texts(source: str) -> Iterator[tuple[int, str]]:
    """Lines and texts of strings that are not docstrings, and of the docstrings of commands."""
    tree = ast.parse(source)
    hidden = set()
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        for first in body if isinstance(body, list) else ():
            if isinstance(first, ast.Expr) and isinstance(first.value, ast.Constant):
                hidden.add(first.value)
        if isinstance(node, ast.FunctionDef) and node.decorator_list:
            text = ast.get_docstring(node)
            if text and "click" in source:
                yield node.lineno, text
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node not in hidden:
            yield node.lineno, node.value


def cpp_texts(source: str) -> Iterator[tuple[int, str]]:
    """Lines and texts of string literals; adjacent lines of one literal are joined."""
    joined = re.sub(r'"\n\s*"', "", source)
    for number, line in enumerate(joined.split("\n"), 1):
        if not line.startswith("#include"):
            for match in _STRING.finditer(line.partition("//")[0]):
                yield number, match[1]


def misused() -> list[str]:
    found = []
    unwanted = pattern()

    def check(path: Path, texts: Iterator[tuple[int, str]]) -> None:
        for line, text in texts:
            for match in unwanted.finditer(text):
                found.append(f"{path.relative_to(ROOT)}:{line}: {match[0]!r} in {text[:90]!r}")

    for name in DOCUMENTS:
        path = ROOT / name
        if path.exists():
            lines = path.read_text(encoding="utf-8").split("\n")
            check(path, iter([(1, " ".join(lines))]))
    for folder in PYTHON:
        for path in sorted((ROOT / folder).rglob("*.py")):
            check(path, python_texts(path.read_text(encoding="utf-8")))
    for folder in CPP:
        for path in sorted((ROOT / folder).rglob("*.[ch]pp")):
            check(path, cpp_texts(path.read_text(encoding="utf-8")))
    return found


def test_the_glossary_is_read() -> None:
    assert {"knowledge base", "goes on", "place of a sensor"} <= set(banned())
    assert all(re.fullmatch(r"[a-z' ]+", phrase) for phrase in banned())


@pytest.mark.parametrize(
    ("texts", "source"),
    [
        (python_texts, 'x = f"A recording  goes on, {x}"'),
        (python_texts, '@click.command()\ndef f():\n    """It goes on."""'),
        (cpp_texts, 'fail("a recording goes "\n     "on");'),
    ],
)
def test_a_banned_phrase_is_found(texts: object, source: str) -> None:
    assert callable(texts)
    assert any(pattern().search(text) for _, text in texts(source))


def test_docstrings_and_comments_are_not_searched() -> None:
    assert list(python_texts('"""It goes on."""\ndef f():\n    """It goes on."""  # goes on')) == []
    assert list(cpp_texts("// it goes on")) == []


def test_texts_use_the_words_of_the_glossary() -> None:
    assert misused() == []
