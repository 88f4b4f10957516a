# SPDX-License-Identifier: GPL-3.0-or-later
"""How the controls of a rig move its body: found by posing it, so that any rig can be asked."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from bpy.types import Context, Object
from mathutils import Matrix, Quaternion, Vector

from ..session.character import Character, RestBone
from ..session.controls import Control, Controls, Mover
from ..session.errors import InputError
from ..session.retarget import Target
from .armature import units_per_metre
from .axes import AXES_BLENDER_CORE, Floats
from .control_bones import PickedBones, picked_bones
from .pose_memory import pose_kept

_POSES = 3  # that are tried
_LARGEST_TURN = 0.6  # rad
_SAME = 1e-3
_EVEN = 1e-2  # how far the axes' scales may differ, relative


@dataclass(frozen=True)
class OwnSpace:
    """The character's own space in the armature's: upright, in the core's axes and metres."""

    R_armature_own: Floats
    units_per_metre: float

    def own(self, vector: Vector) -> Floats:
        """A position in the armature in the own space."""
        return self.R_armature_own.T @ np.array(vector) / self.units_per_metre


def own_space(context: Context, armature: Object) -> OwnSpace:
    """The own space. Raises InputError when the armature is mirrored, or scaled unevenly."""
    _, turned, scale = armature.matrix_world.decompose()
    smallest, largest = min(scale), max(scale)
    if smallest <= 0.0 or armature.matrix_world.determinant() < 0.0:
        raise InputError(f'"{armature.name}" has a negative scale: apply the scale (Ctrl A)')
    if largest > (1.0 + _EVEN) * smallest:
        raise InputError(f'"{armature.name}" is scaled unevenly: apply the scale (Ctrl A)')
    heading = Quaternion((turned.w, 0.0, 0.0, turned.z))
    upright = heading.normalized().inverted() @ turned if heading.magnitude > 1e-6 else turned
    R_armature_own = np.array(upright.to_matrix()).T @ AXES_BLENDER_CORE
    return OwnSpace(R_armature_own, units_per_metre(context.scene) / float(sum(scale) / 3.0))


def rest_bones(
    context: Context, armature: Object, *, with_mechanism: bool = False
) -> list[RestBone]:
    """The armature's bones that may be mapped, at rest. Raises InputError."""
    if not armature.data.bones:
        raise InputError(f'"{armature.name}" has no bones')
    space = own_space(context, armature)
    return _rest_bones(picked_bones(armature, with_mechanism=with_mechanism), space)


def character_of(context: Context, armature: Object) -> Character:
    """The armature with its mapping, remembered or found. Raises InputError."""
    bones = rest_bones(context, armature)
    try:
        return Character(armature.name, bones)
    except InputError:
        everything = rest_bones(context, armature, with_mechanism=True)
        if len(everything) == len(bones):
            raise
        return Character(armature.name, everything)


def bind(context: Context, armature: Object) -> Target:
    """The armature with its controls; its pose is as before afterwards. Raises InputError."""
    if armature.name not in context.view_layer.objects or not armature.visible_get():
        raise InputError(f'"{armature.name}" is hidden: show it in the viewport first')
    if armature.data.pose_position == "REST":
        raise InputError(f'"{armature.name}" shows its rest position: switch to Pose Position')
    character = character_of(context, armature)
    picked = picked_bones(armature)
    names = list(character.turned)
    mover = picked.mover or character.top
    space = own_space(context, armature)
    turns = [character.turned.index(name) for name in names]
    if mover not in names:
        names.append(mover)
        is_rigify = bool(picked.mover)
        turns.append(character.turned.index(character.pelvis) if is_rigify else -1)
    with pose_kept(armature), _at_rest(context, armature, picked):
        tries = list(_tries(context, armature, names))
        response = _response(context, armature, mover)
    return _target(armature, character, names, turns, mover, tries, response, picked, space)


def _rest_bones(picked: PickedBones, space: OwnSpace) -> list[RestBone]:
    index = {bone.name: number for number, bone in enumerate(picked.bones)}
    bones = [
        RestBone(
            bone.name,
            index[bone.parent] if bone.parent else -1,
            space.own(bone.head),
            space.own(bone.tail),
        )
        for bone in picked.bones
    ]
    roots = [number for number, bone in enumerate(bones) if bone.parent < 0]
    if len(roots) == 1:
        return bones
    top = RestBone("", -1, np.zeros(3), np.array([0.0, 0.1, 0.0]))  # what they all hang on
    return [
        RestBone(" armature", -1, top.head, top.tail),
        *(RestBone(bone.name, bone.parent + 1, bone.head, bone.tail) for bone in bones),
    ]


@contextmanager
def _at_rest(context: Context, armature: Object, picked: PickedBones) -> Iterator[None]:
    """All bones at rest and FK switched on, for a while."""
    for bone in armature.pose.bones:
        bone.matrix_basis = Matrix()
    set_properties(armature, picked.properties)
    context.view_layer.update()
    yield


