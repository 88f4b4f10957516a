# SPDX-License-Identifier: GPL-3.0-or-later
"""From samples as they arrive to readings at a database's rate, for live reconstruction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import ClockModel, InclinationFilter, Resampler
from .clocks import evened
from .sample_log import Samples

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Reading:
    """All sensors at one instant."""

    time_s: float
    """On the machine's monotonic clock."""
    values: Floats
    """(C, 3): specific forces, m/s^2, then directions against gravity; NaN rows for silence."""


class LiveReadings:
    """Lays the sensors' clocks under the machine's, filters and resamples, a reading at a time."""

    def __init__(
        self,
        sensors: list[int],
        rate_hz: float,
        has_up: Sequence[bool] = (),
        gyroscope_biases: Floats | None = None,
    ) -> None:
        """Takes the capture's sensors in the order of the readings.

        has_up: whose direction against gravity is read as well, by their gyroscopes, whose biases
        (S, 3) are in rad/s.
        """
        self._sensors = sensors
        self._clocks = [ClockModel() for _ in sensors]
        self._biases = np.zeros((len(sensors), 3)) if gyroscope_biases is None else gyroscope_biases
        places = np.flatnonzero(has_up).tolist()
        self._ups = {
            place: (len(sensors) + i, InclinationFilter()) for i, place in enumerate(places)
        }
        self._resampler = Resampler(len(sensors) + len(places), rate_hz)

    @property
    def delay_s(self) -> float:
        """How long after its time a reading can be had, when no sensor is late."""
        return self._resampler.delay_s

    def add(self, samples: Samples) -> None:
        """Takes samples as the sample log has them."""
        for place, index in enumerate(self._sensors):
            own = samples[samples["sensor"] == index]
            own = own[np.isfinite(own["specific_force"]).all(axis=1)]
            times = self._times(place, own)
            for time_s, force in zip(times, own["specific_force"], strict=True):
                self._resampler.push(place, float(time_s), force)
            self._add_ups(place, times, own)

    def ready(self, now_s: float) -> list[Reading]:
        """The readings that can be had by now; now is on the machine's monotonic clock.

        A sensor that is late is waited for a tenth of a second; then the others go on without it.
        """
        return [Reading(time_s, rows) for time_s, rows in self._resampler.frames_until(now_s)]

    def _add_ups(self, place: int, times: Floats, samples: Samples) -> None:
        if place not in self._ups:
            return
        channel, inclination = self._ups[place]
        rates = samples["angular_velocity"] - self._biases[place]
        for time_s, force, rate in zip(times, samples["specific_force"], rates, strict=True):
            up = inclination.update(float(time_s), force, rate)
            self._resampler.push(channel, float(time_s), up)

    def _times(self, place: int, samples: Samples) -> Floats:
        arrival_s, device_s = samples["arrival_ns"] * 1e-9, samples["device_time_s"]
        if not np.isfinite(device_s).all():
            return evened(arrival_s)
        observe = self._clocks[place].observe
        pairs = zip(device_s, arrival_s, strict=True)
        return np.array([observe(float(device), float(arrival)) for device, arrival in pairs])
