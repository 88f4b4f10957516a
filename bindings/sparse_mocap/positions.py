# SPDX-License-Identifier: GPL-3.0-or-later
"""Positions files: a table of joint positions, one row for each frame."""

from __future__ import annotations

import os
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._core import standard_joint_names
from .files import write_text
from .table_errors import TableError, read_lines

__all__ = ["num_written", "position_header", "position_row", "read_positions", "write_positions"]

Floats = NDArray[np.float64]
Path = str | os.PathLike[str]


def num_written(joint_names: Sequence[str], extremities: bool) -> int:
    """How many of a skeleton's joints are written: feet, toes and hands only when asked for."""
    standard = standard_joint_names()
    has_more = list(joint_names[: len(standard)]) == list(standard)
    return len(standard) if has_more and not extremities else len(joint_names)


def write_positions(
    path: Path, times_s: ArrayLike, joint_names: Sequence[str], positions: ArrayLike
) -> None:
    """Writes positions (T, J, 3), in m, of the named joints at the times (T,), in s."""
    times, points = np.asarray(times_s, float), np.asarray(positions, float)
    if points.shape != (len(times), len(joint_names), 3):
        raise ValueError(
            f"positions must be ({len(times)}, {len(joint_names)}, 3), got {points.shape}"
        )
    rows = (position_row(time, at) for time, at in zip(times.tolist(), points, strict=True))
    lines = [position_header(joint_names), *rows]
    write_text(path, "\n".join(lines) + "\n")


def position_header(joint_names: Sequence[str]) -> str:
    """The first line of a positions file."""
    return ",".join(_header(joint_names))


def position_row(time_s: float, positions: ArrayLike) -> str:
    """The line of a pose: positions (J, 3)."""
    values = np.asarray(positions, float).ravel().tolist()
    return ",".join(f"{value:.6f}" for value in (time_s, *values))


def read_positions(path: Path) -> tuple[Floats, list[str], Floats]:
    """Returns times (T,), joint names and positions (T, J, 3) of a positions file."""
    lines = read_lines(path, TableError)
    used = [(i, text) for i, text in enumerate(lines, 1) if text.strip() and text[0] != "#"]
    if not used:
        raise TableError(path, 0, "is empty; a positions file was expected")
    header_line, header = used[0][0], used[0][1].split(",")
    joints = [name.removesuffix("_x") for name in header[1::3]]
    if not joints or header != _header(joints):
        raise TableError(
            path, header_line, "the header must be time_s,<joint>_x,<joint>_y,<joint>_z,..."
        )
    rows = np.empty((len(used) - 1, len(header)))
    for row, (line, text) in zip(rows, used[1:], strict=True):
        try:
            row[:] = [float(field) for field in text.split(",")]
        except ValueError:
            raise TableError(path, line, f"expected {len(header)} numbers") from None
    return rows[:, 0], joints, rows[:, 1:].reshape(len(rows), -1, 3)


def _header(joint_names: Sequence[str]) -> list[str]:
    return ["time_s", *(f"{name}_{axis}" for name in joint_names for axis in "xyz")]
