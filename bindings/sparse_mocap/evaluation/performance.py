# SPDX-License-Identifier: GPL-3.0-or-later
"""A clip performed for the sensors, and reconstructed as a take would be."""

from __future__ import annotations

import os
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import (
    Motion,
    MotionDatabase,
    noise_presets,
    noisy,
    read_motion,
    simulated,
    to_standard,
)
from ..readings import SensorInput
from ..rotations import product
from ..take import SensorRecord, Take
from .changed_motion import at_tempos, scaled

__all__ = ["Performance", "heading_rotations", "performed"]

Floats = NDArray[np.float64]

PAPER_SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
SENSOR_RATE_HZ = 100.0


@dataclass(frozen=True)
class Performance:
    """What simulated sensors read while someone performs a motion file."""

    motion: Motion
    """On the standard skeleton with the performer's own proportions."""
    take: Take
    """Of sensors that give every channel."""
    tempo_curve_s: tuple[Floats, Floats]
    """Times of the performance, and of the recorded motion then."""

    def seen(self, channels: Mapping[str, Collection[str]]) -> Take:
        """Returns the take of some of its sensors, with these channels of each."""
        return Take({site: _with(self.take.sensors[site], own) for site, own in channels.items()})

    def inputs(self, channels: Sequence[Sequence[str]]) -> list[SensorInput]:
        """Its sensors as a stream of readings takes them, with these channels."""
        return [
            SensorInput(site, list(wanted))
            for site, wanted in zip(self.take.sites, channels, strict=True)
        ]

    def motion_on(self, database: MotionDatabase) -> Motion:
        """The truth: the motion on the database's skeleton and at its rate."""
        return to_standard(self.motion, database.skeleton)[0].resampled(database.rate_hz)

    def clip_times_s(self, count: int, rate_hz: float) -> Floats:
        """When in the recorded motion the performance is, at so many times from its beginning."""
        return np.interp(np.arange(count) / rate_hz, *self.tempo_curve_s)


def performed(
    path: str | os.PathLike[str],
    *,
    sites: Sequence[str] = PAPER_SITES,
    noise: str = "none",
    seed: int = 0,
    rate_hz: float = SENSOR_RATE_HZ,
    body_scale: float = 1.0,
    tempos: Sequence[float] = (1.0,),
) -> Performance:
    """Returns the performance of a motion file.

    body_scale: the performer's size beside the recorded one. tempos: how fast the motion is done,
    from its beginning to its end, linear between. Raises FormatError, MappingError and OSError.
    """
    motion, _ = to_standard(read_motion(path)[0])
    motion, curve_s = at_tempos(scaled(motion, body_scale), tempos)
    ideal = simulated(motion, sites, rate_hz, with_position=True)
    return Performance(motion, noisy(ideal, noise_presets()[noise], seed), curve_s)


def _with(record: SensorRecord, channels: Collection[str]) -> SensorRecord:
    nothing = np.full_like(record.specific_force, np.nan)
    return SensorRecord(
        record.times_s,
        record.specific_force if "specific_force" in channels else nothing,
        record.angular_velocity if "angular_velocity" in channels else None,
        record.orientation if "orientation" in channels else None,
        record.position if "position" in channels else None,
    )


def heading_rotations(motion: Motion) -> Floats:
    """Returns each joint relative to its parent, (T, J, 4) w x y z, the root without heading."""
    names = list(motion.skeleton.names)
    ends = np.asarray(motion.joint_positions("world"))
    left = ends[:, names.index("lhipjoint")] - ends[:, names.index("rhipjoint")]
    half_yaw = 0.5 * np.arctan2(-left[:, 2], left[:, 0])
    zero = np.zeros_like(half_yaw)
    turned_back = np.stack([np.cos(half_yaw), zero, -np.sin(half_yaw), zero], axis=1)
    rotations = np.array(motion.rotations)
    rotations[:, 0] = product(turned_back, rotations[:, 0])
    return rotations
