# SPDX-License-Identifier: GPL-3.0-or-later
"""From the samples of a capture to the newest pose."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .core import capture, core
from .errors import InputError

MOST_BEHIND = 15
"""More readings than this that wait for the solver are given up, and it begins anew."""
_WINDOW = 250  # poses, for what is shown


@dataclass(frozen=True)
class Pose:
    """One pose on the standard skeleton, in the core's axes."""

    number: int
    rotations: NDArray[np.float64]  # (J, 4) w x y z, the root's in the world
    root_position: NDArray[np.float64]  # (3,) m
    time_s: float
    """When the sensors read it, on the machine's monotonic clock."""


@dataclass(frozen=True)
class Quality:
    """How the last poses came out; 0 before there are any."""

    num_poses: int = 0
    num_skipped: int = 0
    """Readings that came faster than poses could be made of them."""
    misfit_mps2: float = 0.0
    latency_s: float = 0.0
    """Median time from the sensors' reading to the pose."""
    worst_latency_s: float = 0.0
    """Of 99 in 100 poses."""


class LivePoses:
    """Reconstructs what sensors read, as it comes; use it from one thread."""

    def __init__(
        self,
        motions: Any,
        sensors: dict[int, str],
        preset: str,
        calibration: Any = None,
        with_gyroscope: frozenset[int] = frozenset(),
    ) -> None:
        """sensors: where each sensor of the capture is worn, by its number there.

        calibration: sparse_mocap.calibration.Calibration; None: worn as the paper does.
        """
        self._has_up = [number in with_gyroscope for number in sensors]
        self._worn = core().calibration.worn_as(calibration, list(sensors.values()))
        known = core().site_names()
        for site in self._worn.sites:
            if site not in known:
                raise InputError(f'Unknown sensor location "{site}": set the sensor locations')
        channels = core().readings.Channels(self._worn.sites, self._worn.places, self._has_up)
        self._solver = channels.reconstructor(motions, preset=preset)
        live_readings = capture().live_readings
        self._readings = live_readings.LiveReadings(
            list(sensors), motions.rate_hz, self._has_up, self._worn.gyroscope_biases
        )
        self._times_s: deque[float] = deque(maxlen=self._solver.latency_frames + 1)
        self._misfits: deque[float] = deque(maxlen=_WINDOW)
        self.latencies_s: deque[float] = deque(maxlen=_WINDOW)
        self._num_poses = self._num_skipped = 0

    def advance(self, samples: Any) -> Pose | None:
        """Take in samples, and return the newest pose that is due, None when none is."""
        self._readings.add(samples)
        readings = self._readings.ready(time.monotonic())
        if len(readings) > MOST_BEHIND:
            self._num_skipped += len(readings) - 1
            readings = readings[-1:]
            self._solver.reset()
            self._times_s.clear()
        pose = None
        for reading in readings:
            self._times_s.append(reading.time_s)
            estimate = self._solver.step(self._worn.ideal(reading.values, self._has_up))
            if estimate is not None:
                pose = self._pose(estimate)
        return pose

    def quality(self) -> Quality:
        """How the last poses came out."""
        if not self.latencies_s:
            return Quality(num_skipped=self._num_skipped)
        middle, worst = np.quantile(self.latencies_s, [0.5, 0.99])
        misfit = float(np.mean(self._misfits)) if self._misfits else 0.0
        return Quality(self._num_poses, self._num_skipped, misfit, float(middle), float(worst))

    def _pose(self, estimate: Any) -> Pose:
        self._num_poses += 1
        misfits = np.asarray(estimate.sensor_misfit_mps2)
        heard = misfits[np.isfinite(misfits)]
        if len(heard):
            self._misfits.append(float(heard.mean()))
        time_s = self._times_s[0]
        self.latencies_s.append(time.monotonic() - time_s)
        return Pose(
            self._num_poses,
            np.array(estimate.rotations),
            np.array(estimate.root_position),
            time_s,
        )
