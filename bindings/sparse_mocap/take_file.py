# SPDX-License-Identifier: GPL-3.0-or-later
"""The take file: a table of samples, checked line by line."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import site_names
from .files import write_text
from .table_errors import TakeError, read_lines

__all__ = [
    "TakeColumns",
    "device_comment",
    "named_devices",
    "read_columns",
    "write_columns",
]

Floats = NDArray[np.float64]
Names = NDArray[np.str_]
Path = str | os.PathLike[str]

_REQUIRED = ("time_s", "sensor", "ax", "ay", "az")
_GYROSCOPE = ("gx", "gy", "gz")
_ORIENTATION = ("qw", "qx", "qy", "qz")
_POSITION = ("px", "py", "pz")
_OPTIONAL = (_GYROSCOPE, _ORIENTATION, _POSITION)
_REMEDY = "the header is time_s,sensor,ax,ay,az with optional gx,gy,gz, qw,qx,qy,qz and px,py,pz"
_LONGEST_NAME = 64
_LONGEST_TAKE_S = 24 * 3600.0
_LARGEST_FORCE = 1e4  # m/s^2, a thousand g
_LARGEST_POSITION_M = 1e4


@dataclass(frozen=True)
class TakeColumns:
    """A take file's columns, one row a sample, in the file's order."""

    times_s: Floats
    sensors: Names
    specific_force: Floats
    angular_velocity: Floats | None
    orientation: Floats | None
    position: Floats | None
    comments: tuple[str, ...]


_DEVICE = "device of "


def device_comment(name: str, identity: str) -> str:
    """Returns the comment that says which device a take's sensor was."""
    return f"{_DEVICE}{name}: {identity}"


def named_devices(comments: Sequence[str]) -> dict[str, str]:
    """Returns the identities of the devices by the names of their sensors, as comments say."""
    devices = {}
    for comment in comments:
        name, colon, identity = comment.removeprefix(_DEVICE).rpartition(": ")
        if comment.startswith(_DEVICE) and colon:
            devices[name] = identity.strip()
    return devices


def read_columns(path: Path) -> TakeColumns:
    """Returns the columns of a take file whose every row has been checked. Raises TakeError."""
    lines = read_lines(path, TakeError)
    comments = tuple(text[1:].strip() for text in lines if text.startswith("#"))
    numbers = [
        number for number, text in enumerate(lines, 1) if text.strip() and not text.startswith("#")
    ]
    if not numbers:
        raise TakeError(path, 0, f"is empty; {_REMEDY}")
    header = _checked_header(path, numbers[0], lines[numbers[0] - 1])
    if len(numbers) == 1:
        raise TakeError(path, numbers[0], "no samples follow the header; record the take again")
    rows = _parsed(path, header, [lines[number - 1] for number in numbers[1:]], numbers[1:])
    columns = TakeColumns(
        rows["time_s"].copy(),
        np.char.strip(rows["sensor"]),
        _stacked(rows, _REQUIRED[2:]),
        _stacked(rows, _GYROSCOPE) if "gx" in header else None,
        _stacked(rows, _ORIENTATION) if "qw" in header else None,
        _stacked(rows, _POSITION) if "px" in header else None,
        comments,
    )
    _check_rows(path, columns, np.array(numbers[1:]))
    return columns


def write_columns(
    path: Path,
    times_s: Floats,
    sensors: Names,
    specific_force: Floats,
    angular_velocity: Floats | None,
    orientation: Floats | None,
    position: Floats | None,
    comments: Sequence[str],
) -> None:
    """Writes a take file atomically."""
    header = list(_REQUIRED)
    parts = [specific_force]
    for names, part in zip(_OPTIONAL, (angular_velocity, orientation, position), strict=True):
        if part is not None:
            header += names
            parts.append(part)
    row_format = "%.6f,%s" + ",%.6f" * (len(header) - 2)
    rows = np.column_stack(parts).tolist()
    lines = [f"# {' '.join(comment.split())}" for comment in comments]
    lines.append(",".join(header))
    lines += [
        row_format % (time, name, *row)
        for time, name, row in zip(times_s.tolist(), sensors.tolist(), rows, strict=True)
    ]
    write_text(path, "\n".join(lines) + "\n", is_private=True)


