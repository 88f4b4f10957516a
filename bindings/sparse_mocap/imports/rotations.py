# SPDX-License-Identifier: GPL-3.0-or-later
"""From the worlds of devices to the project's."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .. import GRAVITY_MPS2

__all__ = ["from_matrices", "from_z_up", "into_sensor", "with_gravity"]

Floats = NDArray[np.float64]

STANDARD_GRAVITY_MPS2 = 9.80665
"""The unit g of accelerometers."""

_TURN = np.array([0.5, -0.5, -0.5, -0.5])  # x to z, y to x, z to y


def from_z_up(rotation: Floats) -> Floats:
    """Returns R_world_sensor (T, 4), world y up, of rotations into a world with z up."""
    w, x, y, z = np.asarray(rotation, dtype=float).T
    a, b, c, d = _TURN
    turned = [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
    return np.column_stack(turned)


def from_matrices(matrices: Floats) -> Floats:
    """Returns rotations (T, 4), w x y z, of rotation matrices (T, 3, 3)."""
    m = matrices
    traces = np.trace(m, axis1=1, axis2=2)
    diagonal = np.diagonal(m, axis1=1, axis2=2)
    # The outer product of the quaternion with itself, times four; its largest row is the best.
    outer = np.empty((len(m), 4, 4))
    outer[:, 0, 0] = 1 + traces
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        outer[:, i + 1, i + 1] = 1 + 2 * diagonal[:, i] - traces
        outer[:, 0, i + 1] = outer[:, i + 1, 0] = m[:, k, j] - m[:, j, k]
        outer[:, i + 1, j + 1] = outer[:, j + 1, i + 1] = m[:, i, j] + m[:, j, i]
    best = np.argmax(np.diagonal(outer, axis1=1, axis2=2), axis=1)
    rows = outer[np.arange(len(m)), best]
    return np.asarray(rows / np.linalg.norm(rows, axis=1, keepdims=True))


def into_sensor(rotation: Floats, vectors: Floats) -> Floats:
    """Returns world vectors (T, 3) in the axes of sensors whose rotations (T, 4) are given."""
    w, axis = rotation[:, :1], -rotation[:, 1:]
    twice = 2.0 * np.cross(axis, vectors)
    return np.asarray(vectors + w * twice + np.cross(axis, twice))


def with_gravity(rotation: Floats, free_acceleration: Floats) -> Floats:
    """Returns specific force (T, 3) in sensor axes.

    Of rotations (T, 4) into a world with z up and accelerations without gravity in that world.
    """
    return into_sensor(rotation, free_acceleration + np.array([0.0, 0.0, GRAVITY_MPS2]))
