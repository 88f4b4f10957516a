# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap reconstruct``: reconstructs a motion from a take."""

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
from ..positions import num_written
from ..quality import quality_of
from ..reconstruction import reconstruct as reconstruct_take
from ..reconstruction import with_locations
from ..report import match, report, unit_warnings
from .console import progress_bar, warn, write_json
from .options import (
    FilePath,
    MethodChoice,
    OutputPath,
    Span,
    body_option,
    calibration_option,
    check_ending,
    extremities_option,
    frame_option,
    gyroscopes_option,
    method_choice,
    method_option,
    model_option,
    offline_option,
    position_along_bone_option,
    positions_along_bone_of,
    preset_option,
    set_option,
)

__all__ = ["body_of", "model_of", "reconstruct", "require_given"]


@click.command()
@click.argument("take", metavar="TAKE.csv", type=FilePath)
@click.option("--database", "database_path", metavar="DB.smdb", type=FilePath)
@click.option(
    "-o", "--output", type=FilePath, required=True, help="The motion file to write (.bvh)."
)
@method_option
@preset_option
@set_option
@model_option
@body_option
@offline_option
@gyroscopes_option
@click.option("--positions", type=OutputPath(), help="Also write the joint positions (.csv).")
@frame_option
@extremities_option
@click.option(
    "--alternatives",
    type=click.IntRange(0, 2),
    metavar="N",
    help="With --offline: also write up to N (1 or 2) other motions that fit the sensors almost as "
    "well, as OUT_b and OUT_c.",
)
@click.option(
    "--json", "json_path", type=OutputPath(), help="Also write a report on every frame as JSON."
)
@position_along_bone_option
@calibration_option
@click.option(
    "--clap", type=Span(),
    help="When all sensors measured the same clap or jump, to synchronize their clocks.",
)  # fmt: skip
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
    extremities: bool,
    alternatives: int | None,
    json_path: Path | None,
    positions_along_bone: tuple[tuple[str, float], ...],
    calibration_path: Path | None,
    clap: tuple[float, float] | None,
) -> None:
    """Reconstructs a motion from a take.

    The motion has the motion database's skeleton and frame rate, or the method's if none is used.
    """
    check_ending(output, ".bvh")
    choice = _choice(method, preset, settings, alternatives, offline)
    require_given(choice, database_path, model_path, body_path)
    recorded = _read(take, clap)
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
    _write(output, positions, solved, frame, extremities)
    _write_report(json_path, take, database, choice, offline, solved)
    warn([*_left_out(recorded, calibration), *unit_warnings(recorded)])
    _print_summary(output, solved, database)
    _write_alternatives(alternatives, output, positions, solved, frame, extremities)


def _choice(
    method: str | None,
    preset: str | None,
    settings: tuple[tuple[str, str], ...],
    alternatives: int | None,
    offline: bool,
) -> MethodChoice:
    """Returns the chosen method. Raises UsageError for alternatives without best quality."""
    if alternatives is None:
        return method_choice(method, preset, settings)
    if alternatives > 0 and not offline:
        raise click.UsageError("--alternatives works in best quality only: add --offline")
    return method_choice(method, preset, (*settings, ("alternatives", str(alternatives))))


def _read(path: Path, clap: tuple[float, float] | None) -> Take:
    """Returns the take, with synchronized clocks if the time of a clap is given."""
    take = read_take(path)
    return take if clap is None else aligned(take, clap)[0]


def _left_out(take: Take, calibration: Calibration | None) -> list[str]:
    """Returns a line that names the sensors that were not used, if there are such."""
    used = with_locations(take, calibration).sensors
    names = [name for name in take.sensors if name not in used]
    if not names:
        return []
    return [f"left out, because it is not known where they are worn: {', '.join(names)}"]


def _calibration(
    path: Path | None, take: Take, positions_along_bone: tuple[tuple[str, float], ...]
) -> Calibration | None:
    """Returns the calibration; without one, checks that the take has the positions' sensors."""
    if path is not None:
        return read_calibration(path)
    positions_along_bone_of(take.sites, positions_along_bone)
    return None


