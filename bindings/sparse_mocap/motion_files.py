# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion files of every format that is read: the core's own and the further ones."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from . import _core
from .further_formats import READERS

__all__ = ["find_motion_files", "named_motion_files", "read_motion", "read_options"]

AnyPath = str | os.PathLike[str]


def read_options(
    *,
    amc_rate_hz: float = 120.0,
    unit_m: float | None = None,
    up: str = "y",
    asf: AnyPath | None = None,
    allow_no_frames: bool = False,
) -> _core.ReadOptions:
    """What motion files do not say of themselves, as for read_motion. Raises ConfigError."""
    return _core.ReadOptions(
        amc_rate_hz=amc_rate_hz,
        unit_m=unit_m,
        up=up,
        asf=asf,
        allow_no_frames=allow_no_frames,
        further_readers=READERS,
    )


def read_motion(
    path: AnyPath,
    *,
    amc_rate_hz: float = 120.0,
    unit_m: float | None = None,
    up: str = "y",
    asf: AnyPath | None = None,
    allow_no_frames: bool = False,
) -> tuple[_core.Motion, list[str]]:
    """The file's motion on its own skeleton, and warnings. Raises FormatError.

    unit_m: metres a unit of the file (None: what an .asf says, 0.01 for .bvh); up: the file's up
    axis, what is read has y up; asf: the skeleton of an .amc (None: the one found beside it). With
    allow_no_frames a skeleton alone, also an .asf, is a motion without frames.
    """
    options = read_options(
        amc_rate_hz=amc_rate_hz, unit_m=unit_m, up=up, asf=asf, allow_no_frames=allow_no_frames
    )
    return _core.read_motion(path, options)


def find_motion_files(sources: Sequence[AnyPath], exclude: Sequence[str] = ()) -> list[Path]:
    """The motion files that the sources are or hold, without those excluded, sorted.

    Raises FormatError when a source does not exist or nothing is left.
    """
    return _core.find_motion_files(sources, exclude, read_options())


def named_motion_files(
    sources: Sequence[AnyPath], exclude: Sequence[str] = ()
) -> list[tuple[Path, str]]:
    """As find_motion_files, each with the name that its clips have as their source."""
    return _core.named_motion_files(sources, exclude, read_options())
