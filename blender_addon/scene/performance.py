# SPDX-License-Identifier: GPL-3.0-or-later
"""A reconstructed take put into the scene: one action on one armature."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields

import bpy
import numpy as np
from bpy.types import Action, Context, Object

from ..session.reconstruct import Performance
from .action import frames_of, make_action
from .armature import is_ours, new_armature, reusable_armature, select_only, use_quaternions
from .compat import assign_action

_FACTS = "sparse_mocap"  # custom property of actions that this add-on made


@dataclass(frozen=True)
class Facts:
    """What the panel tells of an action."""

    duration_s: float
    misfit_mps2: float
    is_guess: bool


def perform(
    context: Context, performance: Performance, start_frame: float, *, reuse: bool
) -> Object:
    """The armature that performs the take, active and alone selected; a new one unless reuse.

    Raises InputError or ValueError; the scene is as it was then.
    """
    motion = performance.motion
    times_s = np.arange(motion.num_frames) * motion.frame_time_s
    frames = frames_of(context.scene, times_s, start_frame)
    armature = reusable_armature(context) if reuse else new_armature(context, motion.skeleton)
    try:
        action = make_action(performance.name, armature, motion, frames)
    except Exception:
        if not reuse:
            data = armature.data
            bpy.data.objects.remove(armature)
            bpy.data.armatures.remove(data)
        raise
    facts = Facts(performance.duration_s, performance.misfit_mps2, performance.is_guess)
    action[_FACTS] = asdict(facts)
    use_quaternions(armature)
    assign_action(armature, action)
    select_only(context, armature)
    return armature


def facts_of(action: Action) -> Facts | None:
    """What is known of the action, if this add-on made it."""
    values = action.get(_FACTS)
    if not hasattr(values, "to_dict"):
        return None
    known = values.to_dict()
    if known.keys() != {field.name for field in fields(Facts)}:
        return None  # another version's
    return Facts(**known)


def performed_action(obj: Object | None) -> Action | None:
    """The action that a Sparse Mocap armature plays."""
    if not is_ours(obj) or obj.animation_data is None:
        return None
    return obj.animation_data.action
