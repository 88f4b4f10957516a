# SPDX-License-Identifier: GPL-3.0-or-later
"""Labels of motion files: what a table beside them says and their names do not.

The table is UTF-8 CSV with the header ``file,actor,class,source,license,rate_hz``, any of these in
any order, ``file`` needed. rate_hz is the rate of the recording, whatever its file says. The index
of the CMU database (``Subject,Trial #,Motion Description,framerate,...``) is understood as it is.
A file is named by its path in the source folder, its file name or its name without the ending, in
any case; the longest that fits counts. What is left empty is not said.
"""

from __future__ import annotations

import csv
import difflib
import json
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from .motion_files import named_motion_files
from .table_errors import TableError, read_lines

__all__ = ["LabelRow", "Labels", "find_labels", "read_labels"]

TABLE_NAME = "metadata.csv"
"""The table that is read where it lies in a source folder."""
COLUMNS = ("file", "actor", "class", "source", "license", "rate_hz")
_CMU_COLUMNS = {"subject": "subject", "trial #": "trial", "motion description": "class",
                "framerate": "rate_hz"}  # fmt: skip


class Labels(NamedTuple):
    """What is said of a motion file; an empty text is not said."""

    actor: str = ""
    motion_class: str = ""
    origin: str = ""
    license: str = ""
    rate_hz: float = 0.0


@dataclass(frozen=True)
class LabelRow:
    """One line of a table."""

    line: int
    file: str
    """As written."""
    labels: Labels
    is_of_index: bool = False
    """Whether the table lists a whole collection, of which a folder holds a part."""


def read_labels(path: str | os.PathLike[str]) -> dict[str, LabelRow]:
    """Returns the rows of a table by what they call their file, in lower case with ``/``.

    Raises TableError naming the line, and OSError.
    """
    columns: list[str] = []
    rows: dict[str, LabelRow] = {}
    for line, text in enumerate(read_lines(path, TableError), 1):
        if not text.strip(" \t"):
            continue
        fields = _fields(path, line, text)
        if not columns:
            columns = _columns(path, line, fields)
            continue
        row = _row(path, line, columns, fields)
        first = rows.setdefault(_key(row.file), row)
        if first is not row:
            raise TableError(
                path,
                line,
                f"{_quoted(row.file)} is described in line {first.line} already;"
                " leave one of the rows out",
            )
    if not columns:
        raise TableError(path, 0, f"is empty; the header is {','.join(COLUMNS)}")
    return rows


def find_labels(
    sources: Sequence[str | os.PathLike[str]],
    exclude: Sequence[str] = (),
    metadata: str | os.PathLike[str] | None = None,
) -> tuple[dict[str, Labels], list[str]]:
    """Returns the labels of the motion files in the sources, by their paths, and warnings.

    From the table ``metadata``, which holds for all files, else from each source folder's own
    metadata.csv, which holds for the files in that folder. One warning for each row that names none
    of them. Raises FormatError (a table is at fault, or the sources) and OSError.
    """
    tables = _tables(sources, metadata)
    if not tables:
        return {}, []
    files = [(os.fspath(path), name) for path, name in named_motion_files(sources, exclude)]
    labels: dict[str, Labels] = {}
    warnings: list[str] = []
    for table, folder in tables:
        rows = read_labels(table)
        inside = [(path, _names(path, name)) for path, name in files if _lies_in(path, folder)]
        for path, names in inside:
            row = next((rows[name] for name in names if name in rows), None)
            if row is not None:
                labels.setdefault(path, row.labels)
        warnings += _unused(table, rows, (name for _, names in inside for name in names))
    return labels, warnings


def _tables(
    sources: Sequence[str | os.PathLike[str]], metadata: str | os.PathLike[str] | None
) -> list[tuple[Path, str | None]]:
    """Each table with the folder whose files it describes; None stands for all."""
    if metadata is not None:
        return [(Path(metadata), None)]
    folders = [Path(source) for source in sources]
    return [
        (folder / TABLE_NAME, os.path.abspath(folder))
        for folder in folders
        if folder.is_dir() and (folder / TABLE_NAME).exists()
    ]


