# SPDX-License-Identifier: GPL-3.0-or-later
"""A take as methods take it: readings of all its sensors at one rate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from . import MotionDatabase, ReadingStream, Reconstructor, SensorInput, channels_of
from . import _core as core
from .take import SensorRecord, Take

if TYPE_CHECKING:
    from .capture.sample_log import Samples

Floats = NDArray[np.float64]


def channels_in(record: SensorRecord) -> list[str]:
    """Returns what a record tells, of CHANNEL_NAMES.

    A gyroscope that never turned tells nothing; devices without one may send zeros.
    """
    return list(
        channels_of(
            record.specific_force, record.angular_velocity, record.position, record.orientation
        )
    )


def all_readings(
    take: Take,
    sensors: Sequence[SensorInput],
    rate_hz: float,
    *,
    gravity_average: str = "causal",
    tracker_yaw_rad: float = 0.0,
    tracker_origin_m: Sequence[float] = (0.0, 0.0, 0.0),
) -> core.Readings:
    """Returns the readings of a whole take; sensors are in its order.

    gravity_average and tracker_* are as ReadingStream has them.
    """
    stream = ReadingStream(
        sensors,
        rate_hz,
        gravity_average=gravity_average,
        tracker_yaw_rad=tracker_yaw_rad,
        tracker_origin_m=tracker_origin_m,
    )
    for index, record in enumerate(take.sensors.values()):
        stream.push(
            index,
            record.times_s,
            record.specific_force,
            record.angular_velocity,
            record.position,
            record.orientation,
        )
    return stream.flush()


def push_samples(stream: ReadingStream, sensors: Sequence[int], samples: Samples) -> None:
    """Gives a stream what has arrived, as the sample log has it.

    sensors: the capture's numbers of the stream's sensors, in its order.
    """
    for index, number in enumerate(sensors):
        own = samples[samples["sensor"] == number]
        if not len(own):
            continue
        stream.push_arrivals(
            index,
            own["arrival_ns"] * 1e-9,
            own["device_time_s"],
            own["specific_force"],
            own["angular_velocity"],
            orientation=own["orientation"],
        )


# What follows gives a method that takes specific forces and directions of gravity as rows of one
# array its rows.


@dataclass(frozen=True)
class Channels:
    """What the rows of a reading are: all specific forces first."""

    sites: list[str]
    places: list[float] | None
    """Positions along the bones; None: at their ends."""
    has_up: list[bool]
    """Whether the sensor's direction of gravity is read as well."""

    def reconstructor(
        self,
        database: MotionDatabase,
        *,
        method: str = "tautges2011",
        preset: str = "default",
        excluded_clips: Sequence[int] = (),
    ) -> Reconstructor:
        """Returns the method for these channels."""
        also = np.flatnonzero(self.has_up).tolist()
        places = self.places
        return Reconstructor(
            database,
            [*self.sites, *(self.sites[index] for index in also)],
            method=method,
            preset=preset,
            places=None if places is None else [*places, *(places[index] for index in also)],
            quantities=["specific_force"] * len(self.sites) + ["up"] * len(also),
            excluded_clips=excluded_clips,
        )

    def inputs(self, gyroscope_biases: Floats | None = None) -> list[SensorInput]:
        """Returns the sensors as a stream takes them."""
        channels = [["specific_force"] + ["gravity_direction"] * has_up for has_up in self.has_up]
        biases = np.zeros((len(channels), 3)) if gyroscope_biases is None else gyroscope_biases
        return [
            SensorInput(site, wanted, gyroscope_bias=bias)
            for site, wanted, bias in zip(self.sites, channels, biases, strict=True)
        ]

    def rows(self, read: core.Readings) -> Floats:
        """Returns (T, C, 3): m/s^2, and unit vectors against gravity; NaN in silences."""
        return np.concatenate(
            [read.specific_force, read.gravity_direction[:, np.flatnonzero(self.has_up)]], axis=1
        )


@dataclass(frozen=True)
class Readings:
    """A take at a database's rate. T times, S sensors, C channels."""

    channels: Channels
    times_s: Floats
    """(T,)"""
    values: Floats
    """(T, C, 3) m/s^2 and unit vectors; NaN where a sensor is silent."""

    @property
    def specific_force(self) -> Floats:
        """(T, S, 3) m/s^2."""
        return self.values[:, : len(self.channels.sites)]


def readings_of(
    take: Take,
    rate_hz: float,
    *,
    places: list[float] | None = None,
    offline: bool = False,
    uses_gyroscopes: bool = True,
) -> Readings:
    """Returns a take's readings, through the database's low-pass.

    offline: directions may look at the whole take. uses_gyroscopes: where there are some.
    """
    has_up = [
        uses_gyroscopes and "gravity_direction" in channels_in(record)
        for record in take.sensors.values()
    ]
    channels = Channels(take.sites, places, has_up)
    average = "whole_take" if offline else "causal"
    read = all_readings(take, channels.inputs(), rate_hz, gravity_average=average)
    return Readings(channels, read.times_s, channels.rows(read))


@dataclass(frozen=True)
class LiveReading:
    """All sensors at one instant."""

    time_s: float
    """On the machine's monotonic clock."""
    values: Floats
    """(C, 3) as Channels.rows has them, in the sensors' own axes."""


@dataclass
class LiveReadings:
    """A capture's sensors as they come, a reading at a time."""

    sensors: list[int]
    rate_hz: float
    has_up: Sequence[bool] = ()
    gyroscope_biases: Floats | None = None
    _channels: Channels = field(init=False)
    _stream: ReadingStream = field(init=False)

    def __post_init__(self) -> None:
        has_up = [*map(bool, self.has_up)] or [False] * len(self.sensors)
        # Where a sensor is worn does not change what it read.
        self._channels = Channels(["pelvis"] * len(self.sensors), None, has_up)
        self._stream = ReadingStream(self._channels.inputs(self.gyroscope_biases), self.rate_hz)

    @property
    def delay_s(self) -> float:
        """How long after its time a reading can be had, when no sensor is late."""
        return self._stream.delay_s

    def add(self, samples: Samples) -> None:
        """Takes samples as the sample log has them."""
        push_samples(self._stream, self.sensors, samples)

    def ready(self, now_s: float) -> list[LiveReading]:
        """The readings that can be had by now; now is on the machine's monotonic clock.

        A sensor that is late is waited for a tenth of a second; then the others go on without it.
        """
        read = self._stream.ready(now_s)
        pairs = zip(read.times_s, self._channels.rows(read), strict=True)
        return [LiveReading(float(time_s), values) for time_s, values in pairs]
