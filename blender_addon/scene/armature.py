# SPDX-License-Identifier: GPL-3.0-or-later
"""A skeleton of the core as an armature: one bone for each joint, from its pivot to its end."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from bpy.types import Armature, Context, EditBone, Object, Scene
from mathutils import Vector

from ..session.errors import InputError
from ..session.names import fitting
from .axes import Floats, rest_pivots_and_ends, to_blender
from .figure import beyond, figure_names, leg_length

MARK = "sparse_mocap"  # custom property of armatures that this add-on made
NAME = "Sparse Mocap"

# Lengths of bones for joints without length, on a figure of average height.
_USUAL_HEIGHT_M = 1.7
_ROOT_LENGTH_M = 0.1
_LEAF_LENGTH_M = 0.05
_SHORTEST_BONE_M = 0.001  # Blender drops bones without length
_FIT_TOLERANCE_M = 1e-3
_OBJECT_MODES = {"EDIT_ARMATURE": "EDIT", "EDIT_MESH": "EDIT"}  # where context names it otherwise
_FRONT = Vector((0.0, -1.0, 0.0))
_UP = np.array([0.0, 1.0, 0.0])


@dataclass(frozen=True)
class RestBones:
    """(J, 3) heads and tails in the core's axes, metres, the feet on the ground."""

    names: list[str]
    parents: list[int]
    heads: Floats
    tails: Floats


@dataclass(frozen=True)
class Rig:
    """An armature of a skeleton."""

    armature: Object
    bones: list[str]
    """The joints' bones: named like the joints unless that name is too long for Blender."""
    units_per_metre: float


def rest_bones(skeleton: Any, *, is_figure: bool = False) -> RestBones:
    """The rest pose of a skeleton (sparse_mocap.Skeleton).

    is_figure: named as the add-on's own figure is, with its feet, toes and hands at the end.
    """
    parents, names = list(skeleton.parents), list(skeleton.names)
    pivots, ends = rest_pivots_and_ends(parents, skeleton.offsets, skeleton.bones)
    size_m = float(np.ptp(np.concatenate([pivots, ends]), axis=0).max())
    size = size_m / _USUAL_HEIGHT_M or 1.0
    tails = np.array([_tail(joint, parents, pivots, ends, size) for joint in range(len(parents))])
    if is_figure:
        leg_m = leg_length(names, np.asarray(skeleton.bones))
        names = figure_names(names)
        for name, parent, head, tail in beyond(names, pivots, tails, leg_m):
            names, parents = [*names, name], [*parents, parent]
            pivots, tails = np.vstack([pivots, head]), np.vstack([tails, tail])
            ends = np.vstack([ends, tail])
    lift = -min(pivots[:, 1].min(), ends[:, 1].min()) * _UP
    return RestBones(fitting(names), parents, pivots + lift, tails + lift)


def new_armature(
    context: Context,
    skeleton: Any,
    name: str = NAME,
    *,
    is_figure: bool = True,
    is_reusable: bool = True,
) -> Rig:
    """A new armature of the skeleton in the scene, active and alone selected.

    is_figure: as for rest_bones; is_reusable: whether takes may be put on it later.
    Raises InputError when the scene cannot hold one; nothing is left behind then.
    """
    _leave_mode(context)
    data = bpy.data.armatures.new(name)
    armature = bpy.data.objects.new(name, data)
    scale = units_per_metre(context.scene)
    try:
        _link(context, armature)
        select_only(context, armature)
        bpy.ops.object.mode_set(mode="EDIT")
        try:
            bones = rest_bones(skeleton, is_figure=is_figure)
            _add_bones(data, bones, scale)
        finally:
            bpy.ops.object.mode_set(mode="OBJECT")
    except Exception:
        remove_armature(armature)
        raise
    use_quaternions(armature)
    if is_reusable:
        data[MARK] = ",".join(skeleton.names)
    armature.show_in_front = True
    return Rig(armature, bones.names[: len(skeleton.names)], scale)


def remove_armature(armature: Object) -> None:
    """Remove the armature from the file, if it is still there."""
    with suppress(ReferenceError):  # already removed by an undo
        data = armature.data
        bpy.data.objects.remove(armature)
        bpy.data.armatures.remove(data)


@contextmanager
def selection_back_on_error(context: Context) -> Iterator[None]:
    """Restore selection, active object and mode when the block raises."""
    layer = context.view_layer
    active, mode = layer.objects.active, context.mode
    names = [obj.name for obj in layer.objects if obj.select_get()]
    active_name = active.name if active is not None else ""
    try:
        yield
    except BaseException:
        layer = context.view_layer
        layer.update()  # its list still has the removed objects otherwise
        for obj in layer.objects:
            obj.select_set(obj.name in names)
        layer.objects.active = layer.objects.get(active_name)
        if context.mode != mode and bpy.ops.object.mode_set.poll():
            bpy.ops.object.mode_set(mode=_OBJECT_MODES.get(mode, mode))
        raise


def use_quaternions(armature: Object) -> None:
    """Set the armature's bones to rotate by quaternions, as the keys do."""
    for bone in armature.pose.bones:
        bone.rotation_mode = "QUATERNION"


def units_per_metre(scene: Scene) -> float:
    """Blender units per metre in the scene."""
    settings = scene.unit_settings
    return 1.0 if settings.system == "NONE" else 1.0 / settings.scale_length


