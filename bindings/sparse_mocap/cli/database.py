# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap database``: motion databases."""

from __future__ import annotations

import functools
import json
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import click

from .. import (
    BuildReport,
    MotionDatabase,
    add_to_database,
    build_database,
    drop_from_database,
    mapping_folder,
    read_mapping,
)
from ..calibration_file import read_calibration
from ..motion_files import read_options
from ..teaching import teach_database
from ..workers import cluster
from .console import import_bar, warn
from .database_info import described, show
from .options import FilePath, Span, calibration_option, reading_options, scheduler_option

__all__ = ["add", "build", "database", "drop", "info_command"]

_IMPORT_OPTIONS = (
    click.option(
        "--exclude", metavar="GLOB", multiple=True,
        help="Exclude files with a matching name. Can be repeated.",
    ),
    click.option(
        "--strict", is_flag=True,
        help="Stop at the first file that cannot be used or whose motion is doubtful.",
    ),
    click.option(
        "--keep-duplicates", is_flag=True,
        help="Keep files whose motion is already in the database, for example from another format.",
    ),
    click.option(
        "--metadata", type=FilePath,
        help="A table with the columns file,actor,class,source,license,rate_hz, or the index of"
        " the CMU database; by default metadata.csv in the source folder.",
    ),
    click.option(
        "--mapping", "mapping_path", metavar="MAP.json", type=FilePath,
        help="Skeleton mapping to use for skeletons that have its joints (see inspect).",
    ),
    click.option(
        "--threads", "num_threads", type=click.IntRange(0, 1024), default=0,
        help="Number of threads; 0, the default, uses all processors. Does not affect the result.",
    ),
    scheduler_option,
)  # fmt: skip


