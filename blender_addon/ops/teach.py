# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 1: teach the motion database a movement of the performer's own."""

from __future__ import annotations

import bpy
from bpy.props import StringProperty
from bpy.types import Context, Operator

from ..scene.settings import settings_of
from ..session.job import Job
from ..session.steps import Steps
from ..session.teaching import MOTIONS, TAKES, Lesson, Taught, teach_job
from .job_operator import JobOperator
from .now_operator import FileOperator

SKIP = {"SKIP_SAVE"}


class SPARSEMOCAP_OT_choose_taught_motion(FileOperator, Operator):
    """Choose the motion file of the performance."""

    bl_idname = "sparse_mocap.choose_taught_motion"
    bl_label = "Choose Motion"
    bl_description = "Choose the motion file of the performance"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    filter_glob: StringProperty(
        default=";".join(f"*{ending}" for ending in MOTIONS), options={"HIDDEN", "SKIP_SAVE"}
    )

    def act(self, context: Context) -> str:
        """Remember the path."""
        settings_of(context.scene).teaching.motion = self.filepath
        return ""


class SPARSEMOCAP_OT_choose_taught_take(FileOperator, Operator):
    """Choose the take that was recorded during the performance."""

    bl_idname = "sparse_mocap.choose_taught_take"
    bl_label = "Choose Take"
    bl_description = "Choose the take (.csv) that was recorded during the performance"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    filter_glob: StringProperty(default=f"*{TAKES[0]}", options={"HIDDEN", "SKIP_SAVE"})

    def act(self, context: Context) -> str:
        """Remember the path."""
        settings_of(context.scene).teaching.take = self.filepath
        return ""


class SPARSEMOCAP_OT_teach(JobOperator, Operator):
    """Teach the motion database a movement together with its take."""

    bl_idname = "sparse_mocap.teach"
    bl_label = "Teach"
    bl_description = (
        "Write a new motion database that also has this motion and what the sensors measured "
        "during it, and use it. The one in use stays as it is"
    )
    bl_options = {"REGISTER", "UNDO"}

    filepath: StringProperty(
        name="Save as", description="The .smdb file to write", subtype="FILE_PATH", options=SKIP
    )

    def prepare(self, context: Context) -> Job:
        """Teach what the scene's settings choose."""
        settings = settings_of(context.scene)
        teaching = settings.teaching
        lesson = Lesson(
            bpy.path.abspath(teaching.motion),
            bpy.path.abspath(teaching.take),
            (teaching.clap_from_s, teaching.clap_to_s) if teaching.has_clap else None,
            bpy.path.abspath(settings.calibration),
        )
        database = bpy.path.abspath(settings.database)
        return teach_job(database, lesson, bpy.path.abspath(self.filepath))

    def apply(self, context: Context, result: Taught) -> Steps[str]:
        """Use the new database."""
        yield 0.0
        settings_of(context.scene).database = result.path
        return f'Taught "{result.name}": the agreement of motion and take is {result.quality}'


CLASSES = (
    SPARSEMOCAP_OT_choose_taught_motion,
    SPARSEMOCAP_OT_choose_taught_take,
    SPARSEMOCAP_OT_teach,
)
