# SPDX-License-Identifier: GPL-3.0-or-later
"""What sensors read on a generated motion, worked out without the core: splines and Newton."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation, RotationSpline
from sparse_mocap import SensorRecord, Take
from sparse_mocap.demo_motions.body import INDEX, PARENTS, Body
from sparse_mocap.demo_motions.curves import FRAME_RATE
from sparse_mocap.demo_motions.kinematics import forward
from sparse_mocap.demo_motions.solve import Pose

Floats = NDArray[np.float64]

SENSOR_RATE_HZ = 100.0
UP = np.array([0.0, 1.0, 0.0])
GRAVITY_MPS2 = 9.80665

# In rest pose, a T with palms down that faces +z, left being +x: x along the limb away from the
# body, z up at the wrists and forward at the ankles.
LEFT, AHEAD = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
WORN = {  # where it is, what it turns with, its x and z axis in rest pose
    "left_wrist": ("LeftHand", "LeftHand", LEFT, UP),
    "right_wrist": ("RightHand", "RightHand", -LEFT, UP),
    "left_ankle": ("LeftFoot", "LeftLeg", -UP, AHEAD),
    "right_ankle": ("RightFoot", "RightLeg", -UP, AHEAD),
}


def worn(body: Body, pose: Pose, seed: int) -> Take:
    """What four noisy sensors with gyroscopes, strapped a little askew, read."""
    positions_cm, rotations = forward(PARENTS, body.offsets(), pose.root, pose.local)
    times_s = np.arange(len(pose.root)) / FRAME_RATE
    rng = np.random.default_rng(seed)
    sensors = {}
    for site, (place, carrier, x, z) in WORN.items():
        R_joint_sensor = np.stack([x, np.cross(z, x), z], axis=1)
        R_world_sensor = rotations[:, INDEX[carrier]] @ R_joint_sensor
        path_m = positions_cm[:, INDEX[place]] / 100.0
        sensors[site] = _record(times_s, path_m, R_world_sensor, rng)
    return Take(sensors)


def _record(
    times_s: Floats, path_m: Floats, R_world_sensor: Floats, rng: np.random.Generator
) -> SensorRecord:
    askew = Rotation.from_rotvec(np.radians(2.0) * rng.normal(size=3))
    path = CubicSpline(times_s, path_m)
    turning = RotationSpline(times_s, Rotation.from_matrix(R_world_sensor) * askew)
    at_s = np.arange(0.0, times_s[-1], 1.0 / SENSOR_RATE_HZ)
    force = turning(at_s).inv().apply(path(at_s, 2) + GRAVITY_MPS2 * UP)
    rate = turning(at_s, 1)
    return SensorRecord(
        at_s,
        force * (1.0 + 0.005 * rng.normal(size=3)) + _noise(rng, force, 0.08, 0.15),
        rate + _noise(rng, rate, 0.01, 0.01),
    )


def _noise(rng: np.random.Generator, values: Floats, bias: float, white: float) -> Floats:
    return bias * rng.normal(size=3) + white * rng.normal(size=values.shape)
