# SPDX-License-Identifier: GPL-3.0-or-later
"""Trying the add-on without data: generated movements, and a performer simulated on one of them."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .core import core, demo_motions
from .database import TEMPOS, Database, databases
from .job import Cancelled, Job, Progress
from .methods import MethodChoice
from .reconstruct import Performance, reconstruct
from .take import LoadedTake, takes

MAKING, TRYING = "Making the starter set", "Trying it"
TAKE = "simulated performer"
SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
_RATE_HZ, _NOISE = 100.0, "consumer"
_BUILT, _PERFORMED = 0.6, 0.65  # parts of the work that are then done


@dataclass(frozen=True)
class Demonstration:
    """What a simulated performer did, and what was reconstructed of it."""

    database: str
    take: str
    """The take's file."""
    loaded: LoadedTake
    performed: Any
    """sparse_mocap.Motion: what the performer really did, on the skeleton of the database."""
    performance: Performance


def starter_set_job(path: Path) -> Job:
    """The job that makes a motion database of generated movements; its result is its path."""
    core()

    def work(progress: Progress) -> str:
        make_starter_set(path, progress)
        return str(path)

    return Job(MAKING, work)


def make_starter_set(path: Path, progress: Progress) -> None:
    """Make a motion database of generated movements. Raises Cancelled and OSError."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="sparse_mocap_") as folder:
        generated = part_of(progress, 0.0, 0.5, "Generating movements")
        demo_motions().generate_library(Path(folder), progress=_stoppable(generated))
        databases.forget()  # an open file cannot be replaced on Windows
        core().build_database(
            [folder],
            path,
            mirror=True,
            tempo_copies=TEMPOS,
            progress=part_of(progress, 0.5, 1.0, "Building the database"),
        )


def try_it_job(database: Path, folder: Path) -> Job:
    """The job that lets a simulated performer perform; its result is a Demonstration.

    database: the starter set, which is made if it is not there. folder: where the take is saved.
    """
    core()

    def work(progress: Progress) -> Demonstration:
        opened = _opened(database, part_of(progress, 0.0, _BUILT))
        progress(int(100 * _BUILT), 100, "Simulating the performer")
        path = folder / f"{TAKE}.csv"
        performed = _perform(opened.motions.skeleton, path)
        take = takes.get(str(path))
        performance = reconstruct(
            opened,
            take,
            choice=MethodChoice(),
            best_quality=True,
            progress=part_of(progress, _PERFORMED, 1.0, "Reconstructing"),
        )
        return Demonstration(str(database), str(path), take, performed, performance)

    return Job(TRYING, work)


def part_of(progress: Progress, begin: float, end: float, what: str = "") -> Progress:
    """The progress of a part of the work, from one fraction to another."""

    def call(done: int, total: int, item: str = "") -> bool:
        fraction = begin + (end - begin) * done / max(total, 1)
        return progress(round(1000 * fraction), 1000, what or item)

    return call


def _opened(path: Path, progress: Progress) -> Database:
    """The starter set, made anew if it is not there or another version of the add-on made it."""
    try:
        return databases.get(str(path))
    except (OSError, ValueError):
        make_starter_set(path, progress)
    return databases.get(str(path))


def _stoppable(progress: Progress) -> Any:
    """As generate_library() calls it, which does not look at what is returned."""

    def call(done: int, total: int, item: str) -> None:
        if not progress(done, total, item):
            raise Cancelled("Cancelled")

    return call


def _perform(skeleton: Any, path: Path) -> Any:
    """What the performer did, on the skeleton; the take of four cheap sensors is at the path."""
    sparse_mocap = core()
    with tempfile.TemporaryDirectory(prefix="sparse_mocap_") as folder:
        file = demo_motions().generate_performance(Path(folder) / "performance.bvh")
        motion, _ = sparse_mocap.read_motion(file)
    own, _ = sparse_mocap.standard_motion(motion)
    noise = sparse_mocap.noise_presets()[_NOISE]
    ideal = sparse_mocap.simulated(own, list(SITES), _RATE_HZ)
    origin = f"generated movements, simulated sensors at {_RATE_HZ:g} Hz, noise {_NOISE}"
    path.parent.mkdir(parents=True, exist_ok=True)
    sensors = sparse_mocap.noisy(ideal, noise).sensors
    sparse_mocap.write_take(path, sparse_mocap.Take(sensors, (origin,)))
    return sparse_mocap.to_standard(motion, skeleton)[0]
