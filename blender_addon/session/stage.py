# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the live figure stands and which way it faces, as the animator wants it. No Blender."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .live_poses import Pose

Floats = NDArray[np.float64]


class Stage:
    """Moves and turns live poses about the vertical. In the core's axes: y is up, z the front."""

    def __init__(self) -> None:
        self._origin_m: Floats = np.zeros(2)  # x and z
        self._yaw_rad = 0.0
        self._last: Pose | None = None  # as it came

    def shown(self, pose: Pose, *, in_place: bool) -> Pose:
        """The pose as it is shown; in_place: always at the origin."""
        self._last = pose
        x, height, z = pose.root_position
        moved = np.array([x, z]) - self._origin_m
        if in_place:
            moved = np.zeros(2)
        cos, sin = np.cos(self._yaw_rad), np.sin(self._yaw_rad)
        position = np.array(
            [cos * moved[0] - sin * moved[1], height, sin * moved[0] + cos * moved[1]]
        )
        rotations = pose.rotations.copy()
        rotations[0] = _turned(rotations[0], -self._yaw_rad)
        return replace(pose, root_position=position, rotations=rotations)

    def recentre(self) -> None:
        """Let the figure stand at the origin now."""
        if self._last is not None:
            self._origin_m = self._last.root_position[[0, 2]].copy()

    def face_front(self) -> None:
        """Let the figure face the front now."""
        if self._last is not None:
            w, x, y, z = self._last.rotations[0]
            self._yaw_rad = float(np.arctan2(2.0 * (x * z + w * y), 1.0 - 2.0 * (x * x + y * y)))
            self.recentre()


def _turned(quaternion: Floats, yaw_rad: float) -> Floats:
    """The rotation (w x y z), then turned about the vertical."""
    w, x, y, z = quaternion
    cos, sin = np.cos(0.5 * yaw_rad), np.sin(0.5 * yaw_rad)
    return np.array([cos * w - sin * y, cos * x + sin * z, cos * y + sin * w, cos * z - sin * x])
