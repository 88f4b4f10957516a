# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files ``sparse-mocap evaluate`` trains on and tests, and their database."""

from __future__ import annotations

import atexit
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from pathlib import Path

import click

from .. import MotionDatabase
from ..evaluation import Settings, choose_tests
from ..evaluation.kept_database import DEFAULT_RATE_HZ, kept_database
from ..files import remove_folder
from .console import ProgressCallback, warn

__all__ = ["DEFAULT_FPS", "chosen_pairs", "evaluation_database", "with_files"]

DEFAULT_FPS = DEFAULT_RATE_HZ


def chosen_pairs(training: str | None, tests: str | None) -> tuple[tuple[str, str], ...]:
    """Returns the patterns of training and test files; none without --train."""
    if training is None:
        return ()
    if tests is None:
        raise click.UsageError("--train needs --tests: name the files to test.")
    return ((training, tests),)


def with_files(
    database: MotionDatabase, runs: Sequence[tuple[str, Settings]]
) -> list[tuple[str, Settings]]:
    """Returns the runs whose files are in the database, with a warning for each other one."""
    there = []
    for title, run in runs:
        if not run.pairs or any(choose_tests(database.clips, test) for _, test in run.pairs):
            there.append((title, run))
        else:
            warn([f"not run, since its files are not there: {title}"])
    return there


@contextmanager
def evaluation_database(
    source: Path,
    cache: Path | None,
    fps: float,
    progress: ProgressCallback,
    workers: Executor | None,
) -> Iterator[MotionDatabase]:
    """Yields the folder's database with mirrored copies, from the cache if nothing has changed."""
    with tempfile.TemporaryDirectory(
        prefix="sparse_mocap_", ignore_cleanup_errors=True
    ) as temporary:
        atexit.register(remove_folder, temporary)  # Windows removes no database that is open
        folder = Path(temporary) if cache is None else cache
        path = kept_database([source], folder, rate_hz=fps, progress=progress, workers=workers)
        yield MotionDatabase(path)
