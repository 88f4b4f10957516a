# SPDX-License-Identifier: GPL-3.0-or-later
"""Which joint is which: remembered for a skeleton, saved to a file and read from one."""

from collections.abc import Callable

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy.types import Context, Event, Operator

from ..scene.mapping import show_joints, show_mapping, shown_joints
from ..session import mapping
from ..session.errors import one_line

SKIP = {"HIDDEN", "SKIP_SAVE"}


class _MappingOperator:
    """Mix-in: does it, or says in one line why not."""

    report: Callable[[set[str], str], None]  # the operator's own

    def do(self, context: Context) -> str:
        """What is asked for; returns one line that says so."""
        raise NotImplementedError

    def execute(self, context: Context) -> set[str]:
        """Do it."""
        try:
            message = self.do(context)
        except Exception as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        self.report({"INFO"}, message)
        return {"FINISHED"}


class _FileOperator(_MappingOperator):
    """Mix-in: asks for a file first."""

    filepath: StringProperty(name="File", subtype="FILE_PATH", options={"SKIP_SAVE"})
    filter_glob: StringProperty(default=f"*{mapping.SUFFIX}", options=SKIP)

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Let the animator choose the file."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}


class SPARSEMOCAP_OT_remember_mapping(_MappingOperator, Operator):
    """Use these joints for every file with this skeleton."""

    bl_idname = "sparse_mocap.remember_mapping"
    bl_label = "Remember"
    bl_description = "Use these joints for every file with this skeleton from now on"
    bl_options = {"REGISTER"}

    def do(self, context: Context) -> str:
        """Keep the rows."""
        found = mapping.remember(shown_joints(context))
        show_mapping(context, found)
        return f'Remembered for skeletons like that of "{found.name}"'


class SPARSEMOCAP_OT_forget_mapping(_MappingOperator, Operator):
    """Find the joints of this skeleton by their names and places again."""

    bl_idname = "sparse_mocap.forget_mapping"
    bl_label = "Forget"
    bl_description = "Find the joints of this skeleton by their names and places again"
    bl_options = {"REGISTER"}

    def do(self, context: Context) -> str:
        """Forget what was remembered."""
        show_mapping(context, mapping.forget())
        return "The joints are found by their names and places again"


class SPARSEMOCAP_OT_save_mapping(_FileOperator, Operator):
    """Save these joints to a file."""

    bl_idname = "sparse_mocap.save_mapping"
    bl_label = "Save Mapping"
    bl_description = "Save these joints to a .json file"
    bl_options = {"REGISTER"}

    check_existing: BoolProperty(default=True, options=SKIP)

    def do(self, context: Context) -> str:
        """Write the file."""
        path = mapping.save(bpy.path.abspath(self.filepath), shown_joints(context))
        return f"Saved {path}"


class SPARSEMOCAP_OT_load_mapping(_FileOperator, Operator):
    """Read the joints from a file."""

    bl_idname = "sparse_mocap.load_mapping"
    bl_label = "Load Mapping"
    bl_description = "Read the joints from a .json file"
    bl_options = {"REGISTER"}

    def do(self, context: Context) -> str:
        """Show what the file says; it is used once it is remembered."""
        show_joints(context, mapping.load(bpy.path.abspath(self.filepath)))
        return "Loaded; Remember uses it"


CLASSES = (
    SPARSEMOCAP_OT_remember_mapping,
    SPARSEMOCAP_OT_forget_mapping,
    SPARSEMOCAP_OT_save_mapping,
    SPARSEMOCAP_OT_load_mapping,
)
