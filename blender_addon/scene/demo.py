# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene of a first try: a performer with simulated sensors beside a character."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any

import addon_utils
import bpy
import numpy as np
from bpy.types import Context, Material, Object
from mathutils import Euler, Vector

from ..session.steps import Steps
from .action import action_steps
from .armature import new_armature, select_only, units_per_metre
from .axes import to_blender
from .body import new_body
from .compat import assign_action

CHARACTER, PERFORMER = "Character", "Simulated Performer"
_ASIDE_M = 1.2
_ORANGE, _BLUE = (0.85, 0.27, 0.03, 1.0), (0.16, 0.27, 0.42, 1.0)
_KINDS = ("objects", "armatures", "meshes", "collections", "texts", "actions", "materials")
_RIGIFY = "rigify"
_MARGIN_M = 1.2  # around the performance, in the view
_FROM_THE_FRONT = Euler((math.radians(78.0), 0.0, math.radians(12.0)))


@contextmanager
def nothing_left_on_error() -> Iterator[None]:
    """Remove all new data from the file when the work within fails or is stopped."""
    before = {kind: {item.name for item in getattr(bpy.data, kind)} for kind in _KINDS}
    try:
        yield
    except BaseException:
        for kind, names in before.items():
            items = getattr(bpy.data, kind)
            for item in [item for item in items if item.name not in names]:
                with suppress(ReferenceError):  # it went with another one
                    items.remove(item)
        raise


def rigify_character(context: Context) -> Object | None:
    """A new Rigify rig with a body, active and alone selected; None in a Blender without Rigify.

    Raises RuntimeError when Rigify reports an error.
    """
    if context.mode != "OBJECT" and bpy.ops.object.mode_set.poll():
        bpy.ops.object.mode_set(mode="OBJECT")
    with _rigify() as is_there:
        if not is_there:
            return None
        bpy.ops.object.armature_basic_human_metarig_add()
        metarig = context.view_layer.objects.active
        metarig.location = (0.0, 0.0, 0.0)
        bpy.ops.pose.rigify_generate()
        character, bones = context.view_layer.objects.active, metarig.data
        bpy.data.objects.remove(metarig)
        bpy.data.armatures.remove(bones)
    character.name = CHARACTER
    new_body(context, character, _material(CHARACTER, _ORANGE))
    character.show_in_front = False
    select_only(context, character)
    return character


def performer_steps(context: Context, performed: Any, start_frame: float) -> Steps[Object]:
    """The performer's figure beside the character, with what it did (sparse_mocap.Motion)."""
    render = context.scene.render
    motion = performed.resampled(render.fps / render.fps_base)
    rig = new_armature(context, motion.skeleton, PERFORMER, is_reusable=False)
    name = rig.armature.name
    frames = start_frame + np.arange(motion.num_frames, dtype=np.float64)
    action = yield from action_steps(PERFORMER, rig, motion, frames)
    armature = bpy.data.objects[name]
    assign_action(armature, action)
    armature.location.x = -_ASIDE_M * units_per_metre(context.scene)
    armature.show_in_front = False
    new_body(context, armature, _material(PERFORMER, _BLUE))
    return armature


def look_at(context: Context, performed: Any) -> None:
    """Turn the 3D view, if the operator was called in one, to where the performance is."""
    view = getattr(context.space_data, "region_3d", None)
    if view is None:
        return
    scale = units_per_metre(context.scene)
    places = to_blender(np.asarray(performed.root_positions)) * scale
    lowest, highest = places.min(axis=0), places.max(axis=0)
    view.view_perspective, view.view_rotation = "PERSP", _FROM_THE_FRONT.to_quaternion()
    view.view_location = Vector((lowest + highest) / 2.0) - Vector((0.5 * _ASIDE_M * scale, 0, 0))
    view.view_distance = float(np.linalg.norm((highest - lowest)[:2])) + 2.0 * _MARGIN_M * scale


def _material(name: str, colour: tuple[float, float, float, float]) -> Material:
    material = bpy.data.materials.new(name)
    material.diffuse_color = colour
    return material


@contextmanager
def _rigify() -> Iterator[bool]:
    """Rigify enabled; whether this Blender has it. It is disabled again if it was."""
    _, was_enabled = addon_utils.check(_RIGIFY)
    is_there = was_enabled or addon_utils.enable(_RIGIFY, default_set=True) is not None
    try:
        yield is_there
    finally:
        if is_there and not was_enabled:
            addon_utils.disable(_RIGIFY, default_set=True)
