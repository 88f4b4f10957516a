# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 2: choose a recorded take."""

import bpy
from bpy.props import StringProperty
from bpy.types import Context, Event, Operator

from ..scene.settings import settings_of
from ..session.errors import one_line
from ..session.take import SUFFIX, takes


class SPARSEMOCAP_OT_load_take(Operator):
    """Load a recorded take (.csv)."""

    bl_idname = "sparse_mocap.load_take"
    bl_label = "Load Take"
    bl_description = "Load a recorded take (.csv)"
    bl_options = {"REGISTER", "UNDO"}

    filepath: StringProperty(name="File", subtype="FILE_PATH", options={"SKIP_SAVE"})
    filter_glob: StringProperty(default=f"*{SUFFIX}", options={"HIDDEN", "SKIP_SAVE"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Open the file browser."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        """Read the file; remember its path if it is a take."""
        try:
            take = takes.get(bpy.path.abspath(self.filepath))
        except Exception as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        settings_of(context.scene).take = self.filepath
        self.report(
            {"INFO"}, f"Loaded a take of {len(take.sensors)} sensors, {take.duration_s:.1f} s"
        )
        return {"FINISHED"}


CLASSES = (SPARSEMOCAP_OT_load_take,)
