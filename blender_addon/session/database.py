# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 1, the motion database: what is in it, and how one is built from motion files."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .clips import ClipTable, table_of
from .core import core
from .errors import InputError
from .job import Job, Progress
from .opened import Shelf

SUFFIX = ".smdb"
BUILDING = "Building the motion database"


@dataclass(frozen=True)
class Database:
    """An opened motion database and what the animator sees of it."""

    motions: Any  # sparse_mocap.MotionDatabase
    clips: ClipTable
    num_clips: int
    num_sources: int
    minutes: float
    rate_hz: float
    size_bytes: int


def open_database(path: str) -> Database:
    """The database in the file. Raises FormatError and OSError."""
    motions = core().MotionDatabase(path)
    clips = motions.clips
    return Database(
        motions=motions,
        clips=table_of(clips, motions.rate_hz),
        num_clips=len(clips),
        num_sources=len({clip.source for clip in clips}),
        minutes=motions.num_frames / motions.rate_hz / 60.0,
        rate_hz=motions.rate_hz,
        size_bytes=os.path.getsize(path),
    )


databases: Shelf[Database] = Shelf("motion database", open_database)


def build_job(source: str, output: str, *, mirror: bool, exclude: str) -> tuple[Job, str]:
    """The job that builds a database from a folder of motion files, and the file it will write.

    The job's result is a sparse_mocap.BuildReport. exclude: patterns of file names to leave
    out, separated by commas. Raises InputError.
    """
    sparse_mocap = core()
    if not source:
        raise InputError("Choose the folder of motion files (.bvh, or .asf with .amc) first")
    if not os.path.exists(source):
        raise InputError(f"There is no folder {source}: choose the folder of motion files")
    target = checked_output(output or default_output(source))
    patterns = [pattern.strip() for pattern in exclude.split(",") if pattern.strip()]

    def work(progress: Progress) -> Any:
        databases.forget()  # where an open file cannot be replaced
        return sparse_mocap.build_database(
            [source], target, mirror=mirror, exclude=patterns, progress=progress
        )

    return Job(BUILDING, work), target


def default_output(source: str) -> str:
    """The database file beside the folder that it is built from."""
    folder = Path(source)
    return str(folder.with_name(folder.name + SUFFIX)) if folder.name else ""


def checked_output(path: str) -> str:
    """The path with its ending; raises InputError when no file can be there."""
    if not path:
        raise InputError(f"Name the {SUFFIX} file to write")
    target = Path(path if path.endswith(SUFFIX) else path + SUFFIX)
    if target.is_dir():
        raise InputError(f"{target} is a folder: name a {SUFFIX} file")
    if not target.parent.is_dir():
        raise InputError(
            f"There is no folder {target.parent}: choose another place for {target.name}"
        )
    return str(target)
