# SPDX-License-Identifier: GPL-3.0-or-later
"""The text files of a recording and their tables, checked cell by cell."""

from __future__ import annotations

import csv
import math
import os
import zipfile
import zlib
from array import array
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
_MOST_BYTES = 400_000_000
_MOST_LINES = 4_000_000
"""Of all files of a recording; at 100 Hz, eleven hours of one sensor."""
_MOST_COLUMNS = 256
_LARGEST_RATIO = 100
"""Of a zip's text to the zip; numbers are compressed to a tenth."""


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
    """The numbers under a header."""

    path: str
    header: list[str]
    values: Floats
    """(T, C); NaN for empty cells and for those that are not numbers."""
    words: dict[int, tuple[int, str]]
    """By column, the row and text of the first cell that is not a number."""
    first_row: list[str]
    """The first row's texts."""
    first_line: int
    """Line number of the first row in the file, from 1."""

    def has(self, *names: str) -> bool:
        """Whether the table has all these columns."""
        return all(name in self.header for name in names)

    def column(self, name: str) -> Floats:
        """Returns a column's numbers, NaN for empty cells. Raises RecordingError."""
        at = self.header.index(name)
        if at in self.words:
            row, text = self.words[at]
            raise RecordingError(
                self.path,
                self.first_line + row,
                f"{name} is {text[:40]!r}, which is not a number",
            )
        return np.array(self.values[:, at])

    def columns(self, *names: str) -> Floats:
        """Returns several columns' numbers, (T, C)."""
        return np.column_stack([self.column(name) for name in names])


def read_texts(path: str | os.PathLike[str]) -> list[Text]:
    """Returns the text files of a recording (a file, folder or zip), sorted by name.

    Raises RecordingError when there is more than a recording has, before it is read.
    """
    source = Path(path)
    limits = _Limits(source)
    if source.is_dir():
        files = sorted(file for file in source.rglob("*") if file.is_file())
        plain = [file for file in files if file.suffix.lower() in _ENDINGS]
        limits.check_size(len(plain), sum(file.stat().st_size for file in plain))
        texts = [limits.text(str(file), file.read_bytes()) for file in plain]
        for file in files:
            texts += _zipped_texts(file, limits) if file.suffix.lower() == ".zip" else []
        return texts
    if not source.is_file():
        raise RecordingError(source, 0, "is not a file or folder; choose a recording")
    if not zipfile.is_zipfile(source):
        limits.check_size(1, source.stat().st_size)
        return [limits.text(str(source), source.read_bytes())]
    return _zipped_texts(source, limits)


def _zipped_texts(source: Path, limits: _Limits) -> list[Text]:
    try:
        return _unpacked_texts(source, limits)
    except (zipfile.BadZipFile, zlib.error, RuntimeError, NotImplementedError, EOFError) as error:
        raise RecordingError(source, 0, f"cannot be unpacked ({error}); export it again") from error


def _unpacked_texts(source: Path, limits: _Limits) -> list[Text]:
    with zipfile.ZipFile(source) as archive:
        infos = [info for info in archive.infolist() if _is_text_name(info.filename)]
        num_bytes = sum(info.file_size for info in infos)
        limits.check_size(len(infos), num_bytes)
        if num_bytes > _LARGEST_RATIO * source.stat().st_size:
            raise RecordingError(
                source, 0, f"unpacks to {num_bytes} bytes, more than a recording would; "
                "unpack it and choose the folder"
            )  # fmt: skip
        infos.sort(key=lambda info: info.filename)
        return [limits.text(f"{source}/{info.filename}", archive.read(info)) for info in infos]


def read_table(
    text: Text, header_at: int, separator: str, *, has_decimal_comma: bool = False
) -> Table:
    """Returns the table whose header is at a line (from 0). Raises RecordingError."""
    reader = csv.reader(text.lines[header_at:], delimiter=separator)
    try:
        header = [name.strip() for name in next(reader, [])]
        if len(header) > _MOST_COLUMNS:
            raise RecordingError(
                text.path, header_at + 1, f"has {len(header)} columns; at most {_MOST_COLUMNS} are "
                "read"
            )  # fmt: skip
        rows = _Rows(text.path, header_at + 2, len(header), has_decimal_comma)
        for cells in reader:
            rows.add(cells)
    except csv.Error as error:
        raise RecordingError(text.path, header_at + 1, f"is not a table ({error})") from error
    if not rows.count:
        raise RecordingError(
            text.path, header_at + 1, "there are no samples after the header; record again"
        )
    values = np.frombuffer(rows.numbers, np.float64).reshape(rows.count, len(header))
    return Table(text.path, header, values, rows.words, rows.first, header_at + 2)


class _Rows:
    """The rows of a table as they are read, as numbers to save memory."""

    def __init__(self, path: str, first_line: int, width: int, has_decimal_comma: bool) -> None:
        self._path, self._first_line = path, first_line
        self._width, self._has_decimal_comma = width, has_decimal_comma
        self._blank_widths: list[int] = []  # of rows that may be the last
        self.count = 0
        self.numbers = array("d")
        self.words: dict[int, tuple[int, str]] = {}
        self.first: list[str] = []

    def add(self, cells: list[str]) -> None:
        """Adds a row; blank ones may only follow the last. Raises RecordingError."""
        if not any(cell.strip() for cell in cells):
            self._blank_widths.append(len(cells))
            return
        for width in self._blank_widths:
            self._check_width(width)
            self.numbers.extend([math.nan] * width)
            self.count += 1
        self._blank_widths.clear()
        self._check_width(len(cells))
        self.first = self.first or cells
        for column, cell in enumerate(cells):
            self.numbers.append(self._number(column, cell.strip()))
        self.count += 1

    def _check_width(self, width: int) -> None:
        if width != self._width:
            raise RecordingError(
                self._path,
                self._first_line + self.count,
                f"expected {self._width} cells as in the header, got {width}",
            )

    def _number(self, column: int, text: str) -> float:
        try:
            return float(text.replace(",", ".") if self._has_decimal_comma else text)
        except ValueError:
            if text:
                self.words.setdefault(column, (self.count, text))
            return math.nan


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


class _Limits:
    """What the files of a recording may have together. Raises RecordingError beyond it."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._num_files = self._num_bytes = self._num_lines = 0

    def check_size(self, num_files: int, num_bytes: int) -> None:
        """Checks before anything is read, together with what was checked before."""
        self._num_files += num_files
        self._num_bytes += num_bytes
        num_files, num_bytes = self._num_files, self._num_bytes
        if num_files > _MOST_FILES or num_bytes > _MOST_BYTES:
            raise RecordingError(
                self._path, 0, f"has {num_files} files of {num_bytes} bytes, and at most "
                f"{_MOST_FILES} files of {_MOST_BYTES} bytes are read; choose a single recording"
            )  # fmt: skip

    def text(self, path: str, data: bytes) -> Text:
        """Returns the text in these bytes."""
        self._num_lines += max(data.count(b"\n"), data.count(b"\r"))
        if self._num_lines > _MOST_LINES:
            raise RecordingError(
                self._path, 0, f"has more than {_MOST_LINES} lines; choose a shorter recording"
            )
        text = data.decode("utf-8-sig", errors="replace")
        return Text(path, text.replace("\r\n", "\n").replace("\r", "\n").split("\n"))
