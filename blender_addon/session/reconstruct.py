# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 3, the reconstruction: the full-body motion of a take."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .calibrating import calibration_at
from .core import core
from .database import Database, databases
from .job import Job, Progress
from .take import LoadedTake, takes

RECONSTRUCTING = "Reconstructing"


@dataclass(frozen=True)
class Performance:
    """A reconstructed take."""

    name: str
    motion: Any  # sparse_mocap.Motion
    duration_s: float
    misfit_mps2: float
    """Mean distance of the retrieved readings from the measured ones."""
    is_guess: bool
    """Whether the database holds nothing like it."""


def reconstruct_job(
    database_path: str, take_path: str, calibration_path: str = "", *, preset: str, offline: bool
) -> Job:
    """The job that reconstructs a take from a database; its result is a Performance.

    calibration_path: empty for sensors that are worn as the paper does. Raises InputError, or what
    the files are at fault for.
    """
    core()
    database = databases.get(database_path)
    take = takes.get(take_path)
    calibration = calibration_at(calibration_path)

    def work(progress: Progress) -> Performance:
        return reconstruct(
            database,
            take,
            calibration=calibration,
            preset=preset,
            offline=offline,
            progress=progress,
        )

    return Job(RECONSTRUCTING, work)


def reconstruct(
    database: Database,
    take: LoadedTake,
    *,
    calibration: Any = None,
    preset: str,
    offline: bool,
    progress: Progress,
) -> Performance:
    """The performance of the take. Raises what the core has to say about it."""
    sparse_mocap = core()
    worn, places = take.take, None
    if calibration is not None:
        worn = sparse_mocap.calibration.apply(calibration, take.take)
        places = sparse_mocap.calibration.places_of(calibration, take.take)
    readings = sparse_mocap.readings.readings_of(
        worn, database.rate_hz, places=places, offline=offline
    )
    solver = readings.channels.reconstructor(database.motions, preset=preset)
    solved = solver.solve(readings.values, offline=offline, progress=progress)
    motion = solved.motion
    quality = sparse_mocap.reconstruction
    return Performance(
        name=take.name,
        motion=motion,
        duration_s=(motion.num_frames - 1) * motion.frame_time_s,
        misfit_mps2=quality.mean_misfit_mps2(solved),
        is_guess=quality.is_unlike_the_database(solved, readings.specific_force),
    )
