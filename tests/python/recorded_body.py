# SPDX-License-Identifier: GPL-3.0-or-later
"""A recorded performance of sixteen sensors: how its limbs point, and how those of a motion do."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from scipy.io import loadmat
from scipy.spatial.transform import Rotation
from sparse_mocap import Motion

LIMBS = {
    "upper_arm_left": ("lclavicle", "lhumerus"),
    "forearm_left": ("lhumerus", "lradius"),
    "upper_arm_right": ("rclavicle", "rhumerus"),
    "forearm_right": ("rhumerus", "rradius"),
    "upper_leg_left": ("lhipjoint", "lfemur"),
    "lower_leg_left": ("lfemur", "ltibia"),
    "upper_leg_right": ("rhipjoint", "rfemur"),
    "lower_leg_right": ("rfemur", "rtibia"),
}
TRUNK = "upper_back"
SCORED = (55.0, 100.0)
"""Steady locomotion, s."""


def recorded_sensors(real_data: Path) -> Any:
    """Returns the recording: times, and of each segment acc, gyr and quat."""
    path = real_data / "imu" / "qmt_full_body" / "full_body_example_data.mat"
    return loadmat(path, squeeze_me=True, struct_as_record=False)


def turns(recorded: Any, name: str) -> Rotation:
    """Returns a segment's orientations in a world whose z is up."""
    return Rotation.from_quat(recorded[name].quat[:, [1, 2, 3, 0]])


def reference(recorded: Any) -> np.ndarray:
    """Returns (T, 9, 3), limbs and trunk in the heading frame; segments have y up the limb."""
    right = turns(recorded, "hip").apply([0, 0, 1]) * [1, 1, 0]
    left = -right / np.linalg.norm(right, axis=1, keepdims=True)
    axes = np.stack([left, np.tile([0, 0, 1.0], (len(left), 1)), np.cross(left, [0, 0, 1])], 1)
    limbs = [turns(recorded, name).apply([0, -1, 0]) for name in LIMBS]
    limbs.append(turns(recorded, TRUNK).apply([0, 1, 0]))
    return np.einsum("tij,ltj->tli", axes, np.array(limbs))


def directions(motion: Motion) -> np.ndarray:
    """Returns the same of a motion."""
    positions, names = motion.joint_positions("heading"), motion.skeleton.names
    ends = [*LIMBS.values(), ("root", "thorax")]
    limbs = [positions[:, names.index(b)] - positions[:, names.index(a)] for a, b in ends]
    return np.stack([v / np.linalg.norm(v, axis=1, keepdims=True) for v in limbs], 1)


def angles_deg(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Returns the angles between unit vectors."""
    return np.degrees(np.arccos(np.clip((a * b).sum(axis=-1), -1, 1)))


def exceeds_human_limits(motion: Motion) -> list[str]:
    """Returns joints that turn over 56 degrees within a frame or bend as no knee or elbow does."""
    names = list(motion.skeleton.names)
    quaternions = np.asarray(motion.rotations)
    found = []
    for joint, name in enumerate(names):
        turned = Rotation.from_quat(quaternions[:, joint][:, [1, 2, 3, 0]])
        if np.degrees((turned[:-1].inv() * turned[1:]).magnitude()).max() > 56.1:
            found.append(f"{name} turns too fast")
        if name[1:] not in ("tibia", "radius"):
            continue
        vectors = np.degrees(turned.as_rotvec())
        farthest = vectors[np.argmax(np.linalg.norm(vectors, axis=1))]
        bend = vectors @ farthest / np.linalg.norm(farthest)
        if bend.min() < -10.1 or bend.max() > 170.1:
            found.append(f"{name} bends from {bend.min():.0f} to {bend.max():.0f} degrees")
    return found
