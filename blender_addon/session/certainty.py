# SPDX-License-Identifier: GPL-3.0-or-later
"""What a reconstruction says of itself: uncertain joints, and what the sensors should read."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .core import core

Floats = NDArray[np.float64]

UNSURE_FROM_M, GUESSED_FROM_M = 0.08, 0.15
"""From which deviation of the retrieved poses on a joint counts as unsure, and as guessed.

On HDM05, from a database without the performer, the deviation is about the median of the error.
"""


class Certainty(Enum):
    """How sure a joint's position is."""

    SURE = 0
    UNSURE = 1
    GUESSED = 2


def certainty_of(spread_m: float) -> Certainty:
    """How sure a joint is on which the retrieved poses deviate so much; SURE where unknown."""
    if spread_m >= GUESSED_FROM_M:
        return Certainty.GUESSED
    return Certainty.UNSURE if spread_m >= UNSURE_FROM_M else Certainty.SURE


@dataclass(frozen=True)
class SensorCurves:
    """What the sensors of a take measured, and what they should read on the result. T times."""

    sites: list[str]
    times_s: Floats  # (T,) from the take's first pose
    measured: Floats  # (T, S) magnitude of the specific force, m/s^2; NaN where it is missing
    expected: Floats  # (T, S)

    def around(self, time_s: float, half_s: float) -> SensorCurves:
        """The part that lies around a time, whose times are then from -half_s to half_s."""
        times_s = self.times_s - time_s
        shown = np.abs(times_s) <= half_s
        return SensorCurves(self.sites, times_s[shown], self.measured[shown], self.expected[shown])

    @property
    def largest(self) -> float:
        """The largest value, m/s^2."""
        values = np.concatenate([self.measured, self.expected])
        return float(np.max(values[np.isfinite(values)], initial=0.0))


def sensor_curves(solved: Any) -> SensorCurves | None:
    """The curves of a sparse_mocap.Reconstruction; None when there is nothing to compare."""
    readings, motion = solved.readings, solved.motion
    sites = list(readings.sites)
    if motion.num_frames < 3 or not sites or len(readings) != motion.num_frames:
        return None
    along = list(readings.positions_along_bone)
    read = core().simulate(motion, sites, solved.rate_hz, along)
    forces = np.asarray(read["specific_force"])
    times_s = np.arange(motion.num_frames) / solved.rate_hz
    measured = np.linalg.norm(np.asarray(readings.specific_force), axis=-1)
    expected = np.column_stack(
        [
            np.interp(times_s, read["time_s"], magnitude)
            for magnitude in np.linalg.norm(forces, axis=-1)
        ]
    )
    return SensorCurves(sites, times_s, measured, expected)


def spread_of(solved: Any) -> Floats:
    """(T, J) deviation of the retrieved poses, m; (T, 0) from a method that tells none."""
    told = solved.diagnostics.get("spread_m")
    return np.empty((solved.motion.num_frames, 0)) if told is None else np.asarray(told)