def _checked_header(path: Path, line: int, text: str) -> list[str]:
    header = [name.strip() for name in text.split(",")]
    known = (*_REQUIRED, *_GYROSCOPE, *_ORIENTATION, *_POSITION)
    missing = [name for name in _REQUIRED if name not in header]
    for group in _OPTIONAL:
        if any(name in header for name in group):
            missing += [name for name in group if name not in header]
    unknown = [name for name in header if name not in known]
    if missing:
        raise TakeError(path, line, f"column {', '.join(missing)} is missing; {_REMEDY}")
    if unknown:
        raise TakeError(path, line, f"column {', '.join(map(repr, unknown))} is unknown; {_REMEDY}")
    if len(set(header)) < len(header):
        raise TakeError(path, line, f"a column occurs twice; {_REMEDY}")
    return header


def _parsed(path: Path, header: list[str], texts: list[str], numbers: list[int]) -> NDArray[Any]:
    types = [(name, f"U{_LONGEST_NAME}" if name == "sensor" else "f8") for name in header]
    try:
        return np.loadtxt(texts, delimiter=",", dtype=types, comments=None, ndmin=1)
    except ValueError:
        for number, text in zip(numbers, texts, strict=True):
            _check_fields(path, number, header, text.split(","))
        raise


def _check_fields(path: Path, line: int, header: list[str], fields: list[str]) -> None:
    if len(fields) != len(header):
        problem = f"expected {len(header)} values ({','.join(header)}), got {len(fields)}"
        hint = "; numbers need a decimal point, not a comma" if len(fields) > len(header) else ""
        raise TakeError(path, line, problem + hint)
    for name, value in zip(header, fields, strict=True):
        if name != "sensor" and not _is_number(value):
            raise TakeError(path, line, f"{name} is {value.strip()[:40]!r}, which is not a number")


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return "_" not in text


def _stacked(rows: NDArray[Any], names: Sequence[str]) -> Floats:
    return np.column_stack([rows[name] for name in names])


def _check_rows(path: Path, columns: TakeColumns, lines: NDArray[np.intp]) -> None:
    _check_values(path, columns, lines)
    known = {*site_names(), *named_devices(columns.comments)}
    for site in dict.fromkeys(columns.sensors.tolist()):
        rows = np.flatnonzero(columns.sensors == site)
        if site not in known:
            raise TakeError(
                path,
                int(lines[rows[0]]),
                f"sensor {site!r} is unknown; known are {', '.join(site_names())}",
            )
        times = columns.times_s[rows]
        late = np.flatnonzero(np.diff(times) <= 0)
        if len(late):
            at = int(late[0]) + 1
            raise TakeError(
                path,
                int(lines[rows[at]]),
                f"{site} reads at {times[at]:g} s after its reading at {times[at - 1]:g} s; "
                "each sensor's times must ascend",
            )


def _check_values(path: Path, columns: TakeColumns, lines: NDArray[np.intp]) -> None:
    def refuse(is_bad: Any, problem: str) -> None:
        bad = np.flatnonzero(is_bad)
        if len(bad):
            raise TakeError(path, int(lines[bad[0]]), problem)

    parts = [columns.times_s[:, None], columns.specific_force]
    optional = (columns.angular_velocity, columns.orientation, columns.position)
    parts += [part for part in optional if part is not None]
    refuse(
        ~np.isfinite(np.column_stack(parts)).all(axis=1),
        "a value is not finite; leave out samples that are missing",
    )
    refuse(
        (abs(columns.specific_force) > _LARGEST_FORCE).any(axis=1),
        f"ax,ay,az is above {_LARGEST_FORCE:g} m/s^2; leave out samples that are broken",
    )
    refuse(
        columns.times_s - columns.times_s.min() > _LONGEST_TAKE_S,
        f"the take is longer than {_LONGEST_TAKE_S / 3600:.0f} h; time_s is in seconds",
    )
    if columns.orientation is not None:
        refuse(
            abs(np.linalg.norm(columns.orientation, axis=1) - 1) > 0.01,
            "qw,qx,qy,qz is not of length 1, so it is not a rotation",
        )
    if columns.position is not None:
        refuse(
            (abs(columns.position) > _LARGEST_POSITION_M).any(axis=1),
            f"px,py,pz is further away than {_LARGEST_POSITION_M:g} m; positions are in metres",
        )