def set_properties(armature: Object, properties: dict[str, float]) -> None:
    """Set custom properties of bones, as data paths from the object."""
    for path, value in properties.items():
        holder, _, name = path.rpartition("[")
        bone = armature.path_resolve(holder)
        key = name.strip('"]')
        bone[key] = type(bone[key])(value)
    armature.update_tag()


@dataclass(frozen=True)
class _Try:
    """Where controls and their frames were in one pose."""

    poses: list[Floats]  # (4, 4)
    frames: list[Floats]


def _tries(context: Context, armature: Object, names: list[str]) -> Iterator[_Try]:
    """The rest pose, then poses in which each control is turned differently."""
    random = np.random.default_rng(1)
    for number in range(_POSES + 1):
        for name in names:
            axis, angle = random.normal(size=3), random.uniform(0.2, _LARGEST_TURN)
            if number > 0:
                turned = Quaternion(Vector(axis), angle).to_matrix().to_4x4()
                armature.pose.bones[name].matrix_basis = turned
        context.view_layer.update()
        bones = [armature.pose.bones[name] for name in names]
        poses = [np.array(bone.matrix) for bone in bones]
        frames = [np.array(bone.matrix @ bone.matrix_basis.inverted()) for bone in bones]
        yield _Try(poses, frames)
    for name in names:
        armature.pose.bones[name].matrix_basis = Matrix()


def _response(context: Context, armature: Object, mover: str) -> Floats:
    """(3, 3) how the bone moves in the armature with its location's three numbers."""
    bone = armature.pose.bones[mover]
    step = armature.data.bones[mover].length
    columns = []
    context.view_layer.update()
    rest = np.array(bone.matrix.translation)
    for axis in range(3):
        bone.location = [step if axis == other else 0.0 for other in range(3)]
        context.view_layer.update()
        columns.append((np.array(bone.matrix.translation) - rest) / step)
    bone.location = (0.0, 0.0, 0.0)
    return np.array(columns).T


def _target(
    armature: Object,
    character: Character,
    names: list[str],
    turns: list[int],
    mover: str,
    tries: list[_Try],
    response: Floats,
    picked: PickedBones,
    space: OwnSpace,
) -> Target:
    if abs(np.linalg.det(response)) < 1e-6:
        raise InputError(
            f'"{armature.name}": the bone "{mover}" cannot be moved, it is held by a constraint'
        )
    followed = [_followed(number, tries) for number in range(len(names))]
    order = _followed_first(followed)
    held = [names[number] for number in order if followed[number] is None]
    place = {number: position for position, number in enumerate(order)}
    controls = []
    for number in order:
        follows = followed[number]
        follows = -1 if follows is None else follows
        frame = tries[0].frames[number]
        pose = tries[0].poses[follows] if follows >= 0 else np.eye(4)
        controls.append(
            Control(
                names[number],
                turns[number],
                _rotation(tries[0].poses[number]),
                place[follows] if follows >= 0 else -1,
                _unscaled(np.linalg.inv(_unscaled(pose)) @ _unscaled(frame)),
            )
        )
    thighs = [names.index(character.joints[joint]) for joint in ("lfemur", "rfemur")]
    moving = Mover(place[names.index(mover)], response, (place[thighs[0]], place[thighs[1]]))
    return Target(
        armature.name,
        character,
        Controls(
            controls, moving, space.R_armature_own, space.units_per_metre, dict(picked.properties)
        ),
        held,
    )


def _followed(number: int, tries: list[_Try]) -> int | None:
    """The control that a control's frame moves with; -1: none; None: with no single one."""
    candidates = [other for other in range(len(tries[0].poses)) if other != number]
    errors = {-1: _change([one.frames[number] for one in tries])}
    for other in candidates:
        relative = [
            np.linalg.inv(_unscaled(one.poses[other])) @ _unscaled(one.frames[number])
            for one in tries
        ]
        errors[other] = _change(relative)
    best = min(errors, key=lambda other: errors[other])
    return best if errors[best] < _SAME else None


def _change(matrices: list[Floats]) -> float:
    """How far the rotations are from being one."""
    first = _rotation(matrices[0])
    return max(float(np.abs(_rotation(matrix) - first).max()) for matrix in matrices)


def _rotation(matrix: Floats) -> Floats:
    turned = matrix[:3, :3]
    return np.asarray(turned / np.linalg.norm(turned, axis=0))


def _unscaled(matrix: Floats) -> Floats:
    unscaled = matrix.copy()
    unscaled[:3, :3] = _rotation(matrix)
    return unscaled


def _followed_first(followed: list[int | None]) -> list[int]:
    """The controls' indices, each after the one that it follows."""
    order: list[int] = []
    while len(order) < len(followed):
        ready = [
            number
            for number, other in enumerate(followed)
            if number not in order and (other is None or other < 0 or other in order)
        ]
        if not ready:  # they follow each other
            ready = [number for number in range(len(followed)) if number not in order][:1]
        order.extend(ready)
    return order
