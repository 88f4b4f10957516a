# SPDX-License-Identifier: GPL-3.0-or-later
"""Which bones of an armature a motion may turn, and how they hang together."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from bpy.types import Bone, Object
from mathutils import Vector

_MECHANISM = re.compile(r"^(MCH|ORG|DEF|VIS|WGT)[-_]")
_FACE = "face"  # of Rigify's metarigs: hundreds of bones that no motion turns
_ARP_SWITCH = "ik_fk_switch"  # of Auto-Rig Pro's IK controls: 0 is IK, 1 is FK
_RIGIFY_MOVER = "torso"
_RIGIFY_ORIGINAL = "ORG-"
_RIGIFY_SPINE = f"{_RIGIFY_ORIGINAL}spine"


@dataclass(frozen=True)
class Picked:
    """A bone that may be turned. Positions are in the armature, at rest."""

    name: str
    parent: str
    head: Vector
    tail: Vector


@dataclass(frozen=True)
class IkLimb:
    """The controls of a limb's own IK."""

    end: str
    """The bone at the limb's end whose place and rotation the target gives: a hand or foot."""
    target: str
    pole: str
    shown: tuple[str, str, str]
    """The limb's upper and lower bone and its end, as they are posed in the end."""
    is_switched: bool = False
    """Whether the rig has FK controls for the limb too; else it always needs IK."""


@dataclass(frozen=True)
class PickedBones:
    """The bones, parents first."""

    bones: list[Picked]
    mover: str = ""
    """The bone whose location moves the character, if it is none of the bones."""
    properties: dict[str, float] = field(default_factory=dict)
    """Custom properties (data paths from the object) that FK controls need, and their values."""
    ik_properties: dict[str, dict[str, float]] = field(default_factory=dict)
    """For the end of each limb: those that its IK controls need instead."""
    limbs: tuple[IkLimb, ...] = ()


def is_rigify(armature: Object) -> bool:
    """Whether the armature is a rig that Rigify generated for a body."""
    bones = armature.data.bones
    return "rig_id" in armature.data and _RIGIFY_MOVER in bones and "ORG-spine" in bones


def picked_bones(armature: Object, *, with_mechanism: bool = False) -> PickedBones:
    """The bones to map. with_mechanism: also those with prefixes such as DEF- and MCH-."""
    if is_rigify(armature):
        return _rigify_controls(armature)
    bones = sorted(armature.data.bones, key=lambda bone: len(bone.parent_recursive))
    kept = [
        bone
        for bone in bones
        if not any(parent.name == _FACE for parent in (bone, *bone.parent_recursive))
        and (with_mechanism or not _MECHANISM.match(bone.name))
    ]
    names = {bone.name for bone in kept}
    picked = [_picked(bone, names) for bone in kept]
    limbs = tuple(_arp_limbs(armature))
    if limbs:
        fk = {_property_path(limb.target, _ARP_SWITCH): 1.0 for limb in limbs}
        ik_properties = {limb.end: _arp_ik_properties(armature, limb) for limb in limbs}
        return PickedBones(picked, "", fk, ik_properties, limbs)
    return PickedBones(picked, limbs=tuple(_constrained_limbs(armature, names)))


def _picked(bone: Bone, names: set[str]) -> Picked:
    parent = next((above.name for above in bone.parent_recursive if above.name in names), "")
    return Picked(bone.name, parent, bone.head_local, bone.tail_local)


def _rigify_controls(armature: Object) -> PickedBones:
    """The FK controls, where and under what the bones are that they stand for."""
    bones = armature.data.bones
    originals = {bone.name: bone for bone in bones if bone.name.startswith(_RIGIFY_ORIGINAL)}
    by_original = {
        original: control
        for original in originals
        if (control := _rigify_control(armature, original)) is not None
    }
    spine = sorted(name for name in by_original if name.startswith(_RIGIFY_SPINE))
    below = dict(pairwise(reversed(spine)))
    order = [*spine, *(name for name in _by_depth(bones, by_original) if name not in spine)]
    picked = []
    for original in order:
        bone = originals[original]
        above = (by_original.get(parent.name, "") for parent in bone.parent_recursive)
        parent = next((name for name in above if name), "")
        if original in spine:  # the controls of spines hang on the torso, each by itself
            parent = by_original[below[original]] if original in below else ""
        picked.append(Picked(by_original[original], parent, bone.head_local, bone.tail_local))
    limbs = tuple(_rigify_limbs(armature))
    ik_properties = {limb.end: _rigify_ik_properties(armature, limb) for limb in limbs}
    fk = _rigify_fk_properties(armature)
    return PickedBones(picked, _RIGIFY_MOVER, fk, ik_properties, limbs)


def _by_depth(bones: Any, names: Iterable[str]) -> list[str]:
    return sorted(names, key=lambda name: len(bones[name].parent_recursive))


