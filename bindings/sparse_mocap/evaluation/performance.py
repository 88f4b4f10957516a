# SPDX-License-Identifier: GPL-3.0-or-later
"""A clip performed for the sensors, and reconstructed as a take would be."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import (
    Motion,
    MotionDatabase,
    Reconstruction,
    noise_presets,
    noisy,
    read_motion,
    resampled,
    simulated,
    to_standard,
)
from ..take import Take

Floats = NDArray[np.float64]

PAPER_SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
SENSOR_RATE_HZ = 100.0


@dataclass(frozen=True)
class Performance:
    """What simulated sensors read while someone performs a motion file."""

    motion: Motion
    """On the standard skeleton with the performer's own proportions."""
    take: Take
    times_s: Floats
    """(T,) at the database's rate."""
    readings: Floats
    """(T, S, 3) m/s^2, as a method takes them."""

    def motion_on(self, database: MotionDatabase) -> Motion:
        """The truth: the motion on the database's skeleton and at its rate."""
        return to_standard(self.motion, database.skeleton)[0].resampled(database.rate_hz)


def performed(
    path: str | os.PathLike[str],
    database_rate_hz: float,
    *,
    sites: Sequence[str] = PAPER_SITES,
    noise: str = "none",
    seed: int = 0,
    rate_hz: float = SENSOR_RATE_HZ,
) -> Performance:
    """Returns the performance of a motion file. Raises FormatError, MappingError and OSError."""
    motion, _ = to_standard(read_motion(path)[0])
    take = noisy(simulated(motion, sites, rate_hz), noise_presets()[noise], seed)
    times, readings = resampled(take, database_rate_hz)
    return Performance(motion, take, times, readings)


def reconstructed_positions(reconstruction: Reconstruction) -> Floats:
    """Returns where the joints are, (T, 21, 3) m in the heading frame."""
    return np.asarray(reconstruction.motion.joint_positions("heading"))
