# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors in tables (takes and positions files), with their line."""

from __future__ import annotations

import os

from . import FormatError

__all__ = ["TableError", "TakeError", "read_lines"]


class TableError(FormatError):
    """A table has an error; str() is one line: ``take.csv:12: what; what to do``."""

    def __init__(self, path: str | os.PathLike[str], line: int, problem: str) -> None:
        location = f"{os.fspath(path)}:{line}" if line else os.fspath(path)
        super().__init__(f"{location}: {problem}")
        self.path, self.line, self.column = os.fspath(path), line, 0


class TakeError(TableError):
    """A take cannot be used."""


def read_lines(path: str | os.PathLike[str], error: type[TableError]) -> list[str]:
    """Returns the lines of a UTF-8 text, without line ends of any kind."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise error(path, 0, "is UTF-16 text; save it as UTF-8")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as at:
        line = data.count(b"\n", 0, at.start) + 1
        raise error(path, line, "is not UTF-8 text; save it as UTF-8") from None
    if "\0" in text:
        raise error(
            path,
            text.count("\n", 0, text.index("\0")) + 1,
            "contains a NUL byte, so it is not text; save it as text",
        )
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    return lines[:-1] if lines[-1] == "" else lines
