# SPDX-License-Identifier: GPL-3.0-or-later
"""From samples as they arrive to readings at a database's rate, for live reconstruction."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .. import FILTER_REACH_S, filtered_at
from ..take import LONGEST_GAP_S
from .clocks import evened
from .sample_log import Samples

Floats = NDArray[np.float64]

LONGEST_WAIT_S = 0.1
"""A reading waits no longer than this for a sensor that is late; it then does without."""
_KEPT_S = 1.0
_CLOCK_WINDOW_S = 20.0


@dataclass(frozen=True)
class Reading:
    """All sensors at one instant."""

    time_s: float
    """On the machine's monotonic clock."""
    specific_force: Floats
    """(S, 3) m/s^2; NaN rows for silent sensors."""


@dataclass
class LiveReadings:
    """Lays the sensors' clocks under the machine's, filters and resamples, a reading at a time."""

    sensors: list[int]
    """The capture's sensors in the order of the readings."""
    rate_hz: float
    _next_s: float | None = None

    def __post_init__(self) -> None:
        self._sensors = [_Sensor() for _ in self.sensors]

    def add(self, samples: Samples) -> None:
        """Takes samples as the sample log has them."""
        for index, sensor in zip(self.sensors, self._sensors, strict=True):
            own = samples[samples["sensor"] == index]
            own = own[np.isfinite(own["specific_force"]).all(axis=1)]
            if len(own):
                sensor.add(own)

    def ready(self, now_s: float) -> list[Reading]:
        """The readings that can be had by now; now is on the machine's monotonic clock."""
        if self._next_s is None:
            if any(sensor.num_samples == 0 for sensor in self._sensors):
                return []
            self._next_s = max(sensor.times_s[0] for sensor in self._sensors)
        readings = []
        while self._is_ready(self._next_s, now_s):
            force = np.array([sensor.at(self._next_s) for sensor in self._sensors])
            readings.append(Reading(self._next_s, force))
            self._next_s += 1.0 / self.rate_hz
        return readings

    def _is_ready(self, time_s: float, now_s: float) -> bool:
        wanted_s = time_s + FILTER_REACH_S
        if now_s >= wanted_s + LONGEST_WAIT_S:
            return True
        return all(sensor.newest_s >= wanted_s for sensor in self._sensors)


@dataclass
class _Sensor:
    """The last samples of a sensor, on the machine's clock."""

    times_s: Floats = field(default_factory=lambda: np.empty(0))
    forces: Floats = field(default_factory=lambda: np.empty((0, 3)))
    num_samples: int = 0
    _delays: deque[tuple[float, float]] = field(default_factory=deque)

    @property
    def newest_s(self) -> float:
        return float(self.times_s[-1]) if len(self.times_s) else -np.inf

    def add(self, samples: Samples) -> None:
        times = self._host_times(samples)
        times = np.maximum.accumulate(np.maximum(times, self.newest_s + 1e-6))
        times += np.arange(len(times)) * 1e-9
        self.times_s = np.concatenate([self.times_s, times])
        self.forces = np.concatenate([self.forces, samples["specific_force"].astype(np.float64)])
        keep = self.times_s >= times[-1] - _KEPT_S
        self.times_s, self.forces = self.times_s[keep], self.forces[keep]
        self.num_samples += len(times)

    def at(self, time_s: float) -> Floats:
        after = int(np.searchsorted(self.times_s, time_s))
        near = self.times_s[max(after - 1, 0) : after + 1]
        if not len(near) or np.min(np.abs(near - time_s)) > LONGEST_GAP_S:
            return np.full(3, np.nan)
        return np.asarray(filtered_at(self.times_s, self.forces, [time_s])[0])

    def _host_times(self, samples: Samples) -> Floats:
        arrival_s, device_s = samples["arrival_ns"] * 1e-9, samples["device_time_s"]
        if not np.isfinite(device_s).all():
            return evened(arrival_s)
        delay = arrival_s - device_s
        least = int(np.argmin(delay))
        # A clock that jumped, by a reset or another connection, is learnt anew.
        if self._delays and abs(delay[least] - self._delays[0][1]) > 1.0:
            self._delays.clear()
        while self._delays and self._delays[-1][1] >= delay[least]:
            self._delays.pop()
        self._delays.append((float(arrival_s[least]), float(delay[least])))
        while self._delays[0][0] < arrival_s[-1] - _CLOCK_WINDOW_S:
            self._delays.popleft()
        return np.asarray(device_s + self._delays[0][1])
