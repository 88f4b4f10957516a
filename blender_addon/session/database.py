# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 1, the motion database: open one, or build one from motion files."""

from __future__ import annotations

import os
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .clips import ClipTable, table_of
from .core import core
from .errors import InputError
from .file_cache import FileCache
from .job import Job, Progress
from .names import file_name
from .steps import Steps

SUFFIX = ".smdb"
BUILDING = "Building the motion database"
TEMPOS = (0.8, 1.25)


@dataclass(frozen=True)
class Database:
    """An open motion database and what the panel shows of it."""

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


databases: FileCache[Database] = FileCache("motion database", open_database)


@dataclass(frozen=True)
class BuildChoices:
    """How a database is built."""

    rate_hz: float = 25.0
    mirror: bool = False
    reverse: bool = False
    tempos: bool = True
    """Whether a small database also gets copies at other tempos."""
    strict: bool = False
    """Whether the first file that cannot be used stops the build."""
    exclude: str = ""
    """Patterns of file names to exclude, separated by commas."""


@dataclass(frozen=True)
class BuildSummary:
    """The result of a build."""

    path: str
    num_files: int
    num_clips: int
    skipped: list[tuple[str, str]]
    """Skipped files, and why."""
    warnings: list[str]

    def text(self) -> str:
        """The report."""
        lines = [f"{self.path}: {self.num_clips} clips from {self.num_files} files"]
        lines += ["", f"Skipped: {len(self.skipped)}"]
        lines += [f"{name}: {reason}" for name, reason in self.skipped]
        lines += ["", f"Warnings: {len(self.warnings)}", *self.warnings]
        return "\n".join(lines) + "\n"


def build_from_motions_steps(
    motions: list[tuple[str, Any]], output: str, choices: BuildChoices
) -> Steps[BuildSummary]:
    """Build a database from named motions (sparse_mocap.Motion), and return what came of it.

    A name is the clip's source, with "/" between its parts. Raises InputError and what a build
    does.
    """
    if not motions:
        raise InputError("No armature in this file has an action that moves its bones")
    target = checked_output(output)
    with tempfile.TemporaryDirectory(prefix="sparse_mocap_") as folder:
        for done, (name, motion) in enumerate(motions):
            parts = name.split("/")
            if sys.platform == "win32":
                parts = [file_name(part) for part in parts]
            path = Path(folder, *parts[:-1], parts[-1] + ".bvh")
            while path.exists():  # Windows and macOS take Walk and walk for one name
                path = path.with_name(f"_{path.name}")
            path.parent.mkdir(parents=True, exist_ok=True)
            core().write_bvh(path, motion)
            yield 0.1 * done / len(motions)
        job, _ = build_job([folder], target, choices)
        job.start()
        try:
            while job.is_running:
                time.sleep(0.01)
                yield 0.1 + 0.9 * job.fraction
        finally:
            job.cancel()
            job.join()
        summary: BuildSummary = job.result()
        return summary


last_build: list[BuildSummary] = []
"""The summary of the last build, if there was one."""


def build_job(sources: list[str], output: str, choices: BuildChoices) -> tuple[Job, str]:
    """The job that builds a database from motion files and folders, and the file it will write.

    The job's result is a BuildSummary. Raises InputError.
    """
    sparse_mocap = core()
    named = list(dict.fromkeys(source for source in sources if source))
    if not named:
        raise InputError("Choose a folder with motion files (.bvh, or .amc with .asf) first")
    for source in named:
        if not os.path.exists(source):
            raise InputError(f"{source} does not exist: choose a folder with motion files")
    target = checked_output(output or default_output(named[0]))
    patterns = [pattern.strip() for pattern in choices.exclude.split(",") if pattern.strip()]

    def work(progress: Progress) -> BuildSummary:
        databases.forget()  # an open file cannot be replaced on Windows
        report = sparse_mocap.build_database(
            named,
            target,
            rate_hz=choices.rate_hz,
            mirror=choices.mirror,
            reverse=choices.reverse,
            tempo_copies=TEMPOS if choices.tempos else (),
            exclude=patterns,
            strict=choices.strict,
            mappings=sparse_mocap.mapping_folder(),
            progress=progress,
        )
        doubtful = [f"Doubtful: {reason}" for _, reason in report.doubtful]
        warnings = doubtful + report.warnings
        summary = BuildSummary(target, report.num_files, report.num_clips, report.skipped, warnings)
        last_build[:] = [summary]
        return summary

    return Job(BUILDING, work), target


def default_output(source: str) -> str:
    """The default database file, next to the folder that it is built from."""
    folder = Path(source)
    return str(folder.with_name(folder.name + SUFFIX)) if folder.name else ""


def checked_output(path: str) -> str:
    """The path with its extension; raises InputError when no file can be written there."""
    if not path:
        raise InputError(f"Choose a {SUFFIX} file to save to")
    target = Path(path if path.endswith(SUFFIX) else path + SUFFIX)
    if target.is_dir():
        raise InputError(f"{target} is a folder: choose a {SUFFIX} file to save to")
    if not target.parent.is_dir():
        raise InputError(f"There is no folder {target.parent}: choose where to save {target.name}")
    return str(target)
