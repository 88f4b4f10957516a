# SPDX-License-Identifier: GPL-3.0-or-later
"""From control curves to joint rotations: the pose of the whole skeleton in every frame."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, radians, sqrt

import numpy as np

from .body import INDEX, JOINTS, Body
from .controls import ARM, FACING, FOOT, HEAD, PLACE, SPINE, TILT
from .curves import Array, smooth_cover
from .kinematics import (
    about,
    about_x,
    about_y,
    about_z,
    from_vector,
    leg_to_ankle,
    mirrored,
    transpose,
)

__all__ = ["Pose", "solve"]

ELBOW = (0.0, -sqrt(0.75), 0.5)
"""Axis of the left elbow in the rest frame; the right one is its mirror image."""

STRETCH = 0.993
"""Longest leg in use as a share of the straight leg: the knee is never locked."""

_GIVE = 0.12
"""Seconds before and after within which the pelvis gives way to a leg that is too short."""


@dataclass(frozen=True)
class Pose:
    """A posed motion: root position (n, 3) in cm and local rotations (n, joints, 3, 3)."""

    root: Array
    local: Array


def solve(body: Body, motion: Array) -> Pose:
    """Pose the skeleton of ``body`` by the control curves ``motion`` (n, WIDTH)."""
    local = np.tile(np.eye(3), (len(motion), len(JOINTS), 1, 1))
    tilt = motion[:, TILT]
    level = np.stack([tilt[:, 0], np.zeros(len(tilt)), tilt[:, 2]], axis=1)
    pelvis = about_y(motion[:, FACING] + tilt[:, 1]) @ from_vector(level)
    local[:, INDEX["Hips"]] = pelvis
    _bend_trunk(local, motion)
    for side in ("Left", "Right"):
        _place_arm(local, motion, side)
    root = _reachable(body, motion, pelvis)
    for side in ("Left", "Right"):
        _place_leg(local, body, motion, side, root)
    return Pose(root, local)


def _bend_trunk(local: Array, motion: Array) -> None:
    spine, head = motion[:, SPINE], motion[:, HEAD]
    for names, bend in (
        (("LowerBack", "Spine", "Spine1"), spine),
        (("Neck", "Neck1", "Head"), head),
    ):
        part = from_vector(bend / 3.0)
        for name in names:
            local[:, INDEX[name]] = part


def _place_arm(local: Array, motion: Array, side: str) -> None:
    raised, aside, inward, elbow, twist = motion[:, ARM[side.lower()]].T
    arm = about_x(-raised) @ about_z(aside - 0.5 * pi) @ about_x(inward)
    height, reach = 0.5 * (1.0 + arm[:, 1, 0]), arm[:, 2, 0]
    shrug = radians(22) * height**2 * (3.0 - 2.0 * height)
    clavicle = about_z(shrug) @ about_y(-radians(9) * reach)
    parts = {
        "Shoulder": clavicle,
        "Arm": transpose(clavicle) @ arm,
        "ForeArm": about(ELBOW, elbow),
        "Hand": about_x(twist),
    }
    for name, rotation in parts.items():
        local[:, INDEX[side + name]] = rotation if side == "Left" else mirrored(rotation)


def _hip(body: Body, pelvis: Array, side: str) -> Array:
    """Hip joint relative to the root in the world, (n, 3)."""
    sign = 1.0 if side == "Left" else -1.0
    return np.asarray(pelvis @ (body.hip * np.array([sign, 1.0, 1.0])))


def _reachable(body: Body, motion: Array, pelvis: Array) -> Array:
    """Root position, lowered smoothly where a leg would not reach its ankle."""
    root = motion[:, PLACE].copy()
    lack = np.zeros(len(root))
    longest = STRETCH * body.leg
    for side in ("Left", "Right"):
        hip, ankle = _hip(body, pelvis, side), motion[:, FOOT[side.lower()]][:, :3]
        apart = ((root + hip - ankle)[:, [0, 2]] ** 2).sum(axis=1)
        room = np.sqrt(np.maximum(longest**2 - apart, (0.1 * longest) ** 2))
        lack = np.maximum(lack, root[:, 1] + hip[:, 1] - ankle[:, 1] - room)
    root[:, 1] -= smooth_cover(lack, _GIVE)
    return root


def _place_leg(local: Array, body: Body, motion: Array, side: str, root: Array) -> None:
    foot = motion[:, FOOT[side.lower()]]
    sign = 1.0 if side == "Left" else -1.0
    pelvis = local[:, INDEX["Hips"]]
    knee_heading = (
        0.5 * (motion[:, FACING] + motion[:, TILT][:, 1] + foot[:, 3]) + sign * foot[:, 5]
    )
    left = about_y(knee_heading)[:, :, 0]
    thigh, knee = leg_to_ankle(
        root + _hip(body, pelvis, side), foot[:, :3], left, body.thigh, body.shank
    )
    shank = thigh @ about_x(knee)
    sole = about_y(foot[:, 3]) @ about_x(foot[:, 4])
    local[:, INDEX[f"{side}UpLeg"]] = transpose(pelvis) @ thigh
    local[:, INDEX[f"{side}Leg"]] = about_x(knee)
    local[:, INDEX[f"{side}Foot"]] = transpose(shank) @ sole
