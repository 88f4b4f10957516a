# SPDX-License-Identifier: GPL-3.0-or-later
"""Armatures' movement, sampled frame by frame, as motions of the core. No Blender here.

In a motion the joints' rest frames are parallel to the world, so a bone's rotation is its turn away
from its rest.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .core import core
from .retarget import quaternions_of

Floats = NDArray[np.float64]

# From Blender's axes (z up, facing -y) to the core's (y up, facing +z).
_R_CORE_BLENDER: Floats = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


@dataclass
class SampledBones:
    """The bones of an armature that hang on one root, parents first, and their poses.

    World of Blender, m. B bones.
    """

    names: list[str]
    parents: list[int]
    """Index of each bone's parent; -1 for the first."""
    rest: Floats
    """(B, 4, 4) the bones' rest in the world."""
    lengths: Floats
    """(B,) in the world."""
    poses: list[Floats] = field(default_factory=list)
    """(B, 4, 4) of each frame."""

    def motion(self, rate_hz: float) -> Any:
        """The sampled poses as a sparse_mocap.Motion of that rate."""
        sparse_mocap = core()
        rest = _turns(self.rest)
        pivots = self.rest[:, :3, 3] @ _R_CORE_BLENDER.T
        tips = self.rest[:, :3, 3] + rest[:, :, 1] * self.lengths[:, None]
        poses = np.array(self.poses)
        # Each bone's turn away from its rest, in the world; then relative to its parent's.
        turned = _turns(poses) @ np.swapaxes(rest, -1, -2)
        turned = _R_CORE_BLENDER @ turned @ _R_CORE_BLENDER.T
        relative = turned.copy()
        for bone, parent in enumerate(self.parents):
            if parent >= 0:
                relative[:, bone] = np.swapaxes(turned[:, parent], -1, -2) @ turned[:, bone]
        skeleton = sparse_mocap.Skeleton(self.names, self.parents, pivots, tips @ _R_CORE_BLENDER.T)
        places = poses[:, 0, :3, 3] @ _R_CORE_BLENDER.T
        return sparse_mocap.Motion(skeleton, 1.0 / rate_hz, places, quaternions_of(relative))


def largest_tree(parents: list[int]) -> list[int]:
    """The bones that hang on the root with the most bones, in their order."""
    roots: list[int] = []
    for bone, parent in enumerate(parents):
        roots.append(bone if parent < 0 else roots[parent])
    best = max(set(roots), key=roots.count)
    return [bone for bone, root in enumerate(roots) if root == best]


def _turns(matrices: Floats) -> Floats:
    """(..., 3, 3) the rotations in (..., 4, 4) matrices that may scale, also unevenly."""
    columns = matrices[..., :3, :3]
    along = columns[..., 1] / np.linalg.norm(columns[..., 1], axis=-1, keepdims=True)
    across = np.cross(columns[..., 0], along)
    across /= np.linalg.norm(across, axis=-1, keepdims=True)
    return np.stack([np.cross(along, across), along, across], -1)
