# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows the newest live pose on a character, without keys; its own pose and action come back."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Any

import bpy
import numpy as np
from bpy.types import Context, Object

from ..session import live
from ..session.character import FootLock
from ..session.core import core
from ..session.errors import InputError
from ..session.live_poses import Pose
from ..session.retarget import Target
from ..session.stage import Stage
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
from .axes import Floats, bone_quaternions, to_blender
from .pose_memory import PoseMemory
from .rig_pose import RigPose
from .settings import settings_of
from .targets import bound, foot_lock_of

TICK_S = 0.02
_PANEL_S = 0.25


@dataclass
class _Followed:
    """The character that shows the live poses; by names, since an undo invalidates references."""

    armature: str
    memory: PoseMemory
    skeleton: Any
    figure: Rig | None
    """The add-on's own figure, without its reference."""
    rig: RigPose | None
    """Another character."""
    stage: Stage = field(default_factory=Stage)
    spread_m: Floats = field(default_factory=lambda: np.empty(0))
    """(J,) of the pose that is shown."""
    latent: tuple[int, Floats] | None = None
    """Its type of motion and its place in the latent space of that."""


_followed: _Followed | None = None
_ended = ""
_next_panel_s = 0.0


def ended_because() -> str:
    """Why the live preview ended by itself; empty when it did not."""
    return _ended


def stage() -> Stage | None:
    """Where the live character stands; None without one."""
    return _followed.stage if _followed is not None else None


def follow(context: Context, skeleton: Any) -> Object:
    """Choose or make the character for the live preview and take its action off.

    Raises InputError; nothing is changed then.
    """
    global _followed, _ended
    leave()
    chosen = settings_of(context.scene).target
    figure, target = None, None
    if chosen is not None and not is_ours(chosen):
        armature = editable(chosen)
        target = bound(context, armature)
    else:
        rig = rig_of(editable(chosen), skeleton) if chosen else _figure(context, skeleton)
        armature = rig.armature
        figure = Rig(None, rig.bones, rig.units_per_metre)
    memory = PoseMemory.of(armature)
    memory.take_off()
    if figure is not None:
        use_quaternions(armature)
    rig_pose = RigPose(target) if target is not None else None
    if rig_pose is not None:
        rig_pose.begin(armature)
    _followed = _Followed(armature.name, memory, skeleton, figure, rig_pose)
    _ended = ""
    ensure_ticking()
    return armature


def spread_m(armature: Object) -> Floats | None:
    """(J,) how far retrieved poses deviate from the live one; None if that is on another one."""
    if _followed is None or _followed.armature != armature.name:
        return None
    return _followed.spread_m


def latent_now() -> tuple[int, Floats] | None:
    """The live pose's type of motion and its place in the latent space; None without one."""
    return _followed.latent if _followed is not None else None


def target_of(armature: Object) -> Target | None:
    """How the followed character is moved, if it is this one and not the add-on's own figure."""
    if _followed is None or _followed.armature != armature.name or _followed.rig is None:
        return None
    return _followed.rig.target


def leave(reason: str = "") -> None:
    """Give the character its own pose and action back; reason: why the preview ended by itself."""
    global _followed, _ended
    left, _followed = _followed, None
    if left is not None:
        _ended = reason
        left.memory.put_back()


def followed() -> Object | None:
    """The character that shows the live poses; None when it is gone."""
    armature = bpy.data.objects.get(_followed.armature) if _followed is not None else None
    if armature is None or armature.type != "ARMATURE" or armature.library is not None:
        return None
    return armature


def before_save() -> None:
    """Let the file be saved with the character's own pose and action."""
    if _followed is not None:
        _followed.memory.put_back()


def after_save() -> None:
    """Show the live poses again."""
    if _followed is not None:
        _followed.memory.take_off()
        armature = followed()
        if armature is not None and _followed.rig is not None:
            _followed.rig.begin(armature)


def ensure_ticking() -> None:
    """Call tick() regularly while a session is running."""
    if not bpy.app.timers.is_registered(_tick_or_end):
        bpy.app.timers.register(_tick_or_end, first_interval=TICK_S)


def stop_ticking() -> None:
    """Remove the timer and end the preview."""
    leave()
    if bpy.app.timers.is_registered(_tick_or_end):
        bpy.app.timers.unregister(_tick_or_end)


def tick() -> Pose | None:
    """Apply the newest pose to the character and return it; None when there is no new one."""
    session = live.current()
    if _followed is None or compat.is_rendering():
        return None
    if session is None or not session.is_running or not session.is_live_wanted:
        leave()
        return None
    armature = followed()
    problem = _problem(armature)
    if armature is None or problem:
        session.leave_live()
        leave(problem)
        return None
    if armature.mode == "EDIT":
        return None
    pose = session.newest_pose()
    if pose is None:
        return None
    _followed.spread_m = pose.spread_m
    _followed.latent = (pose.motion_type, pose.latent) if len(pose.latent) else None
    in_place = settings_of(bpy.context.scene).in_place
    shown = _followed.stage.shown(pose, in_place=in_place)
    if _followed.rig is not None:
        lock = FootLock(strength=0.0) if in_place else foot_lock_of(bpy.context)
        _followed.rig.show(armature, _motion(_followed.skeleton, shown), shown, lock)
    elif _followed.figure is not None:
        _show(armature, _followed.figure, shown)
    return pose


def _problem(armature: Object | None) -> str:
    """Why the preview cannot continue on the character; empty when it can."""
    if _followed is None or armature is None:
        return "Live preview ended: its character is gone"
    if armature.animation_data is not None and armature.animation_data.action is not None:
        return f'Live preview ended: "{armature.name}" was given an action'
    names = _followed.rig.bones if _followed.rig is not None else []
    if _followed.figure is not None:
        names = _followed.figure.bones
    if armature.mode != "EDIT":
        missing = next((name for name in names if name not in armature.pose.bones), "")
        if missing:
            return f'Live preview ended: "{armature.name}" has no bone "{missing}" any more'
    return ""


def _figure(context: Context, skeleton: Any) -> Rig:
    """The add-on's own figure in the scene if there is one that fits, else a new one."""
    try:
        return rig_of(reusable_armature(context), skeleton)
    except InputError:  # there is none that fits
        return new_armature(context, skeleton)


def _motion(skeleton: Any, pose: Pose) -> Any:
    return core().Motion(skeleton, 1.0, pose.root_position[None], pose.rotations[None])


def _tick_or_end() -> float | None:
    global _next_panel_s
    session = live.current()
    if session is None:
        leave()
        return None
    pose = tick()
    if pose is not None or time.perf_counter() >= _next_panel_s or not session.is_running:
        _next_panel_s = time.perf_counter() + _PANEL_S
        compat.redraw_views(bpy.context)
    return TICK_S if session.is_running else None


def _show(armature: Object, figure: Rig, pose: Pose) -> None:
    bones = armature.data.bones
    for joint, name in enumerate(figure.bones):
        rest = np.array(bones[name].matrix_local.to_3x3())
        posed = armature.pose.bones[name]
        posed.rotation_quaternion = bone_quaternions(pose.rotations[joint], rest)
        if joint == 0:
            head = np.array(bones[name].head_local)
            posed.location = (to_blender(pose.root_position) * figure.units_per_metre - head) @ rest
