# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview of a database clip on a separate armature, until it is kept."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from bpy.types import Action, Context, Object, Scene

from ..session.errors import InputError
from .action import frames_of, make_action
from .armature import (
    MARK,
    editable,
    new_armature,
    remove_armature,
    rig_of,
    select_only,
    selection_back_on_error,
)
from .compat import assign_action

NAME = "Clip Preview"
_MARK = "sparse_mocap_preview"  # custom property: of the armature, and of its action


def preview_armature(scene: Scene) -> Object | None:
    """The scene's preview armature."""
    for obj in scene.objects:
        if obj.type == "ARMATURE" and _MARK in obj.data and obj.data.library is None:
            return obj
    return None


def show_clip(context: Context, motion: Any, name: str) -> Object:
    """Play the clip on the preview armature, which is created unless a fitting one exists.

    The clip starts at the scene's first frame. Raises InputError or ValueError; the scene is then
    unchanged.
    """
    old = preview_armature(context.scene)
    with selection_back_on_error(context):
        rig, is_new = None, False
        if old is not None:
            try:
                rig = rig_of(editable(old), motion.skeleton)
            except InputError:  # made for another database
                rig = None
        if rig is None:
            rig, is_new = new_armature(context, motion.skeleton, NAME, is_reusable=False), True
        times_s = np.arange(motion.num_frames) * motion.frame_time_s
        try:
            frames = frames_of(context.scene, times_s, float(first_frame(context.scene)))
            action = make_action(f"{NAME}: {name}", rig, motion, frames)
        except Exception:
            if is_new:
                remove_armature(rig.armature)
            raise
    armature = rig.armature
    _forget_action(old)
    if is_new and old is not None:
        remove_armature(old)
        armature.name = armature.data.name = NAME
    action.use_fake_user = False
    action[_MARK] = armature.data[_MARK] = name
    assign_action(armature, action)
    select_only(context, armature)
    return armature


def keep(context: Context) -> Object:
    """Keep the preview in the scene, armature and action named like the clip."""
    armature = preview_armature(context.scene)
    action = preview_action(armature)
    if armature is None or action is None:
        raise InputError("There is no preview to keep: preview a clip first")
    name = action[_MARK]
    action.use_fake_user = True
    action.name = armature.name = armature.data.name = name
    del action[_MARK]
    del armature.data[_MARK]
    armature.data[MARK] = ",".join(armature.data.bones.keys())
    select_only(context, armature)
    return armature


def preview_action(armature: Object | None) -> Action | None:
    """The action of the previewed clip."""
    data = armature.animation_data if armature is not None else None
    action = data.action if data is not None else None
    return action if action is not None and _MARK in action else None


def clip_in_preview(scene: Scene) -> str:
    """The name of the previewed clip; empty without one."""
    action = preview_action(preview_armature(scene))
    return "" if action is None else str(action[_MARK])


def first_frame(scene: Scene) -> int:
    """The first frame of the scene's playback."""
    return scene.frame_preview_start if scene.use_preview_range else scene.frame_start


def fit_range(scene: Scene) -> None:
    """Set the preview range to the clip; the scene's frame range stays."""
    action = preview_action(preview_armature(scene))
    if action is None:
        raise InputError("There is no preview: preview a clip first")
    first, last = action.frame_range
    scene.use_preview_range = True
    scene.frame_preview_start, scene.frame_preview_end = int(first), int(np.ceil(last))


def _forget_action(armature: Object | None) -> None:
    action = preview_action(armature)
    if action is not None:
        bpy.data.actions.remove(action)
