# SPDX-License-Identifier: GPL-3.0-or-later
"""A reconstructed take in the scene: an action on an armature."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields

import numpy as np
from bpy.types import Action, Context, Object

from ..session.reconstruct import Performance
from ..session.steps import Steps
from .action import action_steps, frames_of
from .armature import (
    is_ours,
    new_armature,
    remove_armature,
    reusable_armature,
    rig_of,
    select_only,
    selection_back_on_error,
    use_quaternions,
)
from .compat import assign_action

_FACTS = "sparse_mocap"  # custom property of actions that this add-on made


@dataclass(frozen=True)
class Facts:
    """What the panel shows of an action."""

    duration_s: float
    match: str
    is_guess: bool


def perform_steps(
    context: Context, performance: Performance, start_frame: float, *, reuse: bool
) -> Steps[Object]:
    """The armature with the take's action, active and alone selected; a new one unless reuse.

    Raises InputError or ValueError; the scene is then unchanged, also when closed early.
    """
    motion = performance.motion
    times_s = np.arange(motion.num_frames) * motion.frame_time_s
    frames = frames_of(context.scene, times_s, start_frame)
    with selection_back_on_error(context):
        if reuse:
            rig = rig_of(reusable_armature(context), motion.skeleton)
        else:
            rig = new_armature(context, motion.skeleton)
        try:
            action = yield from action_steps(performance.name, rig, motion, frames)
        except BaseException:
            if not reuse:
                remove_armature(rig.armature)
            raise
    armature = rig.armature
    facts = Facts(performance.duration_s, performance.match, performance.is_guess)
    action[_FACTS] = asdict(facts)
    use_quaternions(armature)
    assign_action(armature, action)
    select_only(context, armature)
    return armature


def facts_of(action: Action) -> Facts | None:
    """The facts stored with the action, if this add-on made it."""
    values = action.get(_FACTS)
    if not hasattr(values, "to_dict"):
        return None
    known = values.to_dict()
    if known.keys() != {field.name for field in fields(Facts)}:
        return None  # another version's
    return Facts(**known)


def performed_action(obj: Object | None) -> Action | None:
    """The action that a Sparse Mocap armature plays."""
    if obj is None or not is_ours(obj) or obj.animation_data is None:
        return None
    return obj.animation_data.action
