# SPDX-License-Identifier: GPL-3.0-or-later
"""A performer who holds the calibration poses, with trackers that are turned on their limbs.

held_poses.py OUT.csv PLANTED.npz LEAD_S READY_S HOLD_S: writes what six trackers say while each
pose is held for HOLD_S, READY_S after the one before, from LEAD_S on, and how each tracker is
turned, (6, 3, 3) R_site_sensor, and shifted, (6, 3) m.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from sparse_mocap import (
    Body,
    Motion,
    SensorRecord,
    Skeleton,
    Take,
    body_of_height,
    simulated,
    write_take,
)
from sparse_mocap.pose_calibration import calibration_poses
from sparse_mocap.rotations import from_rotation_vectors, interpolated, inverse, product, rotated

Floats = NDArray[np.float64]
Span = tuple[float, float]

SITES = ("left_hand", "right_hand", "left_ankle", "right_ankle", "head", "torso")
RATE_HZ = 100.0


@dataclass(frozen=True)
class Trackers:
    """How trackers are worn: (S, 4) sensor to site, w x y z, and (S, 3) m in the site's axes."""

    R_site_sensor: Floats
    offset_m: Floats

    def matrices(self) -> Floats:
        """(S, 3, 3) R_site_sensor."""
        return np.stack(
            [rotated(np.repeat(q[None], 3, axis=0), np.eye(3)).T for q in self.R_site_sensor]
        )

    def worn(self, ideal: Take) -> Take:
        """What they say where ideal ones say this."""
        return Take(
            {
                site: self._worn(record, index)
                for index, (site, record) in enumerate(ideal.sensors.items())
            }
        )

    def _worn(self, record: SensorRecord, index: int) -> SensorRecord:
        own = self.R_site_sensor[index]
        count = len(record.times_s)
        back = np.repeat(inverse(own)[None], count, axis=0)
        assert record.orientation is not None
        assert record.position is not None
        shift = np.repeat(self.offset_m[index][None], count, axis=0)
        assert record.angular_velocity is not None
        return SensorRecord(
            record.times_s,
            rotated(back, record.specific_force),
            rotated(back, record.angular_velocity),
            product(record.orientation, own),
            record.position + rotated(record.orientation, shift),
        )


def planted(seed: int = 1) -> Trackers:
    """Trackers turned by about 40 degrees, and strapped a few cm off."""
    random = np.random.default_rng(seed)
    turns = from_rotation_vectors(0.4 * random.normal(size=(len(SITES), 3)))
    return Trackers(turns, 0.03 * random.normal(size=(len(SITES), 3)))


def performer() -> Body:
    """Somebody with long thighs and short upper arms."""
    names = list(body_of_height(1.75).skeleton.names)
    bones = body_of_height(1.75).bones.copy()
    for bone, factor in (("femur", 1.08), ("humerus", 0.93)):
        for side in "lr":
            bones[names.index(side + bone)] *= factor
    return Body(bones, "made up")


def spans(lead_s: float, ready_s: float, hold_s: float) -> list[tuple[str, Span]]:
    """When each pose is held."""
    begins = [lead_s + ready_s + i * (ready_s + hold_s) for i in range(len(calibration_poses()))]
    return [
        (name, (begin, begin + hold_s))
        for (name, _, _), begin in zip(calibration_poses(), begins, strict=True)
    ]


def held(
    skeleton: Skeleton, lead_s: float, ready_s: float, hold_s: float, missed_deg: float = 0.0
) -> Motion:
    """From pose to pose, each joint off by missed_deg or so; the pelvis stays where it is."""
    random = np.random.default_rng(2)
    times, poses = [0.0], [np.array(calibration_poses()[0][2])]
    for (_, (begin, end)), (_, _, shown) in zip(
        spans(lead_s, ready_s, hold_s), calibration_poses(), strict=True
    ):
        missed = np.radians(missed_deg) / np.sqrt(3) * random.normal(size=(len(shown), 3))
        missed[0] = 0.0
        rotations = product(np.array(shown), from_rotation_vectors(missed))
        times += [begin, end]
        poses += [rotations, rotations]
    wanted = np.arange(0.0, times[-1] + 2.0, 1.0 / RATE_HZ)
    stacked = np.stack(poses)
    joints = [interpolated(wanted, np.array(times), stacked[:, j]) for j in range(stacked.shape[1])]
    root = np.tile([0.3, 1.0, -0.2], (len(wanted), 1))
    return Motion(skeleton, 1.0 / RATE_HZ, root, np.stack(joints, axis=1))


def ideal(lead_s: float, ready_s: float, hold_s: float, missed_deg: float = 0.0) -> Take:
    """What trackers would say that sit where and as they should while the poses are held."""
    motion = held(performer().skeleton, lead_s, ready_s, hold_s, missed_deg)
    return simulated(motion, SITES, RATE_HZ, with_position=True)


def recorded(lead_s: float, ready_s: float, hold_s: float, missed_deg: float = 0.0) -> Take:
    """What the performer's trackers say meanwhile."""
    return planted().worn(ideal(lead_s, ready_s, hold_s, missed_deg))


if __name__ == "__main__":
    lead, ready, hold = map(float, sys.argv[3:6])
    write_take(Path(sys.argv[1]), recorded(lead, ready, hold))
    np.savez(Path(sys.argv[2]), turns=planted().matrices(), offsets=planted().offset_m)
