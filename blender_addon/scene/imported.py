# SPDX-License-Identifier: GPL-3.0-or-later
"""Imported motion files in the scene: an armature and an action for each."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.types import Action, Context, Object

from ..session.imported import LoadedMotion
from ..session.steps import Steps, part
from .action import action_steps, frames_of
from .armature import new_armature, remove_armature, select_only, selection_back_on_error
from .compat import assign_action


def import_steps(
    context: Context,
    motions: list[LoadedMotion],
    start_frame: float,
    *,
    keeps_timing: bool,
) -> Steps[list[Object]]:
    """The new armatures, the last one active and alone selected.

    keeps_timing: place the keys at the file's times; otherwise each of the file's frames becomes
    one scene frame. Raises InputError or ValueError; the scene is then unchanged, also when the
    steps are closed early.
    """
    made: list[Object] = []
    actions: list[Action] = []
    share = 1.0 / len(motions)
    with selection_back_on_error(context):
        try:
            for motion in motions:
                rig = new_armature(
                    context,
                    motion.skeleton,
                    motion.name,
                    is_figure=motion.is_standard,
                    is_reusable=motion.is_standard,
                )
                made.append(rig.armature)
                yield (len(made) - 1) * share
                if motion.num_frames == 0:
                    continue
                times_s = np.arange(motion.num_frames) * motion.frame_time_s
                frames = frames_of(context.scene, times_s, start_frame)
                if not keeps_timing:
                    frames = start_frame + np.arange(motion.num_frames, dtype=np.float64)
                steps = action_steps(motion.name, rig, motion, frames)
                actions.append((yield from part(steps, (len(made) - 1) * share, share)))
                assign_action(rig.armature, actions[-1])
        except BaseException:
            for armature in made:
                remove_armature(armature)
            remove_actions(actions)
            raise
    select_only(context, made[-1])
    return made


def remove_actions(actions: list[Action]) -> None:
    """Remove the actions that are still in the file."""
    for action in actions:
        try:
            bpy.data.actions.remove(action)
        except ReferenceError:  # already removed by an undo
            continue
