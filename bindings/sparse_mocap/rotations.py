# SPDX-License-Identifier: GPL-3.0-or-later
"""Rotations as unit quaternions (T, 4), w x y z."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._core import R_WORLD_ZUP, rotated, rotation_product, rotations_from_matrices

Floats = NDArray[np.float64]

__all__ = [
    "about_axis",
    "from_rotation_vectors",
    "from_z_up",
    "interpolated",
    "inverse",
    "normalised",
    "product",
    "rotated",
    "rotations_from_matrices",
]


def product(left: ArrayLike, right: ArrayLike) -> Floats:
    """Returns left times right (T, 4); either may be one rotation (4,)."""
    pair = np.broadcast_arrays(np.atleast_2d(left), np.atleast_2d(right))
    return np.asarray(rotation_product(*pair))


def inverse(rotations: Floats) -> Floats:
    """Returns the rotations the other way round."""
    return rotations * [1.0, -1.0, -1.0, -1.0]


def about_axis(axis: ArrayLike, angle_rad: float) -> Floats:
    """Returns the rotation (4,) about a unit vector."""
    return np.concatenate([[np.cos(angle_rad / 2)], np.sin(angle_rad / 2) * np.asarray(axis)])


def from_rotation_vectors(vectors_rad: Floats) -> Floats:
    """Returns the rotations (T, 4) by rotation vectors (T, 3)."""
    half = 0.5 * np.linalg.norm(vectors_rad, axis=1, keepdims=True)
    return np.concatenate([np.cos(half), 0.5 * np.sinc(half / np.pi) * vectors_rad], axis=1)


def from_z_up(rotations: ArrayLike) -> Floats:
    """Returns R_world_sensor (T, 4), world y up, of rotations into a world with z up."""
    return product(R_WORLD_ZUP, rotations)


def normalised(rotations: Floats) -> Floats:
    """Returns the quaternions with length 1."""
    return np.asarray(rotations / np.linalg.norm(rotations, axis=1, keepdims=True))


def interpolated(wanted_s: Floats, times_s: Floats, rotations: Floats) -> Floats:
    """Returns rotations at other times, held beyond the ends."""
    flips = np.sum(rotations[1:] * rotations[:-1], axis=1) < 0
    signs = np.cumprod(np.concatenate([[1.0], np.where(flips, -1.0, 1.0)]))
    columns = (rotations * signs[:, None]).T
    return normalised(np.column_stack([np.interp(wanted_s, times_s, part) for part in columns]))
