# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 1: choose a motion database or build one."""

from typing import Any

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy.types import Context, Event, Operator

from ..scene.settings import settings_of
from ..session.database import SUFFIX, build_job, checked_output, databases, default_output
from ..session.errors import one_line
from ..session.job import Job
from ..session.steps import Steps
from .job_operator import JobOperator

SKIP = {"SKIP_SAVE"}


class SPARSEMOCAP_OT_open_database(Operator):
    """Choose the motion database to draw poses from."""

    bl_idname = "sparse_mocap.open_database"
    bl_label = "Open Motion Database"
    bl_description = "Choose the motion database to draw poses from"
    bl_options = {"REGISTER", "UNDO"}

    filepath: StringProperty(name="File", subtype="FILE_PATH", options=SKIP)
    filter_glob: StringProperty(default=f"*{SUFFIX}", options={"HIDDEN", "SKIP_SAVE"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Let the animator choose the file."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        """Open the file; keep its name if it is a database."""
        try:
            databases.get(bpy.path.abspath(self.filepath))
        except Exception as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        settings_of(context.scene).database = self.filepath
        return {"FINISHED"}


class SPARSEMOCAP_OT_choose_output(Operator):
    """Choose where the new motion database is written."""

    bl_idname = "sparse_mocap.choose_output"
    bl_label = "Save Motion Database As"
    bl_description = "Choose where the new motion database is written"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    filepath: StringProperty(name="File", subtype="FILE_PATH", options=SKIP)
    filter_glob: StringProperty(default=f"*{SUFFIX}", options={"HIDDEN", "SKIP_SAVE"})
    check_existing: BoolProperty(default=True, options={"HIDDEN", "SKIP_SAVE"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Let the animator choose the file."""
        settings = settings_of(context.scene)
        self.filepath = settings.output or default_output(bpy.path.abspath(settings.source))
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        """Keep the file's name if a file can be there."""
        try:
            path = checked_output(bpy.path.abspath(self.filepath))
        except Exception as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        settings_of(context.scene).output = path
        return {"FINISHED"}


class SPARSEMOCAP_OT_build_database(JobOperator, Operator):
    """Read all motion files of the folder into one motion database."""

    bl_idname = "sparse_mocap.build_database"
    bl_label = "Build Motion Database"
    bl_description = "Read all motion files of the folder into one motion database"
    bl_options = {"REGISTER", "UNDO"}

    source: StringProperty(
        name="Folder", description="Folder with motion files", subtype="DIR_PATH", options=SKIP
    )
    filepath: StringProperty(
        name="Save as", description="The .smdb file to write", subtype="FILE_PATH", options=SKIP
    )
    mirror: BoolProperty(
        name="Mirror", description="Add every motion mirrored as well", options=SKIP
    )
    exclude: StringProperty(
        name="Leave out", description="File names, separated by commas", options=SKIP
    )

    def prepare(self, context: Context) -> Job:
        """Build from the folder that is given or set in the scene."""
        self.take_from_panel(context, "source", "mirror", "exclude")
        if not self.filepath:
            self.filepath = settings_of(context.scene).output
        job, self._path = build_job(
            bpy.path.abspath(self.source),
            bpy.path.abspath(self.filepath),
            mirror=self.mirror,
            exclude=self.exclude,
        )
        return job

    def apply(self, context: Context, result: Any) -> Steps[str]:
        """Use the new database."""
        yield 0.0
        settings_of(context.scene).database = self._path
        skipped = f", {len(result.skipped)} left out" if result.skipped else ""
        return (
            f"Built a database of {result.num_clips} clips from {result.num_files} files{skipped}"
        )


CLASSES = (
    SPARSEMOCAP_OT_open_database,
    SPARSEMOCAP_OT_choose_output,
    SPARSEMOCAP_OT_build_database,
)
