# SPDX-License-Identifier: GPL-3.0-or-later
"""A take as methods take it: readings of all its sensors at a database's rate.

An accelerometer is one channel, its specific force. A sensor with a gyroscope is another one as
well: the direction against gravity, which the two together tell.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import MotionDatabase, Reconstructor, inclinations
from .take import SensorRecord, Take, evenly, filtered_channel

Floats = NDArray[np.float64]

FORCE, UP = "specific_force", "up"


@dataclass(frozen=True)
class Channels:
    """What the rows of a reading are: all specific forces first."""

    sites: list[str]
    places: list[float] | None
    """Along the sites' bones; None: the sites' own."""
    has_up: list[bool]
    """Whether the site's direction against gravity is read as well."""

    def reconstructor(
        self,
        database: MotionDatabase,
        *,
        method: str = "tautges2011",
        preset: str = "default",
        excluded_clips: Sequence[int] = (),
    ) -> Reconstructor:
        """Returns the method for these channels."""
        also = [index for index, has_up in enumerate(self.has_up) if has_up]
        places = self.places
        return Reconstructor(
            database,
            [*self.sites, *(self.sites[index] for index in also)],
            method=method,
            preset=preset,
            places=None if places is None else [*places, *(places[index] for index in also)],
            quantities=[FORCE] * len(self.sites) + [UP] * len(also),
            excluded_clips=excluded_clips,
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
    times = evenly(take, rate_hz)
    records = list(take.sensors.values())
    has_up = [uses_gyroscopes and has_gyroscope(record) for record in records]
    parts = [filtered_channel(record.times_s, record.specific_force, times) for record in records]
    for record, is_wanted in zip(records, has_up, strict=True):
        if is_wanted:
            up = inclinations(
                record.times_s, record.specific_force, record.angular_velocity, offline=offline
            )
            parts.append(filtered_channel(record.times_s, up, times))
    return Readings(Channels(take.sites, places, has_up), times, np.stack(parts, axis=1))


def has_gyroscope(record: SensorRecord) -> bool:
    """Whether the sensor's gyroscope ever turned; devices without one may send zeros."""
    rate = record.angular_velocity
    return rate is not None and bool((np.isfinite(rate) & (rate != 0.0)).any())
