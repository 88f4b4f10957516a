# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap reconstruct``: a take into a motion."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np
from numpy.typing import NDArray

from .. import (
    MotionDatabase,
    Reconstruction,
    read_take,
    readings_of,
    write_bvh,
    write_positions,
)
from ..alignment import aligned
from ..calibration import apply
from ..calibration import places_of as calibrated_places
from ..calibration_file import read_calibration
from ..reconstruction import (
    is_unlike_the_database,
    latency_ms,
    mean_misfit_mps2,
    report,
    suspicions,
)
from ..take import Take
from .console import progress_bar, warn, write_json
from .options import (
    FilePath,
    Span,
    check_ending,
    check_presets,
    frame_option,
    method_option,
    place_option,
    places_of,
)


@click.command()
@click.argument("take", metavar="TAKE.csv", type=FilePath)
@click.option("--database", "database_path", metavar="DB.smdb", type=FilePath, required=True)
@click.option("-o", "--output", type=FilePath, required=True, help="The motion (.bvh).")
@method_option
@click.option(
    "--preset", default="default", show_default=True, help="The method's settings by name."
)
@click.option("--offline", is_flag=True, help="Looks at the whole take for every frame.")
@click.option(
    "--gyroscopes/--no-gyroscopes", default=True, show_default=True,
    help="Also use the gravity direction at each sensor, if the take has gx,gy,gz.",
)  # fmt: skip
@click.option("--positions", type=FilePath, help="Also writes the joints' positions (.csv).")
@frame_option
@click.option("--json", "json_path", type=FilePath, help="Also writes a report on every frame.")
@place_option
@click.option(
    "--calibration", "calibration_path", type=FilePath, help="The sensors' calibration (.json)."
)
@click.option(
    "--clap", type=Span(), help="When all sensors saw one clap or jump: brings them onto one clock."
)
def reconstruct(
    take: Path,
    database_path: Path,
    output: Path,
    method: str,
    preset: str,
    offline: bool,
    gyroscopes: bool,
    positions: Path | None,
    frame: str,
    json_path: Path | None,
    places: tuple[tuple[str, float], ...],
    calibration_path: Path | None,
    clap: tuple[float, float] | None,
) -> None:
    """Turns a take into a motion.

    The motion is on the database's standard skeleton and at its rate.
    """
    check_ending(output, ".bvh")
    check_presets(method, [preset])
    recorded, known_places = _made_ideal(read_take(take), calibration_path, clap)
    database = MotionDatabase(database_path)
    where = places_of(recorded.sites, (*known_places, *places))
    readings = readings_of(
        recorded, database.rate_hz, places=where, offline=offline, uses_gyroscopes=gyroscopes
    )
    reconstructor = readings.channels.reconstructor(database, method=method, preset=preset)
    with progress_bar("Reconstructing") as progress:
        solved = reconstructor.solve(readings.values, offline=offline, progress=progress)
    times, forces = readings.times_s, readings.specific_force
    late = None if offline else latency_ms(reconstructor, database)
    write_bvh(output, solved.motion)
    if positions is not None:
        names = solved.motion.skeleton.names
        write_positions(positions, times, names, solved.motion.joint_positions(frame))
    if json_path is not None:
        options = {"method": method, "preset": preset, "offline": offline, "places": where,
                   "gyroscopes": any(readings.channels.has_up)}  # fmt: skip
        about = {"take": str(take), "database": str(database_path), "options": options,
                 "rate_hz": database.rate_hz, "latency_frames": reconstructor.latency_frames,
                 "latency_ms": late}  # fmt: skip
        told = report(database, recorded.sites, times, forces, solved)
        write_json(json_path, about | told)
    warn(suspicions(recorded))
    _tell(output, solved, forces, late)


def _made_ideal(
    take: Take, calibration_path: Path | None, clap: tuple[float, float] | None
) -> tuple[Take, list[tuple[str, float]]]:
    """Returns the take on one clock and calibrated, and the places that its calibration knows."""
    if clap is not None:
        take, _ = aligned(take, clap)
    if calibration_path is None:
        return take, []
    known = read_calibration(calibration_path)
    found = calibrated_places(known, take)
    take = apply(known, take)
    return take, list(zip(take.sites, found, strict=True))


def _tell(
    output: Path, solved: Reconstruction, readings: NDArray[np.float64], late_ms: float | None
) -> None:
    latency = "whole take" if late_ms is None else f"{late_ms:.0f} ms"
    click.echo(
        f"{output}: {len(readings)} frames, mean misfit {mean_misfit_mps2(solved):.2f} m/s^2,"
        f" latency {latency}"
    )
    if is_unlike_the_database(solved, readings):
        click.echo(
            "The database holds nothing like this performance: the motion is a guess. "
            "Add motion capture of such movements, and check where and how the sensors are worn."
        )
