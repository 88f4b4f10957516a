# SPDX-License-Identifier: GPL-3.0-or-later
"""From the core's axes (y up, facing +z, metres) to Blender's (z up, facing -y). No Blender here.

The character's left is +x in both.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]

AXES_BLENDER_CORE: Floats = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])


def to_blender(vectors: ArrayLike) -> Floats:
    """(..., 3) positions or directions of the core in Blender's axes."""
    return np.asarray(vectors, dtype=np.float64) @ AXES_BLENDER_CORE.T


def bone_quaternions(rotations: ArrayLike, rest: ArrayLike) -> Floats:
    """(..., 4) rotations of a joint as its pose bone's, w x y z.

    rotations are relative to the parent, with rest frames parallel to the core's world; rest (3, 3)
    is the bone's rest orientation in the armature. A change of axes only turns a quaternion's axis.
    """
    quaternions = np.asarray(rotations, dtype=np.float64)
    axes_bone_core = np.asarray(rest, dtype=np.float64).T @ AXES_BLENDER_CORE
    turned = np.empty_like(quaternions)
    turned[..., 0] = quaternions[..., 0]
    turned[..., 1:] = quaternions[..., 1:] @ axes_bone_core.T
    return turned


def continuous(quaternions: ArrayLike) -> Floats:
    """(T, 4) the same rotations with signs that never jump, so that curves blend well."""
    values = np.array(quaternions, dtype=np.float64)
    if len(values) == 0:
        return values
    jumps = np.einsum("ij,ij->i", values[1:], values[:-1]) < 0.0
    first = -1.0 if values[0, 0] < 0.0 else 1.0
    signs = first * np.cumprod(np.concatenate([[1.0], np.where(jumps, -1.0, 1.0)]))
    return values * signs[:, None]


def rest_pivots_and_ends(
    parents: list[int], offsets: ArrayLike, bones: ArrayLike
) -> tuple[Floats, Floats]:
    """(J, 3) where the joints' bones begin and end in rest pose, the root's pivot at the origin."""
    offsets, bones = np.asarray(offsets, dtype=np.float64), np.asarray(bones, dtype=np.float64)
    pivots, ends = np.zeros_like(offsets), np.zeros_like(offsets)
    for joint, parent in enumerate(parents):
        if parent >= 0:
            pivots[joint] = ends[parent] + offsets[joint]
        ends[joint] = pivots[joint] + bones[joint]
    return pivots, ends
