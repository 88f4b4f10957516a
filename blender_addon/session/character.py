# SPDX-License-Identifier: GPL-3.0-or-later
"""A character's rig as the core sees it: its rest pose, its mapping, and motions on it. No Blender.

All vectors are in the core's axes and metres, in the character's own space: upright, at its origin.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .core import core
from .errors import InputError, one_line

Floats = NDArray[np.float64]

_PELVIS, _THIGHS = "root", ("lfemur", "rfemur")
_HIGHEST_ANKLE = 0.15  # relative to the height of the hips
_STANDING = 0.05  # of the frames: those in which an ankle is lowest show where the floor is


@dataclass(frozen=True)
class RestBone:
    """A bone at rest."""

    name: str
    parent: int
    """Index of its parent in the list, smaller than its own; -1 without one."""
    head: Floats  # (3,)
    tail: Floats  # (3,)


@dataclass(frozen=True)
class RigMotion:
    """A motion on a character. T frames, n turned bones."""

    frame_time_s: float
    rotations: Floats  # (T, n, 3, 3) from rest to pose, in the character's space
    hips: Floats  # (T, 3) the middle between the thighs' heads
    above_floor_m: Floats
    """(T,) how high the lower ankle is above where it is when that foot stands on the floor."""

    @property
    def num_frames(self) -> int:
        """Number of frames."""
        return len(self.hips)

    def lifted(self, lift_m: float) -> RigMotion:
        """The motion higher up."""
        up = np.array([0.0, lift_m, 0.0])
        return replace(self, hips=self.hips + up, above_floor_m=self.above_floor_m + lift_m)


class Character:
    """A rig that is mapped to the standard skeleton."""

    def __init__(self, name: str, bones: list[RestBone], by_hand: dict[str, str] | None = None):
        """by_hand: the bone for some standard joints; None: the remembered mapping, else detected.

        Raises InputError when the bones are not a person's.
        """
        self.name = name
        still = still_motion(bones)
        self.skeleton = still.skeleton
        try:
            found, _ = core().mappings.find_mapping(still, by_hand)
        except ValueError as error:
            raise InputError(f'"{name}": {one_line(error)}') from error
        self.joints: dict[str, str] = dict(found.joints)
        """The bone of each standard joint that has one."""
        self.warnings: list[str] = list(found.warnings)
        body = _body(bones, [*found.joints.values(), *found.turned_joints])
        still = still_motion(body)
        self._skeleton = still.skeleton
        self._mapping = core().map_skeleton(still, self.joints)
        self.turned: list[str] = list(self._mapping.turned_joints)
        """The bones that a motion turns."""
        names = [bone.name for bone in body]
        self._parents = [bone.parent for bone in body]
        self._turned = [names.index(name) for name in self.turned]
        self._pivots = np.array([bone.head for bone in body])
        self._thighs = [names.index(self.joints[joint]) for joint in _THIGHS]
        self._feet = [names.index(name) for name in self._mapping.ankles if name]
        self._needed = _with_parents([*self._turned, *self._feet], self._parents)
        self._ankle_m = _ankle_height(body, self._feet)

    @property
    def top(self) -> str:
        """The bone on which all others of the body hang."""
        return str(self._skeleton.names[0])

    @property
    def pelvis(self) -> str:
        """The bone of the pelvis."""
        return self.joints[_PELVIS]

    def lift_m(self, above_floor_m: Floats) -> float:
        """How much higher a whole take has to be for the feet to stand on the floor."""
        return -float(np.quantile(above_floor_m, _STANDING))

    def motion(self, motion: Any) -> RigMotion:
        """A motion on the standard skeleton (sparse_mocap.Motion) on this character."""
        moved = self._mapping.to_rig(motion)
        local = _matrices(moved.rotations)
        world: dict[int, Floats] = {}
        positions: dict[int, Floats] = {0: np.asarray(moved.root_positions)}
        for joint in self._needed:
            parent = self._parents[joint]
            world[joint] = local[:, joint] if parent < 0 else world[parent] @ local[:, joint]
            if parent >= 0:
                offset = self._pivots[joint] - self._pivots[parent]
                positions[joint] = positions[parent] + world[parent] @ offset
        hips = np.mean([positions[thigh] for thigh in self._thighs], axis=0)
        rotations = np.stack([world[joint] for joint in self._turned], axis=1)
        ankles = [positions[foot][:, 1] for foot in self._feet]
        lowest = np.min(ankles, axis=0) if ankles else np.full(len(hips), self._ankle_m)
        return RigMotion(moved.frame_time_s, rotations, hips, lowest - self._ankle_m)


def still_motion(bones: list[RestBone]) -> Any:
    """The bones as a sparse_mocap.Motion without frames."""
    skeleton = core().Skeleton(
        [bone.name for bone in bones],
        [bone.parent for bone in bones],
        np.array([bone.head for bone in bones]),
        np.array([bone.tail for bone in bones]),
    )
    return core().Motion(skeleton, 1.0, np.empty((0, 3)), np.empty((0, len(bones), 4)))


def _body(bones: list[RestBone], mapped: list[str]) -> list[RestBone]:
    """The lowest bone on which all mapped ones hang, and everything below it."""
    index = {bone.name: number for number, bone in enumerate(bones)}
    paths = [_path(bones, index[name]) for name in mapped]
    top = max(set(paths[0]).intersection(*paths[1:]))
    kept: dict[int, int] = {top: 0}
    body = [RestBone(bones[top].name, -1, bones[top].head, bones[top].tail)]
    for number, bone in enumerate(bones):
        if bone.parent in kept and number != top:
            kept[number] = len(body)
            body.append(RestBone(bone.name, kept[bone.parent], bone.head, bone.tail))
    return body


def _ankle_height(body: list[RestBone], feet: list[int]) -> float:
    """How high the ankles are above the soles at rest; 0 without feet."""
    if not feet:
        return 0.0
    below = [
        number for number in range(len(body)) if any(foot in _path(body, number) for foot in feet)
    ]
    sole = min(min(body[number].head[1], body[number].tail[1]) for number in below)
    ankle = float(np.mean([body[foot].head[1] for foot in feet]))
    highest = _HIGHEST_ANKLE * max(float(body[0].head[1]) - sole, 0.0)
    return float(min(ankle - sole, highest))


def _path(bones: list[RestBone], bone: int) -> list[int]:
    """The bone and all that it hangs on."""
    path = []
    while bone >= 0:
        path.append(bone)
        bone = bones[bone].parent
    return path


def _with_parents(joints: list[int], parents: list[int]) -> list[int]:
    """The joints and all that they hang on, ascending."""
    needed = {0}
    for joint in joints:
        while joint >= 0 and joint not in needed:
            needed.add(joint)
            joint = parents[joint]
    return sorted(needed)


def _matrices(quaternions: Any) -> Floats:
    """(..., 3, 3) of (..., 4) w x y z."""
    w, x, y, z = np.moveaxis(np.asarray(quaternions, dtype=np.float64), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))
