# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap reconstruct``: a take into a motion."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from .. import (
    MotionDatabase,
    Reconstruction,
    Skeleton,
    Take,
    read_model,
    read_take,
    write_bvh,
    write_positions,
)
from ..alignment import aligned
from ..body_file import read_body
from ..calibration import Calibration
from ..calibration_file import read_calibration
from ..reconstruction import reconstruct as reconstruct_take
from ..report import is_unlike_the_database, match, report, unit_warnings
from .console import progress_bar, warn, write_json
from .options import (
    FilePath,
    MethodChoice,
    Span,
    body_option,
    check_ending,
    frame_option,
    method_choice,
    method_option,
    model_option,
    position_along_bone_option,
    positions_along_bone_of,
    preset_option,
    set_option,
)

__all__ = ["body_of", "model_of", "reconstruct", "require_given"]


@click.command()
@click.argument("take", metavar="TAKE.csv", type=FilePath)
@click.option("--database", "database_path", metavar="DB.smdb", type=FilePath)
@click.option("-o", "--output", type=FilePath, required=True, help="The motion (.bvh).")
@method_option
@preset_option
@set_option
@model_option
@body_option
@click.option(
    "--offline", is_flag=True,
    help="Best quality: every frame may look at the whole take. Without it, live quality.",
)  # fmt: skip
@click.option(
    "--gyroscopes/--no-gyroscopes", default=True, show_default=True,
    help="Also uses the direction of gravity, where gyroscopes (gx,gy,gz) tell it.",
)  # fmt: skip
@click.option("--positions", type=FilePath, help="Also writes the joints' positions (.csv).")
@frame_option
@click.option("--json", "json_path", type=FilePath, help="Also writes a report on every frame.")
@position_along_bone_option
@click.option(
    "--calibration", "calibration_path", type=FilePath, help="The sensors' calibration (.json)."
)
@click.option(
    "--clap", type=Span(), help="When all sensors saw one clap or jump: brings them onto one clock."
)
def reconstruct(
    take: Path,
    database_path: Path | None,
    output: Path,
    method: str | None,
    preset: str | None,
    settings: tuple[tuple[str, str], ...],
    model_path: Path | None,
    body_path: Path | None,
    offline: bool,
    gyroscopes: bool,
    positions: Path | None,
    frame: str,
    json_path: Path | None,
    positions_along_bone: tuple[tuple[str, float], ...],
    calibration_path: Path | None,
    clap: tuple[float, float] | None,
) -> None:
    """Turns a take into a motion on the method's skeleton and at its rate.

    With a motion database that is the database's standard skeleton and rate.
    """
    check_ending(output, ".bvh")
    choice = method_choice(method, preset, settings)
    require_given(choice, database_path, model_path, body_path)
    recorded = read_take(take) if clap is None else aligned(read_take(take), clap)[0]
    calibration = _calibration(calibration_path, recorded, positions_along_bone)
    database = None if database_path is None else MotionDatabase(database_path)
    with progress_bar("Reconstructing") as progress:
        solved = reconstruct_take(
            recorded,
            database,
            best_quality=offline,
            method=choice.method,
            preset=choice.preset,
            options=choice.options,
            calibration=calibration,
            positions_along_bone=dict(positions_along_bone),
            use_gyroscopes=gyroscopes,
            model=model_of(choice, model_path, database),
            body=body_of(body_path),
            progress=progress,
        )
    write_bvh(output, solved.motion)
    _write_positions(positions, solved, frame)
    if json_path is not None:
        about = _about(take, database_path, choice, offline, solved)
        write_json(json_path, about | report(solved, database))
    warn(unit_warnings(recorded))
    _print_summary(output, solved)


def _calibration(
    path: Path | None, take: Take, positions_along_bone: tuple[tuple[str, float], ...]
) -> Calibration | None:
    """Returns the calibration; without one, positions must be those of the take's sites."""
    if path is not None:
        return read_calibration(path)
    positions_along_bone_of(take.sites, positions_along_bone)
    return None


def require_given(
    choice: MethodChoice, database: Path | None, model: Path | None, body: Path | None
) -> None:
    """Raises MissingParameter for what the method needs and the command line lacks."""
    given = {"database": database, "model": model or database, "body": body}
    for need in choice.info.needs:
        if given[need] is None:
            raise click.UsageError(f"Missing option '--{need}': {choice.method} needs it.")


def body_of(path: Path | None) -> Skeleton | None:
    """Returns the skeleton of a body file."""
    return None if path is None else read_body(path).skeleton


def model_of(choice: MethodChoice, path: Path | None, database: MotionDatabase | None) -> Any:
    """Returns the model of the method: from a file of its own, or kept in the database."""
    if path is not None:
        return read_model(path)
    if "model" in choice.info.needs and database is not None:
        return database.model(choice.method)
    return None


def _write_positions(path: Path | None, solved: Reconstruction, frame: str) -> None:
    if path is None:
        return
    motion = solved.motion
    where = motion.joint_positions(frame)
    write_positions(path, solved.readings.times_s, motion.skeleton.names, where)


def _about(
    take: Path,
    database: Path | None,
    choice: MethodChoice,
    offline: bool,
    solved: Reconstruction,
) -> dict[str, Any]:
    late = solved.latency_s
    channels = {channel for sensor in solved.readings.channels for channel in sensor}
    return {
        "format": "sparse_mocap_report",
        "format_version": 1,
        "take": str(take),
        "database": None if database is None else str(database),
        "options": {
            "method": choice.method,
            "preset": choice.preset,
            "set": choice.options,
            "offline": offline,
            "positions_along_bone": solved.readings.positions_along_bone,
            "gyroscopes": "gravity_direction" in channels,
        },
        "rate_hz": solved.rate_hz,
        "latency_ms": None if late is None else 1000.0 * late,
    }


def _print_summary(output: Path, solved: Reconstruction) -> None:
    late = solved.latency_s
    quality = "best quality" if late is None else f"live quality, {1000.0 * late:.0f} ms behind"
    click.echo(
        f"{output}: {solved.motion.num_frames} frames, {quality}; sensors match the motion "
        f"database: {match(solved)}"
    )
    if is_unlike_the_database(solved):
        click.echo(
            "The database holds nothing like this performance: the motion is a guess. "
            "Add motion capture of such movements, and check where and how the sensors are worn."
        )
