# SPDX-License-Identifier: GPL-3.0-or-later
"""A take as methods take it: readings of all its sensors at one rate."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from ._core import Readings, ReadingStream, SensorInput, channels_of
from .take import SensorRecord, Take

if TYPE_CHECKING:
    from .capture.sample_log import Samples


__all__ = [
    "ReadingStream",
    "Readings",
    "SensorInput",
    "all_readings",
    "channels_in",
    "measured_channels",
    "push_samples",
]


def channels_in(record: SensorRecord) -> list[str]:
    """Returns what a record tells, of CHANNEL_NAMES.

    A gyroscope that never turned tells nothing; devices without one may send zeros.
    """
    return list(
        channels_of(
            record.specific_force, record.angular_velocity, record.position, record.orientation
        )
    )


def measured_channels(status: Mapping[str, Any]) -> list[str]:
    """Returns what a live sensor measures, by its entry in the capture's status."""
    turns = ["angular_velocity", "gravity_direction"] if status["has_gyroscope"] else []
    orientation = ["orientation"] if status["has_orientation"] else []
    return ["specific_force", *turns, *orientation]


def all_readings(
    take: Take,
    sensors: Sequence[SensorInput],
    rate_hz: float,
    *,
    gravity_average: str = "causal",
    tracker_yaw_rad: float = 0.0,
    tracker_origin_m: Sequence[float] = (0.0, 0.0, 0.0),
) -> Readings:
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
