# SPDX-License-Identifier: GPL-3.0-or-later
"""What models are trained from: clips of a motion database, and phases written by hand."""

from __future__ import annotations

import fnmatch
import os
from collections.abc import Mapping, Sequence

import numpy as np

from . import Clip, ConfigError, MotionDatabase, TrainingClip
from .readings import SensorInput, all_readings
from .table_errors import TableError, read_lines
from .take import SensorRecord, Take

__all__ = ["Segments", "database_clips", "read_phases", "trainable_classes", "write_phases"]

Segments = Sequence[tuple[float, str]]
"""When each part of a clip begins (s), and its label."""

_HEADER = "clip,begin_s,phase"


def trainable_classes(database: MotionDatabase) -> list[str]:
    """Returns the classes of the database's clips, sorted."""
    return sorted({clip.motion_class for clip in database.clips if clip.motion_class})


def database_clips(
    database: MotionDatabase,
    *,
    classes: Sequence[str] = (),
    names: Sequence[str] = (),
    position_along_bone: float = 1.0,
) -> list[TrainingClip]:
    """Returns clips of a database to train from, with the readings that it has of every site.

    classes are those of the clips, names are glob patterns of their names; without either, all
    clips. Copies (mirrored, reversed, other tempos) are left out. position_along_bone (0 to 1) is
    where simulated sensors sit. Raises ConfigError when a class or a pattern fits no clip.
    """
    originals = [
        (index, clip)
        for index, clip in enumerate(database.clips)
        if not (clip.is_mirrored or clip.is_reversed or clip.tempo != 1.0)
    ]
    for wanted in classes:
        if not any(clip.motion_class == wanted for _, clip in originals):
            known = ", ".join(trainable_classes(database)) or "none"
            raise ConfigError(
                f"the motion database has no clip of the class '{wanted}'; its classes are {known}"
            )
    for pattern in names:
        if not any(fnmatch.fnmatchcase(clip.name, pattern) for _, clip in originals):
            raise ConfigError(f"the motion database has no clip named '{pattern}'")
    return [
        _training_clip(database, index, clip, position_along_bone)
        for index, clip in originals
        if (not classes or clip.motion_class in classes)
        and (not names or any(fnmatch.fnmatchcase(clip.name, pattern) for pattern in names))
    ]


def _training_clip(
    database: MotionDatabase, index: int, clip: Clip, position_along_bone: float
) -> TrainingClip:
    rows = slice(clip.begin, clip.end)
    pivot, end, turning = (
        database.array(name)[rows].astype(float).reshape(clip.end - clip.begin, -1, 3)
        for name in ("specific_force_pivot", "specific_force_end", "angular_velocity")
    )
    force = (1.0 - position_along_bone) * pivot + position_along_bone * end
    times_s = np.arange(clip.end - clip.begin) / database.rate_hz
    sites = list(database.site_names)
    take = Take(
        {
            site: SensorRecord(times_s, force[:, column], turning[:, column])
            for column, site in enumerate(sites)
        }
    )
    inputs = [SensorInput(site, ["specific_force", "angular_velocity"]) for site in sites]
    return TrainingClip(
        clip.name,
        database.clip_motion(index),
        motion_class=clip.motion_class,
        readings=all_readings(take, inputs, database.rate_hz),
    )


def read_phases(path: str | os.PathLike[str]) -> dict[str, list[tuple[float, str]]]:
    """Returns the phases of clips, by the clips' names, from a CSV file.

    Its lines are ``clip,begin_s,phase``. Raises TableError naming the line, and OSError.
    """
    phases: dict[str, list[tuple[float, str]]] = {}
    for number, line in enumerate(read_lines(path, TableError), 1):
        fields = [field.strip() for field in line.split(",")]
        if number == 1:
            if ",".join(fields) != _HEADER:
                raise TableError(path, 1, f"the first line must be {_HEADER}")
            continue
        if not line.strip():
            continue
        if len(fields) != 3 or not fields[0]:
            raise TableError(path, number, f"expected {_HEADER}, got {len(fields)} fields")
        try:
            begin_s = float(fields[1])
        except ValueError:
            begin_s = float("nan")
        if not np.isfinite(begin_s) or begin_s < 0.0:
            raise TableError(path, number, f"'{fields[1]}' is no time in s")
        phases.setdefault(fields[0], []).append((begin_s, fields[2]))
    return phases


def write_phases(path: str | os.PathLike[str], phases: Mapping[str, Segments]) -> None:
    """Writes the phases of clips, by the clips' names, as read_phases reads them."""
    lines = [_HEADER]
    for clip, segments in phases.items():
        lines += [f"{clip},{begin_s:.3f},{label}" for begin_s, label in segments]
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write("\n".join(lines) + "\n")
