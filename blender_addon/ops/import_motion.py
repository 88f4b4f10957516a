# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Import: motion files, each on an armature."""

from __future__ import annotations

import os

import bpy
from bpy.props import BoolProperty, CollectionProperty, EnumProperty, FloatProperty, StringProperty
from bpy.types import Context, Event, Operator, OperatorFileListElement

from ..scene.imported import import_steps
from ..scene.mapping import show_mapping
from ..scene.translations import tr_line
from ..session.imported import ACCLAIM, BVH, ImportOptions, Loaded, file_summaries, import_job
from ..session.job import Job
from ..session.mapping import last_mapped
from ..session.steps import Steps
from ..ui.import_motion import UNITS, UP_AXES, draw_options, unit_m
from .job_operator import JobOperator

FILES = {"HIDDEN", "SKIP_SAVE"}
_MOST_WARNINGS = 5
_DIALOG_PX = 340
_SUMMARY_S = 0.5


class ImportOperator(JobOperator):
    """Mix-in: file browser and options, reading on a worker thread, then the armatures."""

    endings: tuple[str, ...] = ()
    _is_dialog_open = False

    filepath: StringProperty(name="File", subtype="FILE_PATH", options=FILES)
    directory: StringProperty(subtype="DIR_PATH", options=FILES)
    files: CollectionProperty(type=OperatorFileListElement, options=FILES)

    unit: EnumProperty(name="Unit", description="Length unit of the file", items=UNITS)
    up_axis: EnumProperty(
        name="Up", description="The axis that points up in the file", items=UP_AXES
    )
    start_frame: FloatProperty(
        name="Start frame",
        description="The scene frame on which the motion starts",
        default=1.0,
        precision=0,
        step=100,
    )
    keep_timing: BoolProperty(
        name="Keep the file's timing",
        description=(
            "Place the keys at the file's times, whatever the scene's frame rate. "
            "Off: one scene frame for each frame of the file, which may play faster or slower"
        ),
        default=True,
    )
    standard_skeleton: BoolProperty(
        name="Use the standard skeleton",
        description="Transfer the motion to the 21-joint skeleton that motion databases use",
    )

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Open the file browser, or only the options dialog when files are given."""
        if bpy.app.background:
            return self.execute(context)
        self._is_dialog_open = True
        if self.paths():
            file_summaries.peek(self.paths()[0])
            file_summaries.wait(_SUMMARY_S)  # a dialog is not redrawn once the file is read
            return context.window_manager.invoke_props_dialog(self, width=_DIALOG_PX)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        """Continue after the dialog; blocking for scripts and when the options are adjusted."""
        if not self._is_dialog_open:
            return super().execute(context)
        self._is_dialog_open = False
        return self.start(context)

    def draw(self, context: Context) -> None:
        """The options, and the file's size with them."""
        draw_options(self, context)

    def _failed(self, error: Exception) -> set[str]:
        if last_mapped and last_mapped[0].problem:
            show_mapping(bpy.context, last_mapped[0])  # to be corrected there
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
        options = ImportOptions(
            unit_m=unit_m(self.unit),
            up=self.up_axis.lower(),
            amc_rate_hz=getattr(self, "amc_rate_hz", 120.0),
            is_standard=self.standard_skeleton,
        )
        return import_job(self.paths(), self.endings, options)

    def apply(self, context: Context, result: Loaded) -> Steps[str]:
        """One armature for each file."""
        made = yield from import_steps(
            context,
            result.motions,
            self.start_frame,
            keeps_timing=self.keep_timing,
        )
        show_mapping(context, result.motions[-1].mapped)
        warnings = [f"Not imported: {problem}" for problem in result.problems]
        warnings += [warning for motion in result.motions for warning in motion.warnings]
        for warning in warnings[:_MOST_WARNINGS]:
            self.report({"WARNING"}, tr_line(warning))
        more = len(warnings) - _MOST_WARNINGS
        if more > 0:
            self.report({"WARNING"}, tr_line(f"and {more} more warnings"))
        if len(made) > 1:
            files, left_out = len(made), len(result.problems)
            if left_out:
                return f"Imported {files} files, each on its own armature, {left_out} left out"
            return f"Imported {files} files, each on its own armature"
        motion, name = result.motions[0], made[0].name
        joints, frames = len(motion.skeleton.parents), motion.num_frames
        if not frames:
            return f'Imported "{name}": {joints} joints, rest pose'
        return f'Imported "{name}": {joints} joints, {frames} frames'


class SPARSEMOCAP_OT_import_bvh(ImportOperator, Operator):
    """Import BVH motion capture."""

    bl_idname = "sparse_mocap.import_bvh"
    bl_label = "Import Motion Capture BVH"
    bl_description = "Import .bvh motion capture, each file on an armature with the file's skeleton"
    bl_options = {"REGISTER", "UNDO"}

    endings = BVH
    filter_glob: StringProperty(default="*.bvh", options=FILES)


class SPARSEMOCAP_OT_import_acclaim(ImportOperator, Operator):
    """Import Acclaim motion capture."""

    bl_idname = "sparse_mocap.import_acclaim"
    bl_label = "Import Acclaim"
    bl_description = (
        "Import .amc motion capture with the .asf skeleton from the same folder, or an .asf alone"
    )
    bl_options = {"REGISTER", "UNDO"}

    endings = ACCLAIM
    filter_glob: StringProperty(default="*.asf;*.amc", options=FILES)
    amc_rate_hz: FloatProperty(
        name="Frame rate",
        description="Frames per second of the .amc, which the file does not store",
        default=120.0,
        min=1.0,
        max=10_000.0,
        soft_max=500.0,
    )


CLASSES = (SPARSEMOCAP_OT_import_bvh, SPARSEMOCAP_OT_import_acclaim)
