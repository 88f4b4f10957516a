# SPDX-License-Identifier: GPL-3.0-or-later
"""The text files of a recording and their tables, checked cell by cell."""

from __future__ import annotations

import csv
import os
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..table_errors import TableError

__all__ = [
    "RecordingError",
    "Table",
    "Text",
    "check_finite",
    "find_line",
    "interpolated",
    "read_table",
    "read_texts",
    "shown",
    "unwrapped",
]

Floats = NDArray[np.float64]

_ENDINGS = (".csv", ".txt", ".json")
_MOST_FILES = 500
_MOST_BYTES = 1 << 30


class RecordingError(TableError):
    """A recording cannot be imported."""


@dataclass(frozen=True)
class Text:
    """A text file of a recording: its path and lines."""

    path: str
    lines: list[str]

    @property
    def name(self) -> str:
        """The file's name without folder and ending."""
        return Path(self.path).stem


@dataclass(frozen=True)
class Table:
    """Rows of cells under a header."""

    path: str
    header: list[str]
    rows: list[list[str]]
    first_line: int
    """Line number of the first row in the file, from 1."""
    has_decimal_comma: bool = False

    def has(self, *names: str) -> bool:
        """Whether the table has all these columns."""
        return all(name in self.header for name in names)

    def column(self, name: str) -> Floats:
        """Returns a column's numbers, NaN for empty cells. Raises RecordingError."""
        at = self.header.index(name)
        values = np.empty(len(self.rows))
        for row, cells in enumerate(self.rows):
            text = cells[at].strip()
            if self.has_decimal_comma:
                text = text.replace(",", ".")
            try:
                values[row] = float(text) if text else np.nan
            except ValueError:
                raise RecordingError(
                    self.path,
                    self.first_line + row,
                    f"{name} is {text[:40]!r}, which is not a number",
                ) from None
        return values

    def columns(self, *names: str) -> Floats:
        """Returns several columns' numbers, (T, C)."""
        return np.column_stack([self.column(name) for name in names])


def read_texts(path: str | os.PathLike[str]) -> list[Text]:
    """Returns the text files of a recording (a file, folder or zip), sorted by name."""
    source = Path(path)
    if source.is_dir():
        files = sorted(file for file in source.rglob("*") if file.suffix.lower() in _ENDINGS)
        _check_size(source, len(files), sum(file.stat().st_size for file in files))
        return [_text(str(file), file.read_bytes()) for file in files]
    if zipfile.is_zipfile(source):
        with zipfile.ZipFile(source) as archive:
            infos = [info for info in archive.infolist() if _is_text_name(info.filename)]
            _check_size(source, len(infos), sum(info.file_size for info in infos))
            infos.sort(key=lambda info: info.filename)
            return [_text(f"{source}/{info.filename}", archive.read(info)) for info in infos]
    _check_size(source, 1, source.stat().st_size)
    return [_text(str(source), source.read_bytes())]


def read_table(
    text: Text, header_at: int, separator: str, *, has_decimal_comma: bool = False
) -> Table:
    """Returns the table whose header is at a line (from 0). Raises RecordingError."""
    header, *rows = csv.reader(text.lines[header_at:], delimiter=separator)
    header = [name.strip() for name in header]
    while rows and not any(cell.strip() for cell in rows[-1]):
        rows.pop()
    for row, cells in enumerate(rows):
        if len(cells) != len(header):
            raise RecordingError(
                text.path,
                header_at + 2 + row,
                f"expected {len(header)} cells as in the header, got {len(cells)}",
            )
    if not rows:
        raise RecordingError(
            text.path, header_at + 1, "there are no samples after the header; record again"
        )
    return Table(text.path, header, rows, header_at + 2, has_decimal_comma)


def find_line(text: Text, *words: str) -> int | None:
    """Returns the first line (from 0) near the start that contains all these words."""
    for number, line in enumerate(text.lines[:50]):
        if all(word in line for word in words):
            return number
    return None


def unwrapped(counts: Floats, bits: int) -> Floats:
    """Returns the unwrapped counts of a counter of a few bits."""
    steps = np.diff(counts)
    wrap = 2.0**bits
    wraps = np.cumsum(np.where(steps < -wrap / 2, wrap, 0.0))
    going_on: Floats = counts + np.concatenate([[0.0], wraps])
    return going_on


def interpolated(wanted_s: Floats, times_s: Floats, values: Floats) -> Floats:
    """Returns values (T, C) interpolated at other times, constant beyond the ends."""
    return np.column_stack([np.interp(wanted_s, times_s, column) for column in values.T])


def shown(line: str) -> str:
    """Returns a line, shortened for error messages."""
    return repr(line.strip()[:60])


def check_finite(table: Table, values: Floats, names: Sequence[str]) -> None:
    """Raises RecordingError naming the first row in which a value is missing."""
    bad = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if len(bad):
        line = table.first_line + int(bad[0])
        raise RecordingError(table.path, line, f"a value of {', '.join(names)} is missing")


def _is_text_name(name: str) -> bool:
    return name.lower().endswith(_ENDINGS) and not name.startswith("__MACOSX")


def _check_size(path: Path, num_files: int, num_bytes: int) -> None:
    if num_files > _MOST_FILES or num_bytes > _MOST_BYTES:
        raise RecordingError(
            path, 0, f"has {num_files} files of {num_bytes} bytes; choose a single recording"
        )


def _text(path: str, data: bytes) -> Text:
    text = data.decode("utf-8-sig", errors="replace")
    return Text(path, text.replace("\r\n", "\n").replace("\r", "\n").split("\n"))