def rig_of(armature: Object, skeleton: Any) -> Rig:
    """The rig of an existing armature. Raises InputError when it has another skeleton."""
    bones = rest_bones(skeleton)
    named = figure_names(bones.names)
    if named[0] in armature.data.bones:
        bones = RestBones(named, bones.parents, bones.heads, bones.tails)
    missing = [name for name in bones.names if name not in armature.data.bones]
    if missing:
        raise InputError(f'"{armature.name}" has no bone {missing[0]}: untick "Reuse armature"')
    rest = [armature.data.bones[name] for name in bones.names]
    points = np.array([bone.head_local for bone in rest] + [bone.tail_local for bone in rest])
    theirs = points - points[0]
    ours = to_blender(np.concatenate([bones.heads, bones.tails]) - bones.heads[0])
    scale = float(np.linalg.norm(theirs) / np.linalg.norm(ours))
    if scale == 0.0 or np.abs(theirs / scale - ours).max() > _FIT_TOLERANCE_M:
        raise InputError(
            f'"{armature.name}" has other proportions than this motion database: '
            'untick "Reuse armature"'
        )
    return Rig(armature, bones.names, scale)


def rest_orientation(armature: Object, bone: str) -> Floats:
    """(3, 3) the bone's rest orientation in the armature."""
    return np.array(armature.data.bones[bone].matrix_local.to_3x3())


def is_ours(obj: Object | None) -> bool:
    """Whether the object is an armature made by this add-on."""
    return obj is not None and obj.type == "ARMATURE" and MARK in obj.data


def reusable_armature(context: Context) -> Object:
    """The active armature if this add-on made it, else the scene's only one. Raises InputError."""
    candidates = [obj for obj in context.view_layer.objects if is_ours(obj)]
    active = context.view_layer.objects.active
    if active in candidates:
        candidates = [active]
    if not candidates:
        raise InputError('There is no Sparse Mocap armature to reuse: untick "Reuse armature"')
    if len(candidates) > 1:
        raise InputError("There are several Sparse Mocap armatures: select the one for the take")
    return editable(candidates[0])


def select_only(context: Context, obj: Object) -> None:
    """Make the object active and alone selected."""
    for other in filter(None, context.view_layer.objects):  # None: just removed, in 5.2
        other.select_set(other == obj)
    context.view_layer.objects.active = obj


def editable(armature: Object) -> Object:
    """The armature. Raises InputError when it cannot be changed now."""
    name = armature.name
    if armature.library is not None:
        raise InputError(f'"{name}" is linked from another file: make it local first')
    if armature.override_library is not None and armature.override_library.is_system_override:
        raise InputError(
            f'"{name}" is a library override that is not editable: make it editable first'
        )
    animation = armature.animation_data
    if animation is not None and animation.use_tweak_mode:
        raise InputError(f'"{name}" is being tweaked in the NLA editor: leave tweak mode first')
    return armature


def _leave_mode(context: Context) -> None:
    """Object mode; raises InputError when that is not possible now."""
    if context.mode == "OBJECT":
        return
    if not bpy.ops.object.mode_set.poll():
        raise InputError(f"Leave {context.mode.replace('_', ' ').title()} first")
    bpy.ops.object.mode_set(mode="OBJECT")


def _link(context: Context, obj: Object) -> None:
    """Link to the active collection, or the scene's when that one is hidden or linked."""
    collection = context.collection
    if collection is None or collection.library is not None:
        collection = context.scene.collection
    collection.objects.link(obj)
    if not obj.visible_get(view_layer=context.view_layer):
        collection.objects.unlink(obj)
        context.scene.collection.objects.link(obj)
    if obj.name not in context.view_layer.objects:
        raise InputError("New objects are hidden in this view layer: include the scene collection")


def _tail(joint: int, parents: list[int], pivots: Floats, ends: Floats, size: float) -> Floats:
    """Where the joint's bone ends: at its end, or at a made-up one for a joint without length.

    size: of the figure, relative to average height.
    """
    shortest = _SHORTEST_BONE_M * min(size, 1.0)
    if np.linalg.norm(ends[joint] - pivots[joint]) >= shortest:
        return ends[joint]
    parent = parents[joint]
    if parent < 0:
        return pivots[joint] + size * _ROOT_LENGTH_M * _UP
    children = [pivots[child] for child, other in enumerate(parents) if other == joint]
    if children:
        middle = np.mean(children, axis=0)
        if np.linalg.norm(middle - pivots[joint]) >= shortest:
            return middle
    along = pivots[joint] - pivots[parent]
    length = np.linalg.norm(along)
    direction = along / length if length >= shortest else _UP
    return pivots[joint] + size * _LEAF_LENGTH_M * direction


def _add_bones(data: Armature, bones: RestBones, scale: float) -> None:
    """Make the bones; data is in edit mode."""
    made: list[EditBone] = []
    for name, parent, head, tail in zip(
        bones.names,
        bones.parents,
        to_blender(bones.heads) * scale,
        to_blender(bones.tails) * scale,
        strict=True,
    ):
        bone = data.edit_bones.new(name)
        bone.head, bone.tail = head, tail
        bone.align_roll(_FRONT)
        if parent >= 0:
            bone.parent = made[parent]
        made.append(bone)
