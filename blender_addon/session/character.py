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

_PELVIS, _THIGHS, _SHANKS = "root", ("lfemur", "rfemur"), ("ltibia", "rtibia")
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
class FootLock:
    """How feet are kept where they stand."""

    strength: float = 1.0
    """0: not at all, 1: wholly."""
    least_certainty: float = 0.5
    """Of a foot that stands, 0 to 1."""
    fastest_mps: float = 0.7
    """A faster foot does not stand."""
    highest_m: float = 0.06
    """A foot that is higher above the floor does not stand."""


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
        feet = [name for name in self._mapping.ankles if name]
        turned = list(self._mapping.turned_joints)
        self.turned: list[str] = [*turned, *(name for name in feet if name not in turned)]
        """The bones that a motion turns."""
        self.ends = {
            joint: name
            for joint, name in (
                ("ltibia", self._mapping.ankles[0]),
                ("rtibia", self._mapping.ankles[1]),
                ("lradius", self.joints.get("lwrist", "")),
                ("rradius", self.joints.get("rwrist", "")),
            )
            if name in self.turned
        }
        """The bone at the end of each shank and forearm that has one: feet and hands."""
        names = [bone.name for bone in body]
        self._parents = [bone.parent for bone in body]
        self._turned = [names.index(name) for name in self.turned]
        self._pivots = np.array([bone.head for bone in body])
        self._thighs = [names.index(self.joints[joint]) for joint in _THIGHS]
        self._knees = [names.index(self.joints[shank]) for shank in _SHANKS]
        self._feet = [names.index(name) for name in feet]
        self._needed = _with_parents([*self._turned, *self._feet], self._parents)
        self._ankle_m = _ankle_height(body, self._feet)

        self.leg_bones = tuple(self._leg_bones(names, foot) for foot in feet)
        """For the left and the right leg: indices of the turned bones of thigh and of shank."""

    def _leg_bones(self, names: list[str], foot: str) -> tuple[list[int], list[int]]:
        """What turns with the thigh, and what with the shank; twist bones hang between them."""
        path = _path_of(self._parents, names.index(foot))[1:]
        side = 0 if foot == self._mapping.ankles[0] else 1
        thigh, knee = self._thighs[side], names.index(self.joints[_SHANKS[side]])
        shank = [bone for bone in path[: path.index(knee) + 1] if bone in self._turned]
        upper = path[path.index(knee) + 1 : path.index(thigh) + 1]
        turned = [bone for bone in upper if bone in self._turned]
        return [self._turned.index(b) for b in turned], [self._turned.index(b) for b in shank]

    @property
    def top(self) -> str:
        """The bone on which all others of the body hang."""
        return str(self._skeleton.names[0])

    @property
    def pelvis(self) -> str:
        """The bone of the pelvis."""
        return self.joints[_PELVIS]

    def on_rig(self, motion: Any) -> Any:
        """A motion on the standard skeleton on this rig (both sparse_mocap.Motion)."""
        return self._mapping.to_rig(motion)

    def standing(self, moved: Any) -> Any:
        """A whole take on this rig at the height at which the feet stand on the floor."""
        above = self.world(moved).above_floor_m
        if len(above) == 0:
            return moved
        up = np.array([0.0, -float(np.quantile(above, _STANDING)), 0.0])
        return core().Motion(
            self._skeleton, moved.frame_time_s, moved.root_positions + up, moved.rotations
        )

    def with_locked_feet(
        self, moved: Any, contacts: Floats, lock: FootLock
    ) -> tuple[Any, NDArray[np.bool_]]:
        """A take on this rig with feet that stay where they stand, and when they do (T, 2).

        contacts (T, 2): how certain it is that the left and the right foot stand.
        """
        if len(self._feet) < 2 or lock.strength == 0.0:
            return moved, np.zeros((moved.num_frames, 2), dtype=bool)
        locked: tuple[Any, NDArray[np.bool_]] = self._mapping.lock_feet(
            moved,
            contacts,
            strength=lock.strength,
            ankle_height_m=self._ankle_m,
            least_certainty=lock.least_certainty,
            fastest_mps=lock.fastest_mps,
            highest_m=lock.highest_m,
        )
        return locked

    def world(self, moved: Any) -> RigMotion:
        """Where a motion on this rig turns the bones."""
        return self.world_and_legs(moved)[0]

    def world_and_legs(self, moved: Any) -> tuple[RigMotion, Floats]:
        """Where a motion on this rig turns the bones, and where its legs are.

        Those are (T, 2, 3, 3): hip, knee and ankle, left and right; (T, 0, 3, 3) without feet.
        """
        world, positions = self._posed(moved)
        hips = np.mean([positions[thigh] for thigh in self._thighs], axis=0)
        rotations = np.stack([world[joint] for joint in self._turned], axis=1)
        ankles = [positions[foot][:, 1] for foot in self._feet]
        lowest = np.min(ankles, axis=0) if ankles else np.full(len(hips), self._ankle_m)
        motion = RigMotion(moved.frame_time_s, rotations, hips, lowest - self._ankle_m)
        return motion, self._legs(positions)

    @property
    def has_feet(self) -> bool:
        """Whether both legs end in a foot."""
        return len(self._feet) == 2

    @property
    def ankle_m(self) -> float:
        """How high ankles are while the feet stand on the floor."""
        return self._ankle_m

    def _legs(self, positions: dict[int, Floats]) -> Floats:
        if not self.has_feet:
            return np.empty((len(positions[0]), 0, 3, 3))
        legs = zip(self._thighs, self._knees, self._feet, strict=True)
        return np.moveaxis(np.array([[positions[bone] for bone in leg] for leg in legs]), 2, 0)

    def _posed(self, moved: Any) -> tuple[dict[int, Floats], dict[int, Floats]]:
        """(T, 3, 3) and (T, 3) of the needed bones in the character's space."""
        local = _matrices(moved.rotations)
        world: dict[int, Floats] = {}
        positions: dict[int, Floats] = {0: np.asarray(moved.root_positions)}
        for joint in self._needed:
            parent = self._parents[joint]
            world[joint] = local[:, joint] if parent < 0 else world[parent] @ local[:, joint]
            if parent >= 0:
                offset = self._pivots[joint] - self._pivots[parent]
                positions[joint] = positions[parent] + world[parent] @ offset
        return world, positions


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
    return _path_of([one.parent for one in bones], bone)


def _path_of(parents: list[int], bone: int) -> list[int]:
    """The bone and all that it hangs on."""
    path = []
    while bone >= 0:
        path.append(bone)
        bone = parents[bone]
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