def require_given(
    choice: MethodChoice, database: Path | None, model: Path | None, body: Path | None
) -> None:
    """Raises UsageError if a file that the method needs is not given."""
    given = {"database": database, "model": model or database, "body": body}
    for need in choice.info.needs:
        if given[need] is None:
            raise click.UsageError(f"Missing option '--{need}': {choice.method} needs it.")


def body_of(path: Path | None) -> Skeleton | None:
    """Returns the skeleton of a body file."""
    return None if path is None else read_body(path).skeleton


def model_of(choice: MethodChoice, path: Path | None, database: MotionDatabase | None) -> Any:
    """Returns the model that the method needs, from its file or from the database."""
    if path is not None:
        return read_model(path)
    if "model" in choice.info.needs and database is not None:
        return database.model(choice.method)
    return None


def _write(
    output: Path, table: Path | None, solved: Reconstruction, frame: str, extremities: bool
) -> None:
    """Writes the motion, and its positions if there is a table for them."""
    motion = solved.motion
    write_bvh(output, motion)
    if table is None:
        return
    names = motion.skeleton.names
    count = num_written(names, extremities)
    positions = motion.joint_positions(frame)[:, :count]
    write_positions(table, solved.readings.times_s, names[:count], positions)


def _write_alternatives(
    wanted: int | None,
    output: Path,
    table: Path | None,
    solved: Reconstruction,
    frame: str,
    extremities: bool,
) -> None:
    """Writes each alternative beside the output and says where it differs."""
    for letter, other in zip("bc", solved.alternatives, strict=False):
        path = _beside(output, letter)
        _write(path, table and _beside(table, letter), other, frame, extremities)
        parts = ", ".join(
            f"{begin:.1f} to {end:.1f} s ({100.0 * distance:.0f} cm)"
            for begin, end, distance in other.differences
        )
        click.echo(f"{path}: differs from {parts}")
    if wanted and not solved.alternatives:
        click.echo("No other motion fits the sensors almost as well.")


def _beside(path: Path, letter: str) -> Path:
    """Returns the file of an alternative: ``take_b.bvh`` for ``take.bvh``."""
    return path.with_stem(f"{path.stem}_{letter}")


def _write_report(path: Path | None, *about: Any) -> None:
    if path is not None:
        write_json(path, _report(*about))


def _report(
    take: Path,
    database: MotionDatabase | None,
    choice: MethodChoice,
    offline: bool,
    solved: Reconstruction,
) -> dict[str, Any]:
    """Returns the options and the result, ready for JSON."""
    late = solved.latency_s
    channels = {channel for sensor in solved.readings.channels for channel in sensor}
    about = {
        "format": "sparse_mocap_report",
        "format_version": 1,
        "take": str(take),
        "database": None if database is None else database.path,
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
    return about | report(solved, database)


def _print_summary(output: Path, solved: Reconstruction, database: MotionDatabase | None) -> None:
    late = solved.latency_s
    for note in solved.notes:
        click.echo(note)
    known = "model" if database is None else "motion database"
    way = "best quality" if late is None else f"live quality, {1000.0 * late:.0f} ms delay"
    click.echo(
        f"{output}: {solved.motion.num_frames} frames, {way}; sensors match the {known}: "
        f"{match(solved, database)}"
    )
    quality = quality_of(solved, database)
    if quality is None or not quality.advice:
        return
    click.echo(f"{quality.advice[0].upper()}{quality.advice[1:]}.")
    poor = [second for second, label in enumerate(quality.second_labels) if label == "poor"]
    if poor and len(poor) < len(quality.second_labels):
        click.echo(f"Poor are the seconds from {_listed(poor)} s.")


def _listed(seconds: list[int]) -> str:
    """Returns stretches of seconds: "0 to 3, 7 to 8"."""
    begins = [s for s in seconds if s - 1 not in seconds]
    ends = [s + 1 for s in seconds if s + 1 not in seconds]
    return ", ".join(f"{begin} to {end}" for begin, end in zip(begins, ends, strict=True))
