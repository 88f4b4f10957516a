# SPDX-License-Identifier: GPL-3.0-or-later
"""The clips of the motion database: preview one, keep it in the scene."""

from collections.abc import Callable

import bpy
from bpy.props import BoolProperty, IntProperty
from bpy.types import Context, Event, Operator

from ..scene import compat
from ..scene.clips import clip_list, fill
from ..scene.preview import first_frame, fit_range, keep, show_clip
from ..scene.settings import settings_of
from ..scene.translations import tr_line
from ..session.database import databases
from ..session.errors import InputError, one_line


class _ClipOperator:
    """Mix-in: calls do() and reports its message, or the error in one line."""

    report: Callable[[set[str], str], None]  # the operator's own

    def do(self, context: Context) -> str:
        """What is asked for; returns one line that says so."""
        raise NotImplementedError

    def execute(self, context: Context) -> set[str]:
        """Call do() and report."""
        try:
            if compat.is_rendering():
                raise InputError("A render is running: wait until it has finished")
            message = self.do(context)
        except Exception as error:
            self.report({"ERROR"}, tr_line(one_line(error)))
            return {"CANCELLED"}
        self.report({"INFO"}, tr_line(message))
        return {"FINISHED"}


class SPARSEMOCAP_OT_preview_clip(_ClipOperator, Operator):
    """Play a clip of the motion database on the preview armature."""

    bl_idname = "sparse_mocap.preview_clip"
    bl_label = "Preview"
    bl_description = "Play the clip in the viewport on a separate preview armature"
    bl_options = {"REGISTER", "UNDO"}

    index: IntProperty(
        name="Clip",
        description="Number in the list; -1: the selected clip",
        default=-1,
        options={"SKIP_SAVE"},
    )
    play: BoolProperty(name="Play", default=True, options={"SKIP_SAVE"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Show the clip and start playback."""
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
            raise InputError(f"There is no clip {index}: the motion database has {len(rows)} clips")
        motion = database.motions.clip_motion(index, extremities=True)
        armature = show_clip(context, motion, rows[index].label)
        clip_list(context).index = index
        return f'Previewing "{rows[index].label}" on "{armature.name}"'


class SPARSEMOCAP_OT_fit_preview_range(_ClipOperator, Operator):
    """Play only the frames of the previewed clip."""

    bl_idname = "sparse_mocap.fit_preview_range"
    bl_label = "Loop Clip"
    bl_description = (
        "Play only this clip in a loop. Sets the preview range, not the scene's frame range"
    )
    bl_options = {"REGISTER", "UNDO"}

    def do(self, context: Context) -> str:
        """Set the preview range."""
        fit_range(context.scene)
        scene = context.scene
        return f"Playback loops frames {scene.frame_preview_start} to {scene.frame_preview_end}"


class SPARSEMOCAP_OT_keep_preview(_ClipOperator, Operator):
    """Keep the previewed clip in the scene as an armature and action."""

    bl_idname = "sparse_mocap.keep_preview"
    bl_label = "Keep"
    bl_description = (
        "Keep this clip as an armature and action. The next preview uses a new armature"
    )
    bl_options = {"REGISTER", "UNDO"}

    def do(self, context: Context) -> str:
        """Rename armature and action, so that the next preview leaves them alone."""
        armature = keep(context)
        return f'Kept "{armature.animation_data.action.name}" on "{armature.name}"'


CLASSES = (
    SPARSEMOCAP_OT_preview_clip,
    SPARSEMOCAP_OT_fit_preview_range,
    SPARSEMOCAP_OT_keep_preview,
)
