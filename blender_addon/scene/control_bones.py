# SPDX-License-Identifier: GPL-3.0-or-later
"""Which bones of an armature a motion may turn, and how they hang together."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from bpy.types import Bone, Object
from mathutils import Vector

_MECHANISM = re.compile(r"^(MCH|ORG|DEF|VIS|WGT)[-_]")
_FACE = "face"  # of Rigify's metarigs: hundreds of bones that no motion turns
_RIGIFY_MOVER = "torso"
_RIGIFY_ORIGINAL = "ORG-"


@dataclass(frozen=True)
class Picked:
    """A bone that may be turned. Positions are in the armature, at rest."""

    name: str
    parent: str
    head: Vector
    tail: Vector


@dataclass(frozen=True)
class PickedBones:
    """The bones, parents first."""

    bones: list[Picked]
    mover: str = ""
    """The bone whose location moves the character, if it is none of the bones."""
    properties: dict[str, float] = field(default_factory=dict)
    """Custom properties (data paths from the object) that FK controls need, and their values."""


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
    return PickedBones([_picked(bone, names) for bone in kept])


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
    picked = []
    for original in sorted(by_original, key=lambda name: len(bones[name].parent_recursive)):
        bone = originals[original]
        above = (by_original.get(parent.name, "") for parent in bone.parent_recursive)
        parent = next((name for name in above if name), "")
        picked.append(Picked(by_original[original], parent, bone.head_local, bone.tail_local))
    return PickedBones(picked, _RIGIFY_MOVER, _rigify_properties(armature))


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


def _rigify_properties(armature: Object) -> dict[str, float]:
    """FK limbs; a neck and head that turn with what they hang on."""
    wanted = {"IK_FK": 1.0, "FK_limb_follow": 0.0, "neck_follow": 1.0, "head_follow": 1.0}
    return {
        f'pose.bones["{bone.name}"]["{name}"]': value
        for bone in armature.pose.bones
        for name, value in wanted.items()
        if bone.name.endswith(("_parent.L", "_parent.R", _RIGIFY_MOVER)) and name in bone
    }
