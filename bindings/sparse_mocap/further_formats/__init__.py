# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion formats that the core does not read: NumPy archives and XML have libraries in Python.

Each reader takes a path, returns the motion with y up and warnings (one line each, without the
path), and raises FormatError.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from .._core import Motion
from .mvnx import read_mvnx
from .smpl import read_smpl

__all__ = ["READERS", "read_mvnx", "read_smpl"]

READERS: dict[str, Callable[[Path], tuple[Motion, list[str]]]] = {
    ".npz": read_smpl,
    ".mvnx": read_mvnx,
}
"""The readers by the ending of the file's name, in lower case."""
