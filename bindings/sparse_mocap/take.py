# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes: what the sensors of one performance read, as the take file keeps it."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from . import Motion, filtered_at, simulate
from .table_errors import TakeError
from .take_file import read_columns, write_columns

Floats = NDArray[np.float64]
Path = str | os.PathLike[str]

LONGEST_GAP_S = 0.1
"""A sensor that is silent for longer than this has no reading in between."""

__all__ = ["SensorRecord", "Take", "TakeError", "read_take", "resampled", "simulated", "write_take"]


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
        )
    return Take(sensors, columns.comments)


def write_take(path: Path, take: Take) -> None:
    """Writes a take file atomically, samples in the order of their times.

    Gyroscope and orientation are written when every sensor has them.
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
        take.comments,
    )


def resampled(take: Take, rate_hz: float) -> tuple[Floats, Floats]:
    """Returns evenly spaced times (T,) and the specific forces (T, S, 3) there, low-passed.

    This is what a reconstruction takes: the same filter made the database. The times begin with
    the take. Sensors come in the take's order; where one is silent, before its first sample, after
    its last or for longer than LONGEST_GAP_S, its reading is NaN.
    """
    times = evenly(take, rate_hz)
    parts = [filtered_channel(r.times_s, r.specific_force, times) for r in take.sensors.values()]
    return times, np.stack(parts, axis=1)


def evenly(take: Take, rate_hz: float) -> Floats:
    """Returns evenly spaced times (T,) from the take's begin to its end."""
    num_times = int((take.end_s - take.begin_s) * rate_hz + 1e-6) + 1
    return take.begin_s + np.arange(num_times) / rate_hz


def filtered_channel(times_s: Floats, values: Floats, wanted_s: Floats) -> Floats:
    """Returns samples (T, 3) through the database's low-pass at other times; NaN in silences.

    Samples that are not finite are none.
    """
    known = np.isfinite(values).all(axis=1)
    if not known.any():
        return np.full((len(wanted_s), 3), np.nan)
    read = np.array(filtered_at(times_s[known], values[known], wanted_s))
    read[_is_silent(times_s[known], wanted_s)] = np.nan
    return read


def simulated(
    motion: Motion,
    sites: Sequence[str],
    rate_hz: float,
    places: Sequence[float] | None = None,
) -> Take:
    """Returns what ideal sensors read on a motion of the standard skeleton; times start at 0."""
    read = simulate(motion, sites, rate_hz, places)
    return Take(
        {
            site: SensorRecord(
                read["time_s"],
                read["specific_force"][index],
                read["angular_velocity"][index],
                read["orientation"][index],
            )
            for index, site in enumerate(sites)
        }
    )


def _is_silent(times_s: Floats, wanted_s: Floats) -> NDArray[np.bool_]:
    """Returns, for each time wanted, whether it lies in a gap of the sensor's samples."""
    slack = 1e-6
    edges = np.concatenate([[-np.inf], times_s, [np.inf]])
    after = np.searchsorted(times_s, wanted_s, side="left") + 1
    before_s, after_s = edges[after - 1], edges[after]
    is_between = (wanted_s - before_s > slack) & (after_s - wanted_s > slack)
    # A sensor that starts or ends a moment apart from the others is not silent for that moment.
    gap_s = np.where(
        np.isinf(before_s) | np.isinf(after_s),
        np.minimum(wanted_s - before_s, after_s - wanted_s),
        after_s - before_s,
    )
    return np.asarray(is_between & (gap_s > LONGEST_GAP_S + slack))