def _import_options(command: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(command)
    def with_mappings(
        *args: Any,
        mapping_path: Path | None,
        reading: dict[str, Any],
        scheduler: str | None,
        **options: Any,
    ) -> Any:
        options["by_hand"] = read_mapping(mapping_path) if mapping_path else {}
        options["read"] = read_options(**reading)
        with nullcontext() if scheduler is None else cluster(scheduler) as workers:
            return command(*args, mappings=mapping_folder(), workers=workers, **options)

    with_options = reading_options(with_mappings)
    for option in reversed(_IMPORT_OPTIONS):
        with_options = option(with_options)
    return with_options


_output_option = click.option(
    "-o", "--output", type=FilePath, help="The file to write; by default replaces the database."
)


@click.group()
def database() -> None:
    """Builds, changes and shows motion databases."""


@database.command()
@click.argument("sources", metavar="SOURCE...", type=FilePath, nargs=-1, required=True)
@click.option(
    "-o", "--output", type=FilePath, required=True, help="The database file to write (.smdb)."
)
@click.option(
    "--fps", type=float, default=25.0, show_default=True, help="Frames per second of the database."
)
@click.option("--mirror", is_flag=True, help="Also add a mirrored copy of every clip.")
@click.option("--reverse", is_flag=True, help="Also add a reversed copy of every clip.")
@click.option(
    "--no-tempo-copies", is_flag=True,
    help="Do not add copies at 0.8 and 1.25 times the tempo, which improve small databases.",
)  # fmt: skip
@_import_options
def build(
    sources: tuple[Path, ...],
    output: Path,
    fps: float,
    mirror: bool,
    reverse: bool,
    no_tempo_copies: bool,
    **options: Any,
) -> None:
    """Builds a database from motion capture.

    SOURCE is a .bvh, .amc, .npz (SMPL, AMASS) or .mvnx file, or a folder, which is searched
    recursively. An .amc needs its .asf in the same folder.
    """
    if no_tempo_copies:
        options["tempo_copies"] = ()
    with import_bar("Building") as (progress, details):
        report = build_database(
            list(sources),
            output,
            rate_hz=fps,
            mirror=mirror,
            reverse=reverse,
            progress=progress,
            details=details,
            **options,
        )
    _print(output, report, fps)


@database.command()
@click.argument("path", metavar="DB.smdb", type=FilePath)
@click.argument("sources", metavar="SOURCE...", type=FilePath, nargs=-1, required=True)
@_output_option
@click.option(
    "--rebuild", is_flag=True,
    help="Build everything anew, so that the skeleton is averaged over all bodies. The sources must"
    " include the files that are in the database.",
)  # fmt: skip
@click.option(
    "--take", "take_path", metavar="TAKE.csv", type=FilePath,
    help="What sensors recorded during the motion (one file): the database keeps these readings"
    " in place of virtual ones.",
)  # fmt: skip
@click.option(
    "--clap", type=Span(),
    help="When the take has a clap or jump that the motion has too, in the take's seconds; by"
    " default the two are aligned by comparing all readings.",
)  # fmt: skip
@calibration_option
@_import_options
def add(
    path: Path,
    sources: tuple[Path, ...],
    output: Path | None,
    take_path: Path | None,
    clap: tuple[float, float] | None,
    calibration_path: Path | None,
    **options: Any,
) -> None:
    """Adds motion capture to a database.

    The new clips get the database's skeleton, frame rate and kinds of copies. Files already in the
    database are not read again; clips of files that have changed are replaced.

    With --take, the database learns what your own sensors measure: perform a movement with the
    sensors on while it is captured in another way, such as from video.
    """
    target = output or path
    if take_path is not None:
        _teach(path, sources, target, take_path, clap, calibration_path, options)
        return
    if clap is not None or calibration_path is not None:
        raise click.UsageError("--clap and --calibration need --take")
    with import_bar("Adding") as (progress, details):
        report = add_to_database(
            path, list(sources), target, progress=progress, details=details, **options
        )
    _print(target, report, MotionDatabase(target).rate_hz)


def _teach(
    path: Path,
    sources: tuple[Path, ...],
    target: Path,
    take_path: Path,
    clap: tuple[float, float] | None,
    calibration_path: Path | None,
    options: dict[str, Any],
) -> None:
    if options.get("rebuild"):
        raise click.UsageError(
            "--take cannot be used with --rebuild: add the take first, then rebuild, which keeps it"
        )
    if len(sources) != 1 or sources[0].is_dir():
        raise click.UsageError("--take needs one motion file, the one performed during the take")
    options.pop("rebuild", None)
    by_hand = options.pop("by_hand")
    with import_bar("Adding") as (progress, details):
        taught = teach_database(
            path,
            sources[0],
            take_path,
            target,
            clap=clap,
            calibration=None if calibration_path is None else read_calibration(calibration_path),
            progress=progress,
            details=details,
            by_hand=by_hand,
            **options,
        )
    _print(target, taught.report, MotionDatabase(target).rate_hz)
    click.echo(f"{take_path.name}: {taught.pairing.line}")
    channels = sorted({channel for own in taught.real.values() for channel in own})
    click.echo(f"real readings of {', '.join(taught.real)}: {', '.join(channels)}")
    warn(taught.notes)


@database.command()
@click.argument("path", metavar="DB.smdb", type=FilePath)
@click.option(
    "--clips", metavar="GLOB", multiple=True, required=True,
    help="Remove clips with a matching name or source file, and their copies. Can be repeated.",
)  # fmt: skip
@_output_option
def drop(path: Path, clips: tuple[str, ...], output: Path | None) -> None:
    """Removes clips from a database."""
    target = output or path
    dropped = drop_from_database(path, list(clips), target)
    left = MotionDatabase(target)
    click.echo(
        f"{target}: {dropped} clips removed, {len(left.clips)} clips, {left.num_frames} frames left"
    )


@database.command("info")
@click.argument("path", metavar="DB.smdb", type=FilePath)
@click.option(
    "--json", "as_json", is_flag=True, help="Print everything, including every clip, as JSON."
)
def info_command(path: Path, as_json: bool) -> None:
    """Shows the content of a database."""
    info = described(MotionDatabase(path))
    if as_json:
        click.echo(json.dumps(info, indent=2, ensure_ascii=False))
    else:
        show(info)


def _print(output: Path, report: BuildReport, rate_hz: float) -> None:
    warn([f"skipped: {reason}" for _, reason in report.skipped])
    warn([f"skipped: {reason}" for _, reason in report.duplicates])
    warn([f"doubtful: {reason}" for _, reason in report.doubtful])
    warn(report.warnings)
    counts = {
        "skipped": len(report.skipped),
        "duplicates": len(report.duplicates),
        "doubtful": len({path for path, _ in report.doubtful}),
        "unchanged": report.num_known,
        "replaced": report.num_replaced,
    }
    more = "".join(f", {count} {what}" for what, count in counts.items() if count)
    click.echo(
        f"{output}: {report.num_clips} clips, {report.num_frames} frames"
        f" ({report.num_frames / rate_hz / 60:.1f} min) from {report.num_files} files{more}"
    )
    if report.elapsed_s > 0 and report.num_files:
        click.echo(
            f"{report.source_frames} frames and {report.source_bytes / 1e6:.1f} MB of motion files"
            f" in {report.elapsed_s:.1f} s: {report.source_frames / report.elapsed_s:.0f} frames/s,"
            f" {report.source_bytes / 1e6 / report.elapsed_s:.1f} MB/s"
        )
