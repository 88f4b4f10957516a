# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes: what the sensors of one performance read, as the take file keeps it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from . import Motion, simulate
from .table_errors import TakeError
from .take_file import device_comment as device_comment
from .take_file import named_devices, read_columns, write_columns

Floats = NDArray[np.float64]
Path = str | os.PathLike[str]

__all__ = [
    "SensorRecord",
    "Take",
    "TakeError",
    "devices_of",
    "read_take",
    "simulated",
    "write_take",
]


@dataclass(frozen=True)
class SensorRecord:
    """What one sensor read, on its own (clock-corrected) times; all in the sensor's axes."""

    times_s: Floats
    """(T,), ascending."""
    specific_force: Floats
    """(T, 3) m/s^2; +9.81 on the axis that points up while the sensor rests."""
    angular_velocity: Floats | None = None
    """(T, 3) rad/s."""
    orientation: Floats | None = None
    """(T, 4) R_world_sensor, w x y z."""
    position: Floats | None = None
    """(T, 3) m, world."""


@dataclass(frozen=True)
class Take:
    """A recorded performance: a record for each site, in the order of the file."""

    sensors: dict[str, SensorRecord]
    comments: tuple[str, ...] = field(default=(), compare=False)
    """What the file says about itself, without the leading '#'."""

    @property
    def sites(self) -> list[str]:
        """The sensors' sites."""
        return list(self.sensors)

    @property
    def begin_s(self) -> float:
        """When the first sensor starts."""
        return min(float(record.times_s[0]) for record in self.sensors.values())

    @property
    def end_s(self) -> float:
        """When the last sensor ends."""
        return max(float(record.times_s[-1]) for record in self.sensors.values())


def devices_of(take: Take) -> dict[str, str]:
    """Returns the identities of the devices that a take's sensors were, as far as it says."""
    named = named_devices(take.comments)
    return {name: named[name] for name in take.sensors if name in named}


def read_take(path: Path) -> Take:
    """Returns the take in a take file. Raises TakeError, naming the line, and OSError."""
    columns = read_columns(path)
    order = list(dict.fromkeys(columns.sensors.tolist()))
    sensors = {}
    for site in order:
        rows = columns.sensors == site
        sensors[site] = SensorRecord(
            columns.times_s[rows],
            columns.specific_force[rows],
            None if columns.angular_velocity is None else columns.angular_velocity[rows],
            None if columns.orientation is None else columns.orientation[rows],
            None if columns.position is None else columns.position[rows],
        )
    return Take(sensors, columns.comments)


def write_take(path: Path, take: Take) -> None:
    """Writes a take file atomically, samples in the order of their times.

    Gyroscope, orientation and position are written when every sensor has them.
    """
    records = list(take.sensors.values())
    if not records:
        raise ValueError("a take without sensors cannot be written")
    times = np.concatenate([record.times_s for record in records])
    names = np.repeat(take.sites, [len(record.times_s) for record in records])
    order = np.argsort(times, kind="stable")

    def stacked(parts: list[Floats | None]) -> Floats | None:
        present = [part for part in parts if part is not None]
        return np.concatenate(present)[order] if len(present) == len(parts) else None

    write_columns(
        path,
        times[order],
        names[order],
        np.concatenate([record.specific_force for record in records])[order],
        stacked([record.angular_velocity for record in records]),
        stacked([record.orientation for record in records]),
        stacked([record.position for record in records]),
        take.comments,
    )


def simulated(
    motion: Motion,
    sites: Sequence[str],
    rate_hz: float,
    positions_along_bone: Sequence[float] | None = None,
    *,
    with_position: bool = False,
) -> Take:
    """Returns what ideal sensors read on a motion of the standard skeleton; times start at 0.

    positions_along_bone: one a site, from 0 at the bone's pivot to 1, the default, at its end.
    with_position: as tracked sensors also tell where they are.
    """
    read = simulate(motion, sites, rate_hz, positions_along_bone)
    return Take(
        {
            site: SensorRecord(
                read["time_s"],
                read["specific_force"][index],
                read["angular_velocity"][index],
                read["orientation"][index],
                read["position"][index] if with_position else None,
            )
            for index, site in enumerate(sites)
        }
    )
