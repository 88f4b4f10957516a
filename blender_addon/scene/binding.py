# SPDX-License-Identifier: GPL-3.0-or-later
"""How the controls of a rig move its body."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from bpy.types import Context, Object
from mathutils import Quaternion, Vector

from ..session.character import Character, RestBone
from ..session.controls import Control, Controls, Limb, Mover, Placed
from ..session.errors import InputError
from ..session.retarget import Target
from .armature import units_per_metre
from .axes import AXES_BLENDER_CORE, Floats
from .control_bones import IkLimb, PickedBones, picked_bones
from .pose_memory import pose_kept
from .rig_probe import Found, Probe, rotation_of

_STUCK = 1e-6  # the determinant of how a bone answers to its location
_EVEN = 1e-2  # how far the axes' scales may differ, relative
_IK_ENDS = {
    "FK": (),
    "LEGS": ("ltibia", "rtibia"),
    "IK": ("ltibia", "rtibia", "lradius", "rradius"),
}


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


def bind(context: Context, armature: Object, limbs: str = "FK") -> Target:
    """The armature with its controls; its pose is as before afterwards.

    limbs: FK, IK, or LEGS for the legs' IK alone, where the rig has both. Raises InputError.
    """
    _check_visible(context, armature)
    character = character_of(context, armature)
    picked = picked_bones(armature)
    mover = picked.mover or character.top
    if mover not in armature.data.bones:
        raise InputError(f'"{armature.name}": its body does not hang on one bone: parent its bones')
    names = list(character.turned)
    turns = list(range(len(names)))
    if mover not in names:
        names.append(mover)
        turns.append(character.turned.index(character.pelvis) if picked.mover else -1)
    chosen = _chosen_limbs(character, picked, limbs)
    properties = dict(picked.properties)
    for limb in chosen:
        properties |= picked.ik_properties.get(limb.end, {})
    with pose_kept(armature):
        probe = Probe(context, armature)
        free = [name for limb in chosen if not limb.is_switched for name in limb.shown]
        with probe.at_rest(picked.properties, free):
            found, [response] = probe.found(names, names), probe.responses([mover])
        with probe.at_rest(properties):
            made = _made_limbs(probe, names, chosen)
    if abs(np.linalg.det(response)) < _STUCK:
        raise InputError(
            f'"{armature.name}": the bone "{mover}" cannot be moved, it is held by a constraint'
        )
    order = _followed_first([one.follows for one in found])
    place = {names[number]: position for position, number in enumerate(order)}
    thighs = (place[character.joints["lfemur"]], place[character.joints["rfemur"]])
    space = own_space(context, armature)
    by_ik = {bone for limb in chosen for bone in _limb_bones(character, limb)}
    rig = Controls(
        _controls(names, turns, found, order, by_ik),
        Mover(place[mover], response, thighs),
        space.R_armature_own,
        space.units_per_metre,
        properties,
        tuple(_limb(armature, character, one, names, place) for one in made),
    )
    held = [names[number] for number in order if found[number].follows is None]
    others = [name for limb in picked.limbs for name in (limb.target, limb.pole)]
    others += [path for paths in picked.ik_properties.values() for path in paths]
    return Target(armature.name, character, rig, held, tuple(others))


def _check_visible(context: Context, armature: Object) -> None:
    if armature.name not in context.view_layer.objects or not armature.visible_get():
        raise InputError(f'"{armature.name}" is hidden: show it in the viewport first')
    if armature.mode == "EDIT":
        raise InputError(f'"{armature.name}" is in Edit Mode: leave it first')
    if armature.data.pose_position == "REST":
        raise InputError(f'"{armature.name}" shows its rest position: switch to Pose Position')


def _chosen_limbs(character: Character, picked: PickedBones, limbs: str) -> list[IkLimb]:
    """Those that IK controls are to move."""
    ends = {character.ends[joint] for joint in _IK_ENDS[limbs] if joint in character.ends}
    every = set(character.ends.values())
    return [
        limb
        for limb in picked.limbs
        if limb.end in every and (limb.end in ends or not limb.is_switched)
    ]


def _limb_bones(character: Character, limb: IkLimb) -> tuple[str, str, str]:
    """The bones of a limb: upper, lower and end."""
    lower = next(joint for joint, end in character.ends.items() if end == limb.end)
    upper = {"tibia": "femur", "radius": "humerus"}[lower[1:]]
    return character.joints[lower[0] + upper], character.joints[lower], limb.end


def _controls(
    names: list[str], turns: list[int], found: list[Found], order: list[int], by_ik: set[str]
) -> list[Control]:
    place = {number: position for position, number in enumerate(order)}
    return [
        Control(
            names[number],
            turns[number],
            rotation_of(found[number].T_armature_rest),
            place.get(found[number].follows or 0, -1) if found[number].is_following else -1,
            found[number].T_followed_frame,
            names[number] not in by_ik,
        )
        for number in order
    ]


@dataclass(frozen=True)
class _MadeLimb:
    """A limb's IK controls; they follow controls by those ones' indices among the names."""

    limb: IkLimb
    target: Placed
    pole: Placed | None = None
    pole_angle_rad: float = 0.0


def _made_limbs(probe: Probe, names: list[str], limbs: list[IkLimb]) -> list[_MadeLimb]:
    """Ask the rig, for all limbs at once: each question lets Blender evaluate the whole rig."""
    if not limbs:
        return []
    with_pole = [limb for limb in limbs if limb.pole]
    targets, poles = [limb.target for limb in limbs], [limb.pole for limb in with_pole]
    found = probe.found(names, targets + poles)
    target_responses = probe.responses(targets)
    responses = target_responses + (probe.responses(poles) if poles else [])
    placed = [_placed(*one) for one in zip(targets + poles, found, responses, strict=True)]
    bent = [response for limb, response in zip(limbs, target_responses, strict=True) if limb.pole]
    angles = probe.pole_angles_rad(with_pole, bent) if with_pole else []
    made_poles = dict(zip(with_pole, zip(placed[len(limbs) :], angles, strict=True), strict=True))
    return [
        _MadeLimb(limb, target, *made_poles.get(limb, ()))
        for limb, target in zip(limbs, placed[: len(limbs)], strict=True)
    ]


def _placed(name: str, found: Found, response: Floats) -> Placed:
    """An IK control; it follows a control by that one's index among the names."""
    if found.is_following:
        response = rotation_of(found.T_armature_followed).T @ response
    follows = found.follows if found.is_following and found.follows is not None else -1
    return Placed(name, follows, found.T_armature_rest, found.T_followed_frame, response)


def _limb(
    armature: Object,
    character: Character,
    made: _MadeLimb,
    names: list[str],
    place: dict[str, int],
) -> Limb:
    bones = _limb_bones(character, made.limb)
    heads = np.array([armature.data.bones[name].head_local for name in bones])

    def at_place(placed: Placed) -> Placed:
        follows = place[names[placed.follows]] if placed.follows >= 0 else -1
        return replace(placed, follows=follows)

    begin, middle, end = (place[name] for name in bones)
    return Limb(
        begin,
        middle,
        end,
        target=at_place(made.target),
        pole=at_place(made.pole) if made.pole is not None else None,
        pole_angle_rad=made.pole_angle_rad,
        rest=heads,
    )


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