def _lies_in(path: str, folder: str | None) -> bool:
    return folder is None or Path(os.path.abspath(path)).is_relative_to(folder)


def _unused(table: Path, rows: dict[str, LabelRow], known: Iterable[str]) -> list[str]:
    unused = [rows[name] for name in rows.keys() - set(known) if not rows[name].is_of_index]
    return [
        f"{table}:{row.line}: no motion file is called {_quoted(row.file)}"
        for row in sorted(unused, key=lambda row: row.line)
    ]


def _key(name: str) -> str:
    return name.replace("\\", "/").lower().removeprefix("./")


def _names(path: str, name: str) -> tuple[str, str, str]:
    """What a motion file may be called in a table, the longest name first."""
    return _key(name), _key(Path(path).name), _key(Path(path).stem)


def _fields(path: str | os.PathLike[str], line: int, text: str) -> list[str]:
    try:
        (fields,) = csv.reader([text], strict=True)
    except csv.Error as error:
        problem = {
            "unexpected end of data": "a quote is not closed on its line;"
            " write a quote within quotes twice",
            "',' expected after '\"'": "text follows a quoted field; put a comma between fields",
        }.get(str(error), f"is not a line of CSV ({error}); correct it")
        raise TableError(path, line, problem) from None
    return [field.strip(" \t") for field in fields]


def _columns(path: str | os.PathLike[str], line: int, header: list[str]) -> list[str]:
    lowered = [field.lower() for field in header]
    if {"subject", "trial #"} <= set(lowered):
        return [_CMU_COLUMNS.get(field, "") for field in lowered]
    columns: list[str] = []
    for field in header:
        name = field.lower()
        if name not in COLUMNS:
            (nearest,) = difflib.get_close_matches(name, COLUMNS, 1, cutoff=0.0)
            raise TableError(
                path,
                line,
                f"unknown column {_quoted(field)}; did you mean {_quoted(nearest)}?"
                f" Known are {', '.join(COLUMNS)}",
            )
        if name in columns:
            raise TableError(path, line, f"the column {_quoted(name)} occurs twice; leave one out")
        columns.append(name)
    if "file" not in columns:
        raise TableError(
            path, line, f'the column "file" is missing; the header is {",".join(COLUMNS)}'
        )
    return columns


def _row(
    path: str | os.PathLike[str], line: int, columns: list[str], fields: list[str]
) -> LabelRow:
    if len(fields) != len(columns):
        raise TableError(
            path,
            line,
            f"has {len(fields)} fields, the header has {len(columns)};"
            " put text that holds a comma within quotes",
        )
    said = dict.fromkeys(COLUMNS, "") | dict(zip(columns, fields, strict=True))
    if "subject" in said:
        said["file"] = f"{said['subject']:0>2}_{said['trial']:0>2}"
    if not said["file"]:
        raise TableError(path, line, "names no file; write its name or leave the row out")
    rate_hz = _rate_hz(path, line, said["rate_hz"])
    labels = Labels(said["actor"], said["class"], said["source"], said["license"], rate_hz)
    return LabelRow(line, said["file"], labels, is_of_index="subject" in said)


def _rate_hz(path: str | os.PathLike[str], line: int, text: str) -> float:
    if not text:
        return 0.0
    try:
        rate_hz = float(text)
    except ValueError:
        rate_hz = 0.0
    if not 1.0 <= rate_hz <= 10_000.0:
        raise TableError(
            path, line, f"rate_hz is {_quoted(text)}; write frames per second from 1 to 10000"
        )
    return rate_hz


def _quoted(text: str) -> str:
    return json.dumps(text[:60], ensure_ascii=False)
