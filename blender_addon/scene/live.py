# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows the newest live pose on an armature, without keys and without other changes."""

from __future__ import annotations

import time
from typing import Any

import bpy
import numpy as np
from bpy.types import Context, Object

from ..session import live
from ..session.errors import InputError
from ..session.live_poses import Pose
from . import compat
from .armature import (
    Rig,
    editable,
    is_ours,
    new_armature,
    reusable_armature,
    rig_of,
    use_quaternions,
)
from .axes import bone_quaternions, to_blender

TICK_S = 0.02
_PANEL_S = 0.25

_target = ""  # the armature's name, since an undo invalidates references
_bones: list[str] = []
_units_per_metre = 1.0
_next_panel_s = 0.0


def live_rig(context: Context, skeleton: Any) -> Rig:
    """The armature for the live preview: the existing one if it fits, else a new one.

    Its action, if any, is unassigned and stays in the file. Raises InputError.
    """
    rig = None
    try:
        armature = reusable_armature(context)
        if armature.animation_data is None or not armature.animation_data.nla_tracks:
            rig = rig_of(armature, skeleton)
    except InputError:  # there is none that fits
        rig = None
    if rig is None:
        rig = new_armature(context, skeleton)
    armature = editable(rig.armature)
    data = armature.animation_data
    if data is not None and data.action is not None:
        data.action.use_fake_user = True
        data.action = None
    use_quaternions(armature)
    return rig


def follow(rig: Rig) -> None:
    """Show the live poses on this armature."""
    global _target, _units_per_metre
    _target, _bones[:] = rig.armature.name, rig.bones
    _units_per_metre = rig.units_per_metre
    ensure_ticking()


def followed() -> Object | None:
    """The armature that shows the live poses; None when it is gone."""
    armature = bpy.data.objects.get(_target) if _target else None
    if armature is None or not is_ours(armature) or armature.library is not None:
        return None
    return armature


def ensure_ticking() -> None:
    """Call tick() regularly while a session is running."""
    if not bpy.app.timers.is_registered(_tick_or_end):
        bpy.app.timers.register(_tick_or_end, first_interval=TICK_S)


def stop_ticking() -> None:
    """Remove the timer."""
    global _target
    _target = ""
    if bpy.app.timers.is_registered(_tick_or_end):
        bpy.app.timers.unregister(_tick_or_end)


def tick() -> Pose | None:
    """Apply the newest pose to the armature and return it; None when there is no new one."""
    session = live.current()
    if session is None or not session.is_live_wanted or compat.is_rendering():
        return None
    armature = followed()
    if armature is None:  # deleted, or undone
        session.leave_live()
        return None
    if armature.mode == "EDIT":
        return None
    pose = session.newest_pose()
    if pose is not None:
        _show(armature, pose)
    return pose


def _tick_or_end() -> float | None:
    global _next_panel_s
    session = live.current()
    if session is None:
        return None
    pose = tick()
    if pose is not None or time.perf_counter() >= _next_panel_s or not session.is_running:
        _next_panel_s = time.perf_counter() + _PANEL_S
        compat.redraw_views(bpy.context)
    return TICK_S if session.is_running else None


def _show(armature: Object, pose: Pose) -> None:
    bones = armature.data.bones
    if any(name not in bones for name in _bones):
        return  # its bones were changed
    for joint, name in enumerate(_bones):
        rest = np.array(bones[name].matrix_local.to_3x3())
        posed = armature.pose.bones[name]
        posed.rotation_quaternion = bone_quaternions(pose.rotations[joint], rest)
        if joint == 0:
            head = np.array(bones[name].head_local)
            posed.location = (to_blender(pose.root_position) * _units_per_metre - head) @ rest
