# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap batch``: reconstructs many takes."""

from __future__ import annotations

from pathlib import Path

import click

from ..batch import BatchSettings, Solved, outputs, solve_batch
from ..databases import content_hash
from ..workers import cluster, processors
from .console import progress_bar
from .faults import Fault
from .options import (
    FilePath,
    body_option,
    calibration_option,
    gyroscopes_option,
    method_choice,
    method_option,
    model_option,
    offline_option,
    preset_option,
    scheduler_option,
    set_option,
)
from .reconstruct import require_given

__all__ = ["batch"]


@click.command()
@click.argument("takes", metavar="TAKE...", type=FilePath, nargs=-1, required=True)
@click.option("--database", "database_path", metavar="DB.smdb", type=FilePath)
@click.option(
    "-o", "--output", metavar="DIR", type=FilePath, required=True,
    help="The folder for the motion files (.bvh).",
)  # fmt: skip
@method_option
@preset_option
@set_option
@model_option
@body_option
@offline_option
@gyroscopes_option
@calibration_option
@click.option(
    "--threads", "num_threads", type=click.IntRange(0, 1024), default=0,
    help="How many takes to solve at once; by default one on each processor.",
)  # fmt: skip
@scheduler_option
def batch(
    takes: tuple[Path, ...],
    database_path: Path | None,
    output: Path,
    method: str | None,
    preset: str | None,
    settings: tuple[tuple[str, str], ...],
    model_path: Path | None,
    body_path: Path | None,
    offline: bool,
    gyroscopes: bool,
    calibration_path: Path | None,
    num_threads: int,
    scheduler: str | None,
) -> None:
    """Reconstructs motions from many takes, one file each.

    TAKE is a .csv file or a folder, which is searched recursively. Takes that an earlier run solved
    with the same settings are not solved again. One that cannot be solved is listed, and the others
    are solved nevertheless; the exit code is 1 then.
    """
    choice = method_choice(method, preset, settings)
    require_given(choice, database_path, model_path, body_path)
    wanted = BatchSettings(
        database=_absolute(database_path),
        database_hash=None if database_path is None else content_hash(database_path),
        method=choice.method,
        preset=choice.preset,
        options=choice.options,
        best_quality=offline,
        use_gyroscopes=gyroscopes,
        calibration=_absolute(calibration_path),
        model=_absolute(model_path),
        body=_absolute(body_path),
    )
    files = outputs(takes, output)
    executor = processors(num_threads) if scheduler is None else cluster(scheduler)
    with progress_bar("Reconstructing") as progress, executor as workers:
        solved = solve_batch(
            files,
            wanted,
            workers,
            lambda one, count: progress(count, len(files), Path(one.take).name),
        )
    _print(solved)


def _absolute(path: Path | None) -> str | None:
    return None if path is None else str(path.absolute())


def _print(solved: list[Solved]) -> None:
    for one in solved:
        if one.error is not None:
            click.echo(f"not solved: {one.take}: {one.error}", err=True)
        elif one.was_there:
            click.echo(f"{one.output}: there already")
        else:
            click.echo(
                f"{one.output}: {one.num_frames} frames; sensors match the motion database:"
                f" {one.match}"
            )
    failed = sum(one.error is not None for one in solved)
    if failed:
        raise Fault(f"{failed} of {len(solved)} takes were not solved")
