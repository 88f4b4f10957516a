# SPDX-License-Identifier: GPL-3.0-or-later
"""Teaching the motion database: a motion together with what the sensors measured during it."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .calibrating import calibration_at
from .core import core
from .database import SUFFIX, databases
from .errors import InputError
from .job import Job, Progress
from .new_files import free_path

TEACHING = "Teaching the motion database"
MOTIONS = (".bvh", ".amc", ".npz", ".mvnx")
TAKES = (".csv",)


@dataclass(frozen=True)
class Lesson:
    """What to teach."""

    motion: str
    take: str
    clap_s: tuple[float, float] | None = None
    """When, in the take, a clap or jump is that the motion has too; None: found by comparing."""
    calibration: str = ""


@dataclass(frozen=True)
class Taught:
    """What became of it."""

    path: str
    """The new motion database."""
    name: str
    """Of the motion."""
    quality: str
    correlation: float
    begin_s: float
    """When the motion begins in the take."""
    notes: tuple[str, ...]


last_taught: list[Taught] = []
"""The last result, if there was one."""


def output_for(database: str) -> str:
    """A file beside the database that is not there yet."""
    stem = Path(database).stem
    name = stem if stem.endswith(" taught") else f"{stem} taught"
    return str(free_path(Path(database).with_name(name + SUFFIX)))


def teach_job(database: str, lesson: Lesson, output: str = "") -> Job:
    """The job that writes a new database, with the motion and its take beside what is there.

    The job's result is a Taught. Raises InputError, or what is wrong with the calibration.
    """
    sparse_mocap = core()
    if not database:
        raise InputError("Choose a motion database first")
    _require_file(lesson.motion, MOTIONS, "Choose the motion file that was performed first")
    _require_file(lesson.take, TAKES, "Choose the take (.csv) that was recorded with it first")
    if lesson.clap_s is not None and not lesson.clap_s[0] < lesson.clap_s[1]:
        raise InputError("The clap must end after it begins: change its times")
    calibration = calibration_at(lesson.calibration)
    target = output or output_for(database)

    def work(progress: Progress) -> Taught:
        databases.forget()  # an open file cannot be replaced on Windows
        taught = sparse_mocap.teach_database(
            database,
            lesson.motion,
            lesson.take,
            target,
            clap=lesson.clap_s,
            calibration=calibration,
            mappings=sparse_mocap.mapping_folder(),
            progress=progress,
        )
        return _summary(target, lesson, taught)

    return Job(TEACHING, work)


def _summary(target: str, lesson: Lesson, taught: Any) -> Taught:
    pairing = taught.pairing
    summary = Taught(
        target,
        Path(lesson.motion).stem,
        pairing.quality,
        pairing.correlation,
        pairing.begin_s,
        tuple(taught.notes),
    )
    last_taught[:] = [summary]
    return summary


def _require_file(path: str, endings: tuple[str, ...], missing: str) -> None:
    if not path:
        raise InputError(missing)
    if not os.path.isfile(path):
        raise InputError(f"{path} does not exist: choose another file")
    if not path.lower().endswith(endings):
        raise InputError(f"{Path(path).name} is not a {' or '.join(endings)} file")
