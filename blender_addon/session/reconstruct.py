# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 3, the reconstruction: the full-body motion of a take."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .calibrating import calibration_at
from .certainty import SensorCurves, sensor_curves, spread_of
from .core import core
from .database import Database, databases
from .job import Job, Progress
from .match import Match, match_of
from .methods import MethodChoice, needs_database
from .take import LoadedTake, takes

RECONSTRUCTING = "Reconstructing"
ALTERNATIVES = ("B", "C")
_MOST_KEPT = 8


@dataclass(frozen=True)
class Performance:
    """A reconstructed take."""

    name: str
    motion: Any  # sparse_mocap.Motion
    contacts: NDArray[np.float64]
    """(T, 2) how certain it is that the left and the right foot stand, 0 to 1."""
    duration_s: float
    match: Match
    spread_m: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 0)))
    """(T, J) how far the retrieved poses deviate; (T, 0) where the method tells nothing."""
    curves: SensorCurves | None = None
    """What the sensors measured and should read."""
    latent: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 0)))
    """(T, D) places in the latent space; (T, 0) where the method has none."""
    motion_types: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, np.int64))
    """(T,) numbers of the types of motion that those belong to."""
    notes: tuple[str, ...] = ()
    """What the method says of the take, a line each."""
    letter: str = "A"
    """A, or B and C for its alternatives."""
    differences: tuple[tuple[float, float, float], ...] = ()
    """Where an alternative differs from A: from and to (s of the take), and by how much (m)."""
    alternatives: tuple[Performance, ...] = ()
    """Other motions that fit the sensors almost as well."""

    def frame_at(self, time_s: float) -> int | None:
        """The pose at a time; None outside the take."""
        frame = round(time_s / self.motion.frame_time_s) if np.isfinite(time_s) else -1
        return frame if 0 <= frame < self.motion.num_frames else None


def differences_text(parts: Sequence[tuple[float, float, float]]) -> str:
    """Where two motions differ: "1.4-3.2 s (11 cm), 5.0-5.8 s (9 cm)"."""
    return ", ".join(
        f"{begin:.1f}-{end:.1f} s ({100.0 * distance:.0f} cm)" for begin, end, distance in parts
    )


_kept: dict[str, Performance] = {}
"""The last results, by the take's name."""


def keep(performance: Performance) -> None:
    """Keep a result, so that it can be put on a character again."""
    _kept.pop(performance.name, None)
    _kept[performance.name] = performance
    while len(_kept) > _MOST_KEPT:
        _kept.pop(next(iter(_kept)))


def kept(name: str) -> Performance | None:
    """The last result of the take with that name, if it was made in this session."""
    return _kept.get(name)


def reconstruct_job(
    database_path: str,
    take_path: str,
    calibration_path: str = "",
    *,
    choice: MethodChoice,
    best_quality: bool,
    finish: Callable[[Performance, Progress], Any] = lambda performance, _: performance,
) -> Job:
    """The job that reconstructs a take from a database; its result is what finish makes of it.

    calibration_path: empty for sensors in the default orientation. Raises InputError, or what is
    wrong with the files.
    """
    core()
    database = databases.get(database_path) if needs_database(choice.method) else None
    take = takes.get(take_path)
    calibration = calibration_at(calibration_path)

    def work(progress: Progress) -> Any:
        performance = reconstruct(
            database,
            take,
            calibration=calibration,
            choice=choice,
            best_quality=best_quality,
            progress=progress,
        )
        return finish(performance, progress)

    return Job(RECONSTRUCTING, work)


def reconstruct(
    database: Database | None,
    take: LoadedTake,
    *,
    calibration: Any = None,
    choice: MethodChoice,
    best_quality: bool,
    progress: Progress,
) -> Performance:
    """The motion of the take; no database for methods that need none. Raises what the core says."""
    motions = database.motions if database is not None else None
    solved = core().reconstruct(
        take.take,
        motions,
        best_quality=best_quality,
        **choice.arguments(),
        calibration=calibration,
        progress=progress,
    )
    others = zip(ALTERNATIVES, solved.alternatives, strict=False)
    return replace(
        _performance(take.name, solved, motions),
        alternatives=tuple(
            replace(_performance(f"{take.name} {letter}", other, motions), letter=letter)
            for letter, other in others
        ),
    )


def _performance(name: str, solved: Any, motions: Any) -> Performance:
    motion = solved.motion
    return Performance(
        name=name,
        motion=motion,
        contacts=np.asarray(solved.contacts),
        duration_s=(motion.num_frames - 1) * motion.frame_time_s,
        match=match_of(solved, motions),
        spread_m=spread_of(solved),
        curves=sensor_curves(solved),
        latent=np.asarray(solved.diagnostics.get("latent", np.empty((motion.num_frames, 0)))),
        motion_types=np.asarray(
            solved.diagnostics.get("motion_type", np.zeros((motion.num_frames, 1)))
        )[:, 0].astype(np.int64),
        notes=tuple(solved.notes),
        differences=tuple(solved.differences),
    )
