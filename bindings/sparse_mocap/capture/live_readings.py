# SPDX-License-Identifier: GPL-3.0-or-later
"""From samples as they arrive to readings at a database's rate, for live reconstruction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import ClockModel, Resampler
from .clocks import evened
from .sample_log import Samples

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Reading:
    """All sensors at one instant."""

    time_s: float
    """On the machine's monotonic clock."""
    specific_force: Floats
    """(S, 3) m/s^2; NaN rows for silent sensors."""


class LiveReadings:
    """Lays the sensors' clocks under the machine's, filters and resamples, a reading at a time."""

    def __init__(self, sensors: list[int], rate_hz: float) -> None:
        """Takes the capture's sensors in the order of the readings."""
        self._sensors = sensors
        self._clocks = [ClockModel() for _ in sensors]
        self._resampler = Resampler(len(sensors), rate_hz)

    @property
    def delay_s(self) -> float:
        """How long after its time a reading can be had, when no sensor is late."""
        return self._resampler.delay_s

    def add(self, samples: Samples) -> None:
        """Takes samples as the sample log has them."""
        for place, index in enumerate(self._sensors):
            own = samples[samples["sensor"] == index]
            own = own[np.isfinite(own["specific_force"]).all(axis=1)]
            for time_s, force in zip(self._times(place, own), own["specific_force"], strict=True):
                self._resampler.push(place, float(time_s), force)

    def ready(self, now_s: float) -> list[Reading]:
        """The readings that can be had by now; now is on the machine's monotonic clock.

        A sensor that is late is waited for a tenth of a second; then the others go on without it.
        """
        return [Reading(time_s, force) for time_s, force in self._resampler.frames_until(now_s)]

    def _times(self, place: int, samples: Samples) -> Floats:
        arrival_s, device_s = samples["arrival_ns"] * 1e-9, samples["device_time_s"]
        if not np.isfinite(device_s).all():
            return evened(arrival_s)
        observe = self._clocks[place].observe
        pairs = zip(device_s, arrival_s, strict=True)
        return np.array([observe(float(device), float(arrival)) for device, arrival in pairs])
