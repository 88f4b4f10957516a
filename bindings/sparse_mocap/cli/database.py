# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap database``: motion databases."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

import click

from .. import MotionDatabase, build_database
from .console import progress_bar, warn
from .options import FilePath


@click.group()
def database() -> None:
    """Builds motion databases and shows what they hold."""


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
@click.option(
    "--exclude", metavar="GLOB", multiple=True,
    help="Leaves out files with such a name. May be repeated.",
)  # fmt: skip
@click.option("--strict", is_flag=True, help="Stops at the first file that cannot be used.")
def build(
    sources: tuple[Path, ...],
    output: Path,
    fps: float,
    mirror: bool,
    reverse: bool,
    no_tempo_copies: bool,
    exclude: tuple[str, ...],
    strict: bool,
) -> None:
    """Builds a database from motion capture.

    SOURCE is a .bvh or .amc file, or a folder, which is searched recursively. An .amc needs its
    .asf beside it.
    """
    with progress_bar("Building") as progress:
        report = build_database(
            list(sources),
            output,
            rate_hz=fps,
            mirror=mirror,
            reverse=reverse,
            exclude=exclude,
            strict=strict,
            progress=progress,
            **({"tempo_copies": ()} if no_tempo_copies else {}),
        )
    warn([f"left out: {reason}" for _, reason in report.skipped])
    warn(report.warnings)
    click.echo(
        f"{output}: {report.num_clips} clips, {report.num_frames} frames"
        f" ({report.num_frames / fps / 60:.1f} min) from {report.num_files} files"
        f"{f', {len(report.skipped)} left out' if report.skipped else ''}"
    )


@database.command()
@click.argument("path", metavar="DB.smdb", type=FilePath)
@click.option("--json", "as_json", is_flag=True, help="Prints everything, each clip too, as JSON.")
def info(path: Path, as_json: bool) -> None:
    """Shows what a database holds."""
    described = _described(MotionDatabase(path))
    if as_json:
        click.echo(json.dumps(described, indent=2, ensure_ascii=False))
    else:
        _show(described)


def _described(opened: MotionDatabase) -> dict[str, Any]:
    clips = opened.clips
    return {
        "path": opened.path,
        "bytes": Path(opened.path).stat().st_size,
        "frames": opened.num_frames,
        "rate_hz": opened.rate_hz,
        "duration_s": opened.num_frames / opened.rate_hz,
        "joints": list(opened.skeleton.names),
        "sites": list(opened.site_names),
        "num_clips": len(clips),
        "num_mirrored": sum(clip.is_mirrored for clip in clips),
        "num_reversed": sum(clip.is_reversed for clip in clips),
        "num_tempo_copies": sum(clip.tempo != 1.0 for clip in clips),
        "actors": dict(sorted(Counter(clip.actor for clip in clips).items())),
        "motion_classes": dict(sorted(Counter(clip.motion_class for clip in clips).items())),
        "build": json.loads(opened.build_info),
        "clips": [
            {
                "name": clip.name,
                "actor": clip.actor,
                "motion_class": clip.motion_class,
                "source": clip.source,
                "source_hash": clip.source_hash,
                "is_mirrored": clip.is_mirrored,
                "is_reversed": clip.is_reversed,
                "tempo": clip.tempo,
                "begin": clip.begin,
                "end": clip.end,
            }
            for clip in clips
        ],
    }


def _show(described: dict[str, Any]) -> None:
    rows = {
        "file": f"{described['path']}, {described['bytes'] / 1e6:.1f} MB",
        "frames": f"{described['frames']} at {described['rate_hz']:g} Hz,"
        f" {described['duration_s'] / 60:.1f} min",
        "clips": f"{described['num_clips']}, of which {described['num_mirrored']} mirrored"
        f" and {described['num_reversed']} reversed,"
        f" {described['num_tempo_copies']} at another tempo",
        "actors": _counted(described["actors"]),
        "classes": _counted(described["motion_classes"]),
        "sites": ", ".join(described["sites"]),
        "joints": " ".join(described["joints"]),
        "build": ", ".join(f"{key} {value}" for key, value in described["build"].items()),
    }
    for name, text in rows.items():
        click.echo(f"{name:<8} {text}")


def _counted(counts: dict[str, int]) -> str:
    shown = [f"{name} ({count})" for name, count in list(counts.items())[:40]]
    more = [f"and {len(counts) - 40} more"] if len(counts) > 40 else []
    return ", ".join(shown + more)