def _rigify_control(armature: Object, original: str) -> str | None:
    """The FK control of one of Rigify's original bones; None for fingers and face."""
    bones = armature.data.bones
    name = original.removeprefix(_RIGIFY_ORIGINAL)
    stem, dot, ending = name.partition(".")
    if f"{stem}_fk{dot}{ending}" in bones:
        return f"{stem}_fk{dot}{ending}"
    if name.startswith("shoulder.") and name in bones:
        return name
    if not name.startswith("spine."):
        return None
    middle = bones[original].head_local
    for control in ("neck", "head"):
        if control in bones and (bones[control].head_local - middle).length < 1e-4:
            return control
    return None


def _rigify_fk_properties(armature: Object) -> dict[str, float]:
    """FK limbs; a neck and head that turn with what they hang on."""
    wanted = {"IK_FK": 1.0, "FK_limb_follow": 0.0, "neck_follow": 1.0, "head_follow": 1.0}
    return {
        _property_path(bone.name, name): value
        for bone in armature.pose.bones
        for name, value in wanted.items()
        if bone.name.endswith(("_parent.L", "_parent.R", _RIGIFY_MOVER)) and name in bone
    }


def _rigify_limbs(armature: Object) -> Iterator[IkLimb]:
    for upper, lower, end in (("upper_arm", "forearm", "hand"), ("thigh", "shin", "foot")):
        for side in (".L", ".R"):
            limb = IkLimb(
                f"{end}_fk{side}",
                f"{end}_ik{side}",
                f"{upper}_ik_target{side}",
                (f"ORG-{upper}{side}", f"ORG-{lower}{side}", f"ORG-{end}{side}"),
                is_switched=True,
            )
            if all(name in armature.data.bones for name in (limb.end, limb.target, limb.pole)):
                yield limb


def _rigify_ik_properties(armature: Object, limb: IkLimb) -> dict[str, float]:
    """IK with a pole and no stretch; target and pole in the space of the whole character."""
    holder = limb.pole.replace("_ik_target", "_parent")
    wanted = {"IK_FK": 0.0, "IK_Stretch": 0.0, "pole_vector": 1, "IK_parent": 1, "pole_parent": 1}
    bone = armature.pose.bones[holder]
    return {_property_path(holder, name): value for name, value in wanted.items() if name in bone}


def _arp_limbs(armature: Object) -> Iterator[IkLimb]:
    """The limbs of a rig with the names of Auto-Rig Pro's controls that have an FK-IK switch."""
    for upper, lower, end, pole in (
        ("arm", "forearm", "hand", "arms_pole"),
        ("thigh", "leg", "foot", "leg_pole"),
    ):
        for side in (".l", ".r"):
            limb = IkLimb(
                f"c_{end}_fk{side}",
                f"c_{end}_ik{side}",
                f"c_{pole}{side}",
                (f"{upper}{side}", f"{lower}{side}", f"{end}{side}"),
                is_switched=True,
            )
            bones = armature.pose.bones
            needed = (limb.end, limb.target, limb.pole, *limb.shown)
            if all(name in bones for name in needed) and _ARP_SWITCH in bones[limb.target]:
                yield limb


def _arp_ik_properties(armature: Object, limb: IkLimb) -> dict[str, float]:
    """IK without stretch, its pole in the space of the whole character."""
    wanted = {
        (limb.target, _ARP_SWITCH): 0.0,
        (limb.target, "auto_stretch"): 0.0,
        (limb.pole, "pole_parent"): 0.0,
    }
    bones = armature.pose.bones
    return {
        _property_path(bone, name): value
        for (bone, name), value in wanted.items()
        if name in bones[bone]
    }


def _constrained_limbs(armature: Object, names: set[str]) -> Iterator[IkLimb]:
    """The limbs of any rig whose lower bone an IK constraint bends."""
    for bone in armature.pose.bones:
        for constraint in bone.constraints:
            if constraint.type != "IK" or constraint.mute or constraint.influence < 1.0:
                continue
            if constraint.target != armature or constraint.chain_count not in (0, 2):
                continue
            ends = [child.name for child in bone.children if child.name in names]
            target = _free_bone(armature, constraint.subtarget)
            has_pole = constraint.pole_target == armature and constraint.pole_subtarget
            pole = _free_bone(armature, constraint.pole_subtarget) if has_pole else ""
            if ends and target and bone.parent is not None:
                shown = (bone.parent.name, bone.name, ends[0])
                yield IkLimb(ends[0], target, pole, shown)


def _free_bone(armature: Object, name: str) -> str:
    """The bone or the nearest above it that nothing but its own channels moves."""
    bone = armature.pose.bones.get(name)
    while bone is not None and any(not constraint.mute for constraint in bone.constraints):
        bone = bone.parent
    return bone.name if bone is not None else ""


def _property_path(bone: str, name: str) -> str:
    return f'pose.bones["{bone}"]["{name}"]'
