# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds how the bones of a rig move by posing it, so that any rig can be asked."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from bpy.types import Constraint, Context, Object
from mathutils import Matrix, Quaternion, Vector

from .axes import Floats
from .control_bones import IkLimb

_POSES = 3  # that are tried
_LARGEST_TURN = 0.6  # rad
_SAME = 1e-3


@dataclass(frozen=True)
class Found:
    """How the frame of a bone moves, in which its own channels count."""

    follows: int | None
    """Which of the bones asked for it moves with; -1: none; None: no single one."""
    T_armature_rest: Floats  # (4, 4) the bone at rest
    T_armature_followed: Floats  # (4, 4) the bone that it moves with, at rest
    T_followed_frame: Floats  # (4, 4)

    @property
    def is_following(self) -> bool:
        """Whether it moves with one of the bones."""
        return self.follows is not None and self.follows >= 0


@dataclass(frozen=True)
class _Try:
    """Where bones and frames were in one pose: (4, 4) each."""

    poses: list[Floats]
    frames: list[Floats]


class Probe:
    """Poses an armature; whoever uses it keeps the pose."""

    def __init__(self, context: Context, armature: Object) -> None:
        self._context = context
        self._armature = armature

    @contextmanager
    def at_rest(self, properties: dict[str, float], free: Iterable[str] = ()) -> Iterator[None]:
        """All bones at rest and custom properties set, for a while; free: without constraints."""
        for bone in self._armature.pose.bones:
            bone.matrix_basis = Matrix()
        set_properties(self._armature, properties)
        muted = list(self._constraints(free))
        for constraint in muted:
            constraint.mute = True
        try:
            self._update()
            yield
        finally:
            for constraint in muted:
                constraint.mute = False

    def found(self, followed: list[str], names: list[str]) -> list[Found]:
        """How the frames of the named bones move with those that may be followed."""
        tries = list(self._tries(followed, names))
        inverses = np.linalg.inv(np.array([one.poses for one in tries]))
        return [
            self._one_found(number, name, followed, tries, inverses)
            for number, name in enumerate(names)
        ]

    def responses(self, names: list[str]) -> list[Floats]:
        """For each bone (3, 3) how it moves in the armature with its location's three numbers.

        All are moved at once, so none of them may move another one.
        """
        bones = [self._armature.pose.bones[name] for name in names]
        steps = [self._armature.data.bones[name].length for name in names]
        rest = self._places(names)
        columns = []
        for axis in range(3):
            for bone, step in zip(bones, steps, strict=True):
                bone.location = [step if axis == other else 0.0 for other in range(3)]
            self._update()
            columns.append((self._places(names) - rest) / np.array(steps)[:, None])
        for bone in bones:
            bone.location = (0.0, 0.0, 0.0)
        self._update()
        return list(np.stack(columns, axis=-1))

    def _places(self, names: list[str]) -> Floats:
        """(B, 3) where the bones begin in the armature."""
        bones = self._armature.pose.bones
        return np.array([bones[name].matrix.translation for name in names]).reshape(-1, 3)

    def _tries(self, followed: list[str], names: list[str]) -> Iterator[_Try]:
        """The pose that there is, then poses in which each bone that may be followed is turned."""
        random = np.random.default_rng(1)
        pose = self._armature.pose
        for number in range(_POSES + 1):
            for name in followed:
                axis, angle = random.normal(size=3), random.uniform(0.2, _LARGEST_TURN)
                if number > 0:
                    turned = Quaternion(Vector(axis), angle).to_matrix().to_4x4()
                    pose.bones[name].matrix_basis = turned
            if number > 0:
                self._update()
            frames = [pose.bones[name] for name in names]
            yield _Try(
                [unscaled(np.array(pose.bones[name].matrix)) for name in followed],
                [unscaled(np.array(one.matrix @ one.matrix_basis.inverted())) for one in frames],
            )
        for name in followed:
            pose.bones[name].matrix_basis = Matrix()
        self._update()

    def _one_found(
        self, number: int, name: str, followed: list[str], tries: list[_Try], inverses: Floats
    ) -> Found:
        """How one frame moves; inverses (tries, followed, 4, 4): of the poses it may follow."""
        frames = np.array([one.frames[number] for one in tries])
        changes = _changes(inverses @ frames[:, None])
        if name in followed:
            changes[followed.index(name)] = np.inf
        best = int(np.argmin(changes))
        least, alone = float(changes[best]), float(_changes(frames[:, None])[0])
        if alone <= least:
            best, least = -1, alone
        is_single = least < _SAME
        at_rest = np.array(self._armature.data.bones[name].matrix_local)
        T_followed = tries[0].poses[best] if is_single and best >= 0 else np.eye(4)
        return Found(
            best if is_single else None,
            at_rest,
            T_followed,
            unscaled(np.linalg.inv(T_followed) @ frames[0]),
        )

    def pole_angles_rad(self, limbs: list[IkLimb], responses: list[Floats]) -> list[float]:
        """How far each limb's plane is turned from its pole, about the line to the limb's end.

        Blender aims an axis of the upper bone at the pole, not the bone below it. responses: of the
        limbs' targets; all limbs are bent at once.
        """
        pose = self._armature.pose
        for limb, response in zip(limbs, responses, strict=True):
            upper, _, end = (pose.bones[name] for name in limb.shown)
            nearer = 0.25 * (upper.head - end.head)
            pose.bones[limb.target].location = Matrix(response.tolist()).inverted() @ nearer
        self._update()
        angles = [self._pole_angle_rad(limb) for limb in limbs]
        for limb in limbs:
            pose.bones[limb.target].location = (0.0, 0.0, 0.0)
        self._update()
        return angles

    def _pole_angle_rad(self, limb: IkLimb) -> float:
        """The angle in the pose that the limb has now, which must be bent."""
        pose = self._armature.pose
        upper, lower, end = (pose.bones[name] for name in limb.shown)
        along = (end.head - upper.head).normalized()
        middle = lower.head - upper.head
        aim = pose.bones[limb.pole].head - upper.head
        middle, aim = middle - along * along.dot(middle), aim - along * along.dot(aim)
        return math.atan2(aim.cross(middle).dot(along), aim.dot(middle))

    def _constraints(self, bones: Iterable[str]) -> Iterator[Constraint]:
        for name in bones:
            for constraint in self._armature.pose.bones[name].constraints:
                if not constraint.mute:
                    yield constraint

    def _update(self) -> None:
        self._context.view_layer.update()


def set_properties(armature: Object, properties: dict[str, float]) -> None:
    """Set custom properties of bones, as data paths from the object."""
    for path, value in properties.items():
        holder, _, name = path.rpartition("[")
        bone = armature.path_resolve(holder)
        key = name.strip('"]')
        bone[key] = type(bone[key])(value)
    armature.update_tag()


def rotation_of(matrix: Floats) -> Floats:
    """(3, 3) the rotation of a (4, 4) matrix, without scale."""
    turned = matrix[:3, :3]
    return np.asarray(turned / np.linalg.norm(turned, axis=0))


def unscaled(matrix: Floats) -> Floats:
    """The matrix (4, 4) without scale."""
    plain = matrix.copy()
    plain[:3, :3] = rotation_of(matrix)
    return plain


def _changes(matrices: Floats) -> Floats:
    """(n,) how far the rotations (tries, n, 4, 4) are from being the same in all tries."""
    rotations = matrices[..., :3, :3]
    return np.asarray(np.abs(rotations - rotations[0]).max(axis=(0, 2, 3)))
