# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration of sensors on a whole body that stands, bends its elbows and squats.

The body is the standard skeleton; its simulated sensors are turned, scaled and moved along their
bones by what the calibration has to find.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from sparse_mocap import Motion, SensorRecord, Skeleton, Take, read_motion, simulated, to_standard
from sparse_mocap.calibration import Steps, calibrate

Floats = NDArray[np.float64]

SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
RATE_HZ = 100.0
STEPS = Steps((0.0, 3.0), (("bend_elbows", (4.0, 12.0)), ("squat", (13.0, 21.0))))


def bends(times_s: Floats, begin_s: float, end_s: float) -> Floats:
    """0 to 1 and back every two seconds."""
    inside = (times_s >= begin_s) & (times_s < end_s)
    return np.where(inside, 0.5 * (1 - np.cos(np.pi * (times_s - begin_s))), 0.0)


def turn(axis: Floats, angles: Floats) -> Rotation:
    return Rotation.from_rotvec(np.outer(angles, axis))


def guided(skeleton: Skeleton) -> Motion:
    """Stands with hanging arms and upright legs, bends the elbows forward, squats on the spot."""
    names, bones = skeleton.names, skeleton.bones
    times = np.arange(int(22 * RATE_HZ)) / RATE_HZ
    still = Rotation.identity(len(times))
    R = {name: still for name in names}  # in the world
    x = np.array([1.0, 0.0, 0.0])
    elbow, knee = 1.9 * bends(times, 4, 12), 1.4 * bends(times, 13, 21)
    for side in "lr":
        hang = Rotation.align_vectors(
            [[0, -1, 0], [0, 0, 1]], [bones[names.index(f"{side}humerus")], [0, 0, 1]]
        )[0]
        R[f"{side}humerus"] = still * hang
        R[f"{side}radius"] = R[f"{side}wrist"] = turn(-x, elbow) * hang
        upright = Rotation.align_vectors(
            [[0, -1, 0], [0, 0, 1]], [bones[names.index(f"{side}femur")], [0, 0, 1]]
        )[0]
        R[f"{side}femur"] = turn(-x, 0.5 * knee) * upright
        R[f"{side}tibia"] = turn(x, 0.5 * knee) * upright
    legs = sum(R[f"l{bone}"].apply(bones[names.index(f"l{bone}")]) for bone in ("femur", "tibia"))
    local = [
        R[name] if parent < 0 else R[names[parent]].inv() * R[name]
        for name, parent in zip(names, skeleton.parents, strict=True)
    ]
    rotations = np.stack([r.as_quat()[:, [3, 0, 1, 2]] for r in local], axis=1)
    return Motion(skeleton, 1.0 / RATE_HZ, np.array([0.0, 1.0, 0.0]) - legs + legs[:1], rotations)


def worn(record: SensorRecord, turned: Rotation, scale: float, seed: int) -> SensorRecord:
    noise = np.random.default_rng(seed)
    back = turned.inv()
    force = back.apply(record.specific_force) + 0.05 * noise.normal(size=(len(record.times_s), 3))
    assert record.angular_velocity is not None
    rate = back.apply(record.angular_velocity) + 0.01 * noise.normal(size=force.shape)
    return SensorRecord(record.times_s, force / scale, rate)


@pytest.mark.parametrize("seed", range(4))
def test_sensors_on_a_whole_body_are_calibrated(performance: Path, seed: int) -> None:
    source = np.random.default_rng(seed)
    skeleton = to_standard(read_motion(performance)[0])[0].skeleton
    places = source.uniform(0.3, 0.9, len(SITES))
    ideal = simulated(guided(skeleton), SITES, RATE_HZ, list(places))
    axes = source.normal(size=(len(SITES), 3))
    axes *= (
        np.radians(source.uniform(0, 30, (len(SITES), 1))) / np.linalg.norm(axes, axis=1)[:, None]
    )
    turned = [Rotation.from_rotvec(axis) for axis in axes]
    scales = source.uniform(0.95, 1.05, len(SITES))
    take = Take(
        {
            site: worn(ideal.sensors[site], turned[i], scales[i], 10 * seed + i)
            for i, site in enumerate(SITES)
        }
    )
    found = calibrate(take, STEPS, body=skeleton)
    for i, site in enumerate(SITES):
        sensor = found.sensors[site]
        error = (Rotation.from_matrix(sensor.R_site_sensor) * turned[i].inv()).magnitude()
        assert np.degrees(error) < 5.0, site
        assert sensor.scale == pytest.approx(scales[i], rel=0.01)
        if sensor.is_place_determined:
            assert sensor.place == pytest.approx(places[i], abs=0.1), site
        else:
            assert any("place" in note for note in sensor.notes)
