# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotations, two-bone inverse kinematics and forward kinematics, vectorised over frames.

Rotations are matrices of shape (..., 3, 3) acting on column vectors; angles are radians.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .curves import Array

__all__ = [
    "about",
    "about_x",
    "about_y",
    "about_z",
    "angles_zyx",
    "forward",
    "from_vector",
    "leg_to_ankle",
    "mirrored",
    "transpose",
]


def from_vector(vector: Array) -> Array:
    """Rotation about the direction of ``vector`` (..., 3) by its length."""
    angle = np.linalg.norm(vector, axis=-1)[..., None, None]
    x, y, z = np.moveaxis(vector, -1, 0)
    zero = np.zeros_like(x)
    cross = np.stack(
        [np.stack(row, axis=-1) for row in ((zero, -z, y), (z, zero, -x), (-y, x, zero))], axis=-2
    )
    near = angle < 1e-6
    safe = np.where(near, 1.0, angle)
    first = np.where(near, 1.0, np.sin(safe) / safe)
    second = np.where(near, 0.5, (1.0 - np.cos(safe)) / safe**2)
    return np.asarray(np.eye(3) + first * cross + second * (cross @ cross))


def about(axis: Sequence[float], angle: Array | float) -> Array:
    """Rotation about the unit vector ``axis`` by ``angle`` (...)."""
    return from_vector(np.asarray(angle, dtype=float)[..., None] * np.asarray(axis, dtype=float))


def about_x(angle: Array | float) -> Array:
    """Rotation about x, the axis to the character's left."""
    return about((1.0, 0.0, 0.0), angle)


def about_y(angle: Array | float) -> Array:
    """Rotation about y, up: positive turns the character to its left."""
    return about((0.0, 1.0, 0.0), angle)


def about_z(angle: Array | float) -> Array:
    """Rotation about z, ahead: positive raises the left side."""
    return about((0.0, 0.0, 1.0), angle)


def transpose(rotation: Array) -> Array:
    """Inverse of a rotation."""
    return np.swapaxes(rotation, -1, -2)


def mirrored(rotation: Array) -> Array:
    """The same rotation seen in the mirror plane x = 0."""
    flip = np.diag([-1.0, 1.0, 1.0])
    return flip @ rotation @ flip


def angles_zyx(rotation: Array) -> Array:
    """Angles (n, ..., 3) with ``rotation = Rz Ry Rx``, continuous along the first axis.

    Of the two triples that describe each rotation, the one nearer to the frame before is taken.
    """
    y = np.arctan2(-rotation[..., 2, 0], np.hypot(rotation[..., 0, 0], rotation[..., 1, 0]))
    z = np.arctan2(rotation[..., 1, 0], rotation[..., 0, 0])
    x = np.arctan2(rotation[..., 2, 1], rotation[..., 2, 2])
    first = np.stack([z, y, x], axis=-1)
    second = np.stack([z + np.pi, np.pi - y, x + np.pi], axis=-1)
    result = first.copy()
    full = 2.0 * np.pi
    for n in range(1, len(result)):
        before = result[n - 1]
        one = first[n] - full * np.round((first[n] - before) / full)
        two = second[n] - full * np.round((second[n] - before) / full)
        nearer = np.abs(two - before).sum(axis=-1) < np.abs(one - before).sum(axis=-1) - 1e-9
        result[n] = np.where(nearer[..., None], two, one)
    return result


def leg_to_ankle(
    hip: Array, ankle: Array, left: Array, thigh: float, shank: float
) -> tuple[Array, Array]:
    """Analytic two-bone solution for a leg that hangs along -y at rest and bends about +x.

    ``hip`` and ``ankle`` are world positions (n, 3) in cm, ``left`` the wished direction (n, 3) of
    the knee axis.  Returns the world rotation of the thigh (n, 3, 3) and the knee flexion (n,).
    """
    reach = ankle - hip
    distance = np.linalg.norm(reach, axis=-1)
    up = -reach / distance[:, None]
    axis = left - up * np.einsum("ni,ni->n", left, up)[:, None]
    axis /= np.linalg.norm(axis, axis=-1)[:, None]
    straight = np.stack([axis, up, np.cross(axis, up)], axis=-1)
    bent = (thigh**2 + shank**2 - distance**2) / (2.0 * thigh * shank)
    knee = np.pi - np.arccos(np.clip(bent, -1.0, 1.0))
    lead = np.arctan2(shank * np.sin(knee), thigh + shank * np.cos(knee))
    return straight @ about_x(-lead), knee


def forward(
    parents: Sequence[int], offsets: Array, root: Array, local: Array
) -> tuple[Array, Array]:
    """World positions (n, joints, 3) and rotations (n, joints, 3, 3) of a posed skeleton.

    ``offsets`` (joints, 3) are in the parents' frames in cm, ``root`` (n, 3) is the place of the
    first joint, ``local`` (n, joints, 3, 3) the rotation of each joint in its parent's frame.
    """
    positions = np.empty((*local.shape[:2], 3))
    rotations = np.empty_like(local)
    positions[:, 0], rotations[:, 0] = root, local[:, 0]
    for joint, parent in enumerate(parents[1:], start=1):
        rotations[:, joint] = rotations[:, parent] @ local[:, joint]
        positions[:, joint] = positions[:, parent] + rotations[:, parent] @ offsets[joint]
    return positions, rotations
