# SPDX-License-Identifier: GPL-3.0-or-later
"""Which files ``sparse-mocap evaluate`` trains on and tests."""

from __future__ import annotations

from collections.abc import Sequence

import click

from .. import MotionDatabase
from ..evaluation import Settings, choose_tests
from .console import warn

__all__ = ["chosen_pairs", "with_files"]


def chosen_pairs(training: str | None, tests: str | None) -> tuple[tuple[str, str], ...]:
    """Returns the patterns of training and test files; none without --train."""
    if training is None:
        return ()
    if tests is None:
        raise click.UsageError("--train needs --tests: say which files to test.")
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
