# SPDX-License-Identifier: GPL-3.0-or-later
"""Which clips ``sparse-mocap train`` and ``phases`` work on."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import click

from .. import (
    Motion,
    MotionDatabase,
    TrainingClip,
    find_motion_files,
    read_motion,
    read_take,
    to_standard,
)
from ..calibration import sensor_inputs
from ..readings import Readings, all_readings, channels_in
from ..training import Segments, database_clips
from .console import warn
from .options import FilePath, Setting

__all__ = ["clip_options", "training_clips"]


def clip_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Clips as files and from a database; the command gets them as ``chosen``."""

    @functools.wraps(command)
    def with_clips(
        *args: Any,
        clips: tuple[Path, ...],
        database_path: Path | None,
        classes: tuple[str, ...],
        names: tuple[str, ...],
        types: tuple[tuple[str, str], ...],
        **options: Any,
    ) -> Any:
        chosen = {
            "files": clips, "database": database_path, "classes": classes, "names": names,
            "types": types,
        }  # fmt: skip
        return command(*args, chosen=chosen, **options)

    decorated: Callable[..., Any] = with_clips
    for option in (
        click.option(
            "--type", "types", type=Setting(), multiple=True, metavar="NAME=GLOB",
            help="Clips whose file names match are one type of motion, for example run=35_1*."
            " Can be repeated; takes are then recognised as one of the types.",
        ),
        click.option(
            "--clips", "names", multiple=True, metavar="GLOB",
            help="With --database: only clips with such names. Can be repeated.",
        ),
        click.option(
            "--class", "classes", multiple=True, metavar="NAME",
            help="With --database: only clips of this class; each class is a type of motion of its"
            " own. Can be repeated; `database info` lists them.",
        ),
        click.option(
            "--database", "database_path", metavar="DB.smdb", type=FilePath,
            help="Use clips of a motion database in place of files.",
        ),
        click.argument("clips", metavar="CLIP...", nargs=-1, type=FilePath),
    ):  # fmt: skip
        decorated = option(decorated)
    return decorated


def training_clips(
    chosen: Mapping[str, Any],
    options: Mapping[str, str],
    takes: Mapping[str, Path] = {},
    phases: Mapping[str, Segments] = {},
) -> list[TrainingClip]:
    """Returns the clips that clip_options() chose; takes are by file names, phases by clips' names.

    Raises UsageError and what is wrong with the clips.
    """
    files, database = chosen["files"], chosen["database"]
    if bool(files) == (database is not None):
        raise click.UsageError("Give motion files or --database DB.smdb, one of the two.")
    if database is None and (chosen["classes"] or chosen["names"]):
        raise click.UsageError(
            "--class and --clips need a motion database: add --database DB.smdb."
        )
    if database is not None:
        position = float(options.get("position_along_bone", 1.0))
        found = database_clips(
            MotionDatabase(database),
            classes=chosen["classes"],
            names=chosen["names"],
            position_along_bone=position,
        )
    else:
        found = _of_files([Path(path) for path in find_motion_files(files)], takes)
    _require_known(phases, [clip.name for clip in found], "--phases")
    for clip in found:
        for name, pattern in chosen["types"]:
            if fnmatch(clip.name, pattern):
                clip.motion_class = name
                break
        clip.segments = list(phases.get(clip.name, ()))
    return found


def _of_files(paths: Sequence[Path], takes: Mapping[str, Path]) -> list[TrainingClip]:
    _require_known(takes, [path.name for path in paths], "--take")
    found = []
    for path in paths:
        motion, warnings = read_motion(path)
        standard, more = to_standard(motion, extremities=True)
        warn([f"{path.name}: {line}" for line in [*warnings, *more]])
        take = takes.get(path.name)
        readings = None if take is None else _readings(take, standard)
        found.append(TrainingClip(path.stem, standard, readings=readings))
    return found


def _require_known(given: Mapping[str, Any], known: Sequence[str], option: str) -> None:
    unknown = sorted(set(given) - set(known))
    if unknown:
        raise click.BadParameter(
            f"no clip has the name {', '.join(unknown)}", param_hint=f"'{option}'"
        )


def _readings(take: Path, motion: Motion) -> Readings:
    recorded = read_take(take)
    channels = [channels_in(record) for record in recorded.sensors.values()]
    inputs = sensor_inputs(None, recorded.sites, channels)
    return all_readings(recorded, inputs, 1.0 / motion.frame_time_s, gravity_average="whole_take")
