# SPDX-License-Identifier: GPL-3.0-or-later
"""The clips of the motion database: preview one, keep it."""

from collections.abc import Callable

import bpy
from bpy.props import BoolProperty, IntProperty
from bpy.types import Context, Event, Operator

from ..scene import compat
from ..scene.clips import clip_list, fill
from ..scene.preview import first_frame, fit_range, keep, show_clip
from ..scene.settings import settings_of
from ..session.database import databases
from ..session.errors import InputError, one_line


class _ClipOperator:
    """Mix-in: does it, or says in one line why not."""

    report: Callable[[set[str], str], None]  # the operator's own

    def do(self, context: Context) -> str:
        """What is asked for; returns one line that says so."""
        raise NotImplementedError

    def execute(self, context: Context) -> set[str]:
        """Do it."""
        try:
            if compat.is_rendering():
                raise InputError("A render is at work: wait for its end")
            message = self.do(context)
        except Exception as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        self.report({"INFO"}, message)
        return {"FINISHED"}


class SPARSEMOCAP_OT_preview_clip(_ClipOperator, Operator):
    """Show a clip of the motion database on the preview armature."""

    bl_idname = "sparse_mocap.preview_clip"
    bl_label = "Preview"
    bl_description = "Play the clip in the viewport, on an armature of its own"
    bl_options = {"REGISTER", "UNDO"}

    index: IntProperty(
        name="Clip", description="-1: the one that is marked", default=-1, options={"SKIP_SAVE"}
    )
    play: BoolProperty(name="Play", default=True, options={"SKIP_SAVE"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Show it and let the timeline run."""
        done = self.execute(context)
        if done == {"FINISHED"} and self.play and not bpy.app.background:
            context.scene.frame_set(first_frame(context.scene))
            if not context.screen.is_animation_playing:
                bpy.ops.screen.animation_play()
        return done

    def do(self, context: Context) -> str:
        """Show the clip."""
        database = databases.get(bpy.path.abspath(settings_of(context.scene).database))
        fill(context)
        index = clip_list(context).index if self.index < 0 else self.index
        rows = database.clips.rows
        if index >= len(rows):
            raise InputError(f"The motion database has {len(rows)} clips, none of number {index}")
        armature = show_clip(context, database.motions.clip_motion(index), rows[index].label)
        clip_list(context).index = index
        return f'"{rows[index].label}" on "{armature.name}"'


class SPARSEMOCAP_OT_fit_preview_range(_ClipOperator, Operator):
    """Play just the frames of the previewed clip."""

    bl_idname = "sparse_mocap.fit_preview_range"
    bl_label = "Loop Clip"
    bl_description = "Play just the frames of the clip: sets the preview range, not the scene's"
    bl_options = {"REGISTER", "UNDO"}

    def do(self, context: Context) -> str:
        """Set the preview range."""
        fit_range(context.scene)
        scene = context.scene
        return f"Plays frames {scene.frame_preview_start} to {scene.frame_preview_end}"


class SPARSEMOCAP_OT_keep_preview(_ClipOperator, Operator):
    """Make the previewed clip your own armature and action."""

    bl_idname = "sparse_mocap.keep_preview"
    bl_label = "Keep"
    bl_description = "Make the previewed clip your own armature and action; no preview changes them"
    bl_options = {"REGISTER", "UNDO"}

    def do(self, context: Context) -> str:
        """Name them and let go of them."""
        armature = keep(context)
        return f'"{armature.animation_data.action.name}" is kept on "{armature.name}"'


CLASSES = (
    SPARSEMOCAP_OT_preview_clip,
    SPARSEMOCAP_OT_fit_preview_range,
    SPARSEMOCAP_OT_keep_preview,
)
