# SPDX-License-Identifier: GPL-3.0-or-later
"""What is done with a take's action: updated, compared, put into the NLA."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import StringProperty
from bpy.types import Action, Context, Operator

from ..scene.armature import editable
from ..scene.compat import assign_action
from ..scene.ghost import hide_ghost, show_ghost
from ..scene.nla import push_to_nla
from ..scene.performance import (
    alternatives_of,
    facts_of,
    perform_steps,
    performed_action,
    replace_actions,
)
from ..scene.settings import settings_of
from ..scene.targets import own_figure, placement_of
from ..session.bake import PlacedTake, place_job
from ..session.errors import InputError
from ..session.job import Job
from ..session.match import poor_parts
from ..session.reconstruct import kept
from ..session.steps import Steps
from .job_operator import JobOperator
from .live import leave_live
from .now_operator import NowOperator


def _action(context: Context) -> Action:
    """The take's action of the active character. Raises InputError."""
    action = performed_action(context.view_layer.objects.active)
    if action is None or facts_of(action) is None:
        raise InputError("Select a character that plays a take first")
    return action


class SPARSEMOCAP_OT_update_action(JobOperator, Operator):
    """Put the take on the character again with these settings, without reconstructing it."""

    bl_idname = "sparse_mocap.update_action"
    bl_label = "Update Action"
    bl_description = (
        "Put the take on the active character again with the settings above, without "
        "reconstructing it: foot lock, limbs, part, smoothing, keys"
    )
    bl_options = {"REGISTER", "UNDO"}

    _figure = ""
    _names: dict[str, str]

    def prepare(self, context: Context) -> Job:
        """Use the take's last result."""
        action = _action(context)
        facts, settings = facts_of(action), settings_of(context.scene)
        performance = kept(facts.take) if facts is not None else None
        if performance is None:
            raise InputError("The take's result is from an earlier session: press Reconstruct")
        armature = editable(context.view_layer.objects.active)
        self._names = {armature.name: action.name}
        figure = own_figure([armature])
        self._figure = figure.name if figure is not None else ""
        placement = placement_of(
            context,
            [armature],
            start_frame=settings.start_frame,
            whole_frames=settings.whole_frames,
        )
        return place_job(performance, placement)

    def apply(self, context: Context, result: PlacedTake) -> Steps[str]:
        """Replace the action."""
        leave_live()
        armature: Any = yield from perform_steps(
            context, result, bpy.data.objects.get(self._figure)
        )
        replace_actions(self._names)
        return f'"{armature.animation_data.action.name}" is up to date'


class SPARSEMOCAP_OT_push_to_nla(NowOperator, Operator):
    """Put the character's take into the NLA, as a strip of its own."""

    bl_idname = "sparse_mocap.push_to_nla"
    bl_label = "Push to NLA"
    bl_description = "Put the active character's take into the NLA, as a strip on a new track"
    bl_options = {"REGISTER", "UNDO"}

    def act(self, context: Context) -> str:
        """Make the strip."""
        action = _action(context)
        push_to_nla(editable(context.view_layer.objects.active), action)
        return f'"{action.name}" is a strip in the NLA'


class SPARSEMOCAP_OT_compare(NowOperator, Operator):
    """Play another action on a ghost of the character."""

    bl_idname = "sparse_mocap.compare"
    bl_label = "Compare"
    bl_description = "Play another action on a ghost of the active character, to compare them"
    bl_options = {"REGISTER", "UNDO"}

    action: StringProperty(name="Action", options={"SKIP_SAVE"})

    def invoke(self, context: Context, _: Any) -> set[str]:
        """Ask for the action."""
        return context.window_manager.invoke_props_dialog(self)

    def draw(self, context: Context) -> None:
        """The choice."""
        self.layout.prop_search(self, "action", bpy.data, "actions")

    def act(self, context: Context) -> str:
        """Show the ghost."""
        _action(context)
        action = bpy.data.actions.get(self.action)
        if action is None:
            raise InputError("Choose the action to compare with")
        ghost = show_ghost(context, context.view_layer.objects.active, action)
        return f'"{ghost.name}" plays "{action.name}"'


class SPARSEMOCAP_OT_show_alternative(NowOperator, Operator):
    """Let the character play another motion that fits the take."""

    bl_idname = "sparse_mocap.show_alternative"
    bl_label = "Show Alternative"
    bl_description = (
        "Play this motion of the take on the active character: A is the best guess, B and C fit "
        "the sensors almost as well"
    )
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    letter: StringProperty(name="Letter", default="A", options={"SKIP_SAVE"})

    def act(self, context: Context) -> str:
        """Assign its action."""
        other = alternatives_of(_action(context)).get(self.letter)
        if other is None:
            raise InputError(
                f"This take has no alternative {self.letter}: "
                "tick Alternatives and press Reconstruct"
            )
        armature = editable(context.view_layer.objects.active)
        assign_action(armature, other)
        return f'"{armature.name}" plays "{other.name}"'


class SPARSEMOCAP_OT_stop_comparing(NowOperator, Operator):
    """Remove the ghost."""

    bl_idname = "sparse_mocap.stop_comparing"
    bl_label = "Stop Comparing"
    bl_description = "Remove the ghost of the active character"
    bl_options = {"REGISTER", "UNDO"}

    def act(self, context: Context) -> str:
        """Remove it."""
        armature = context.view_layer.objects.active
        if armature is None or not hide_ghost(context, armature):
            raise InputError("The active object has no ghost")
        return "The ghost is removed"


class SPARSEMOCAP_OT_next_poor_part(NowOperator, Operator):
    """Go to where the next part with a poor match begins."""

    bl_idname = "sparse_mocap.next_poor_part"
    bl_label = "Next Poor Part"
    bl_description = "Go to the frame where the next part with a poor match begins"
    bl_options = {"INTERNAL"}

    def act(self, context: Context) -> str:
        """Move the playhead; after the last part comes the first."""
        facts = facts_of(_action(context))
        parts = poor_parts(facts.seconds.split()) if facts is not None else []
        if facts is None or not parts:
            raise InputError("No part of this take has a poor match")
        scene = context.scene
        frames = [round(facts.frame_at(begin)) for begin, _ in parts]
        number = next((i for i, frame in enumerate(frames) if frame > scene.frame_current), 0)
        scene.frame_set(frames[number])
        begin_s, end_s = parts[number]
        return f"Poor from {begin_s} to {end_s} s of the take"


CLASSES = (
    SPARSEMOCAP_OT_update_action,
    SPARSEMOCAP_OT_next_poor_part,
    SPARSEMOCAP_OT_show_alternative,
    SPARSEMOCAP_OT_push_to_nla,
    SPARSEMOCAP_OT_compare,
    SPARSEMOCAP_OT_stop_comparing,
)
