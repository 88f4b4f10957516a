# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Import: motion files as they are, each onto an armature."""

from __future__ import annotations

import os

import bpy
from bpy.props import BoolProperty, CollectionProperty, EnumProperty, FloatProperty, StringProperty
from bpy.types import Context, Event, Operator, OperatorFileListElement

from ..scene.imported import import_steps
from ..scene.mapping import show_mapping
from ..session.imported import ACCLAIM, BVH, LoadedMotion, Reading, glances, import_job
from ..session.job import Job
from ..session.mapping import last_mapped
from ..session.steps import Steps
from ..ui.import_motion import UNITS, UP_AXES, draw_options, unit_m
from .job_operator import JobOperator

FILES = {"HIDDEN", "SKIP_SAVE"}
_MOST_WARNINGS = 5
_DIALOG_PX = 340
_GLANCE_S = 0.5


class ImportOperator(JobOperator):
    """Mix-in: asks for files and options, reads on a worker thread, makes armatures."""

    endings: tuple[str, ...] = ()
    _asks = False

    filepath: StringProperty(name="File", subtype="FILE_PATH", options=FILES)
    directory: StringProperty(subtype="DIR_PATH", options=FILES)
    files: CollectionProperty(type=OperatorFileListElement, options=FILES)

    unit: EnumProperty(name="Unit", description="How long a unit of the file is", items=UNITS)
    up_axis: EnumProperty(name="Up", description="The axis that points up in it", items=UP_AXES)
    start_frame: FloatProperty(
        name="Start frame",
        description="The frame on which the motion begins",
        default=1.0,
        precision=0,
        step=100,
    )
    keep_timing: BoolProperty(
        name="Keep the file's timing",
        description=(
            "Keys stand where the scene's frame rate shows the file's times. "
            "Otherwise each frame of the file becomes one of the scene, faster or slower"
        ),
        default=True,
    )
    standard_skeleton: BoolProperty(
        name="Onto the standard skeleton",
        description="Put the motion onto the skeleton of 21 joints that the databases use",
    )

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Let the animator choose the files, or only the options if they are given."""
        if bpy.app.background:
            return self.execute(context)
        self._asks = True
        if self.paths():
            glances.peek(self.paths()[0])
            glances.wait(_GLANCE_S)  # a dialog is not drawn anew when the file is read
            return context.window_manager.invoke_props_dialog(self, width=_DIALOG_PX)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        """On after the dialog; all at once for scripts and when the options are adjusted."""
        if not self._asks:
            return super().execute(context)
        self._asks = False
        return self.start(context)

    def draw(self, context: Context) -> None:
        """The options, and what they make of the file."""
        draw_options(self, context)

    def _failed(self, error: Exception) -> set[str]:
        if last_mapped and last_mapped[0].problem:
            show_mapping(bpy.context, last_mapped[0])  # to be mended there
        return super()._failed(error)

    def paths(self) -> list[str]:
        """The chosen files."""
        folder = bpy.path.abspath(self.directory)
        paths = [os.path.join(folder, file.name) for file in self.files if file.name]
        if not paths and self.filepath and os.path.basename(self.filepath):
            paths = [bpy.path.abspath(self.filepath)]
        return paths

    def prepare(self, context: Context) -> Job:
        """Read the files."""
        reading = Reading(
            unit_m=unit_m(self.unit),
            up=self.up_axis.lower(),
            amc_rate_hz=getattr(self, "amc_rate_hz", 120.0),
            is_standard=self.standard_skeleton,
        )
        return import_job(self.paths(), self.endings, reading)

    def apply(self, context: Context, result: list[LoadedMotion]) -> Steps[str]:
        """One armature a file."""
        made = yield from import_steps(
            context,
            result,
            self.start_frame,
            keeps_timing=self.keep_timing,
        )
        show_mapping(context, result[-1].mapped)
        warnings = [warning for motion in result for warning in motion.warnings]
        for warning in warnings[:_MOST_WARNINGS]:
            self.report({"WARNING"}, warning)
        more = len(warnings) - _MOST_WARNINGS
        if more > 0:
            self.report({"WARNING"}, f"and {more} more warnings")
        if len(made) > 1:
            return f"Imported {len(made)} files, each onto its armature"
        motion = result[0]
        joints = f"{len(motion.skeleton.parents)} joints"
        frames = f"{motion.num_frames} frames" if motion.num_frames else "rest pose"
        return f'Imported "{made[0].name}": {joints}, {frames}'


class SPARSEMOCAP_OT_import_bvh(ImportOperator, Operator):
    """Import motion capture in Biovision files."""

    bl_idname = "sparse_mocap.import_bvh"
    bl_label = "Import Motion Capture BVH"
    bl_description = "Import .bvh motion capture, each file onto an armature of its own skeleton"
    bl_options = {"REGISTER", "UNDO"}

    endings = BVH
    filter_glob: StringProperty(default="*.bvh", options=FILES)


class SPARSEMOCAP_OT_import_acclaim(ImportOperator, Operator):
    """Import motion capture in Acclaim files."""

    bl_idname = "sparse_mocap.import_acclaim"
    bl_label = "Import Acclaim"
    bl_description = (
        "Import .amc motion capture with the .asf skeleton found beside it, or an .asf alone"
    )
    bl_options = {"REGISTER", "UNDO"}

    endings = ACCLAIM
    filter_glob: StringProperty(default="*.asf;*.amc", options=FILES)
    amc_rate_hz: FloatProperty(
        name="Frame rate",
        description="Frames a second of the .amc: the file does not say",
        default=120.0,
        min=1.0,
        max=10_000.0,
        soft_max=500.0,
    )


CLASSES = (SPARSEMOCAP_OT_import_bvh, SPARSEMOCAP_OT_import_acclaim)
