# SPDX-License-Identifier: GPL-3.0-or-later
"""The demonstration's steps, from a motion to a reconstruction in Blender."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import click
import numpy as np
from numpy.typing import NDArray
from sparse_mocap import (
    MotionDatabase,
    Reconstruction,
    build_database,
    mapping_folder,
    nearest_poses,
    reconstruct,
    write_bvh,
    write_take,
)
from sparse_mocap.cli.console import progress_bar
from sparse_mocap.evaluation import (
    Performance,
    frame_errors,
    interpolated,
    joint_errors,
    performed,
)
from sparse_mocap.evaluation.metrics import CM
from sparse_mocap.plots import plot_errors_over_time
from sparse_mocap.take import Take

from .blender import find_blender, make_example, render
from .choice import Choice, generated, recorded
from .sensors import record_emulated

Floats = NDArray[np.float64]


def play(
    output: Path, database_source: Path | None, blender: Path | None, is_blender_wanted: bool
) -> int:
    """Plays the whole path and says what came of it; 1 when Blender's part is missing."""
    output.mkdir(parents=True, exist_ok=True)
    output = output.resolve()
    choice = _chosen(output, database_source)
    database = _built(choice, output / "database.smdb")
    performance = _captured(performed(choice.performance), output)
    origin = f"simulated from {choice.performance.name} at 100 Hz without noise"
    take = Take(performance.take.sensors, (origin, *performance.take.comments))
    write_take(output / "take.csv", take)
    with progress_bar("Reconstructing") as progress:
        solved = reconstruct(take, database, use_gyroscopes=False, progress=progress)
    write_bvh(output / "take.bvh", solved.motion)
    write_bvh(output / "performed.bvh", performance.motion_on(database))
    assert solved.latency_s is not None
    click.echo(
        f"Reconstructed {len(solved.readings)} frames from four simulated accelerometers without"
        f" noise, in live quality, {1000.0 * solved.latency_s:.0f} ms delay"
    )
    _compare(database, performance, solved, output / "errors.png")
    _say("take", output / "take.csv")
    _say("performed motion", output / "performed.bvh")
    _say("reconstructed motion", output / "take.bvh")
    _say("error over time", output / "errors.png")
    return _show_in_blender(output, blender) if is_blender_wanted else 0


def _captured(performance: Performance, output: Path) -> Performance:
    """Returns the performance as emulated sensors on a port were recorded."""
    with progress_bar("Recording") as progress:
        take = record_emulated(performance.take, output / "capture", progress)
    count = sum(len(record.times_s) for record in take.sensors.values())
    sent = sum(len(record.times_s) for record in performance.take.sensors.values())
    click.echo(f"Recorded {count} of {sent} samples from four emulated sensors on a port")
    return replace(performance, take=take)


def _chosen(output: Path, database_source: Path | None) -> Choice:
    if database_source is None:
        with progress_bar("Generating") as progress:
            choice = generated(output, progress)
        click.echo("Performing a generated motion of an actor the database does not know")
        return choice
    with progress_bar("Reading") as progress:
        choice = recorded(database_source, progress)
    click.echo(f"Performing {choice.performance.name}, which the database is built without")
    return choice


def _built(choice: Choice, path: Path) -> MotionDatabase:
    with progress_bar("Building") as progress:
        report = build_database(
            [choice.library],
            path,
            mirror=True,
            exclude=choice.exclude,
            mappings=mapping_folder(),
            progress=progress,
        )
    click.echo(
        f"Built a database of {report.num_clips} clips, {report.num_frames} frames,"
        f" from {report.num_files} files"
    )
    return MotionDatabase(path)


def _compare(
    database: MotionDatabase, performance: Performance, solved: Reconstruction, plot: Path
) -> None:
    """Says and draws how far the reconstruction is from the truth, and the best pose there is."""
    truth = np.asarray(performance.motion_on(database).joint_positions("heading"))
    times = np.arange(len(truth)) / database.rate_hz
    estimate_times = np.asarray(solved.readings.times_s)
    times = times[times <= estimate_times[-1]]
    truth = truth[: len(times)]
    motion = solved.motion.without_extremities()
    positions = np.asarray(motion.joint_positions("heading"))
    estimate = interpolated(estimate_times, positions, times)
    poses = database.array("positions").reshape(database.num_frames, -1, 3)
    oracle = np.asarray(poses[nearest_poses(database, truth)], float)
    errors = CM * frame_errors(joint_errors(truth, estimate))
    best = CM * frame_errors(joint_errors(truth, oracle))
    plot_errors_over_time(
        {
            "reconstruction": (times, errors),
            "oracle (nearest pose in the database)": (times, best),
        },
        "Reconstruction from four accelerometers",
        plot,
    )
    click.echo(
        f"Error {errors.mean():.1f} cm (RMS over the joints, mean over the frames);"
        f" the database's nearest poses to the truth: {best.mean():.1f} cm"
    )


def _show_in_blender(output: Path, named: Path | None) -> int:
    blender = find_blender(named)
    if blender is None:
        missing = f"{named} is not a program" if named else "no Blender was found"
        click.echo(f"Left out take.blend and figures.png: {missing}", err=True)
        return 1
    click.echo("Rendering in Blender ...")
    scene = render(blender, output / "performed.bvh", output / "take.bvh", output)
    if scene.fault:
        click.echo(f"Left out take.blend and figures.png: Blender {scene.fault}", err=True)
        return 1
    _say("Blender file", scene.blend)
    _say("picture", scene.picture)
    example = output / "example.blend"
    fault = make_example(blender, example)
    if fault:
        click.echo(f"Left out example.blend: Blender {fault}", err=True)
        return 1
    _say("example of the add-on", example)
    return 0


def _say(what: str, path: Path) -> None:
    click.echo(f"  {what:<22} {path}")
