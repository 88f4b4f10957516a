# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap database``: motion databases."""

from __future__ import annotations

import functools
import json
from collections.abc import Callable
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
from .console import import_bar, warn
from .database_info import described, show
from .options import FilePath

__all__ = ["add", "build", "database", "drop", "info"]

_IMPORT_OPTIONS = (
    click.option(
        "--exclude", metavar="GLOB", multiple=True,
        help="Leaves out files with such a name. May be repeated.",
    ),
    click.option("--strict", is_flag=True, help="Stops at the first file that cannot be used."),
    click.option(
        "--keep-duplicates", is_flag=True,
        help="Also takes files whose motion is there already, as from another format.",
    ),
    click.option(
        "--metadata", type=FilePath,
        help="A table file,actor,class,source,license that says what file names do not; by default"
        " metadata.csv in the source folder.",
    ),
    click.option(
        "--mapping", "mapping_path", metavar="MAP.json", type=FilePath,
        help="Takes these joints for the body's in skeletons that have them (see inspect).",
    ),
    click.option(
        "--threads", "num_threads", type=click.IntRange(0, 1024), default=0,
        help="How many; 0, the default, is one a processor. The database is the same.",
    ),
)  # fmt: skip


def _import_options(command: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(command)
    def with_mappings(*args: Any, mapping_path: Path | None, **options: Any) -> Any:
        by_hand = read_mapping(mapping_path) if mapping_path else {}
        return command(*args, by_hand=by_hand, mappings=mapping_folder(), **options)

    for option in reversed(_IMPORT_OPTIONS):
        with_mappings = option(with_mappings)
    return with_mappings


_output_option = click.option(
    "-o", "--output", type=FilePath, help="Where to write it; by default in the old one's place."
)


@click.group()
def database() -> None:
    """Builds motion databases, changes them, and shows what they hold."""


@database.command()
@click.argument("sources", metavar="SOURCE...", type=FilePath, nargs=-1, required=True)
@click.option("-o", "--output", type=FilePath, required=True, help="The database file (.smdb).")
@click.option(
    "--fps", type=float, default=25.0, show_default=True, help="Frames a second of the database."
)
@click.option("--mirror", is_flag=True, help="Adds every clip with left and right exchanged.")
@click.option("--reverse", is_flag=True, help="Adds every clip played backwards.")
@click.option(
    "--no-tempo-copies", is_flag=True,
    help="Leaves out the copies at 0.8 and 1.25 times the tempo, which help small databases.",
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

    SOURCE is a .bvh or .amc file, or a folder, which is searched recursively. An .amc needs its
    .asf beside it.
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
    _tell(output, report, fps)


@database.command()
@click.argument("path", metavar="DB.smdb", type=FilePath)
@click.argument("sources", metavar="SOURCE...", type=FilePath, nargs=-1, required=True)
@_output_option
@_import_options
def add(path: Path, sources: tuple[Path, ...], output: Path | None, **options: Any) -> None:
    """Adds motion capture to a database.

    On the database's own skeleton, at its rate and with its kinds of copies. Files that are in
    already are not read again; one that changed since takes the place of its old clips.
    """
    target = output or path
    with import_bar("Adding") as (progress, details):
        report = add_to_database(
            path, list(sources), target, progress=progress, details=details, **options
        )
    _tell(target, report, MotionDatabase(target).rate_hz)


@database.command()
@click.argument("path", metavar="DB.smdb", type=FilePath)
@click.option(
    "--clips", metavar="GLOB", multiple=True, required=True,
    help="Drops clips with such a name or source file, and their copies. May be repeated.",
)  # fmt: skip
@_output_option
def drop(path: Path, clips: tuple[str, ...], output: Path | None) -> None:
    """Drops clips from a database."""
    target = output or path
    dropped = drop_from_database(path, list(clips), target)
    left = MotionDatabase(target)
    click.echo(
        f"{target}: {dropped} clips dropped, {len(left.clips)} clips, {left.num_frames} frames left"
    )


@database.command()
@click.argument("path", metavar="DB.smdb", type=FilePath)
@click.option("--json", "as_json", is_flag=True, help="Prints everything, each clip too, as JSON.")
def info(path: Path, as_json: bool) -> None:
    """Shows what a database holds."""
    told = described(MotionDatabase(path))
    if as_json:
        click.echo(json.dumps(told, indent=2, ensure_ascii=False))
    else:
        show(told)


def _tell(output: Path, report: BuildReport, rate_hz: float) -> None:
    warn([f"left out: {reason}" for _, reason in report.skipped])
    warn([f"left out: {reason}" for _, reason in report.duplicates])
    warn(report.warnings)
    counts = {
        "left out": len(report.skipped),
        "duplicates": len(report.duplicates),
        "in already": report.num_known,
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
