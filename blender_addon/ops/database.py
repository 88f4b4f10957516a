# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 1: choose a motion database or build one."""

import os

import bpy
from bpy.props import BoolProperty, CollectionProperty, FloatProperty, IntProperty, StringProperty
from bpy.types import Context, Event, Operator, OperatorFileListElement

from ..scene.animated import AnimatedArmature, animated_armatures, sampled_steps
from ..scene.settings import settings_of
from ..scene.translations import tr_line
from ..session.database import (
    BUILDING,
    SUFFIX,
    BuildChoices,
    BuildSummary,
    build_from_motions_steps,
    build_job,
    checked_output,
    databases,
    default_output,
    last_build,
)
from ..session.errors import InputError
from ..session.job import Job
from ..session.steps import Steps, part
from .job_operator import JobOperator
from .now_operator import FileOperator

SKIP = {"SKIP_SAVE"}
REPORT = "Motion Database Report"


class SPARSEMOCAP_OT_open_database(FileOperator, Operator):
    """Open a motion database (.smdb)."""

    bl_idname = "sparse_mocap.open_database"
    bl_label = "Open Motion Database"
    bl_description = "Open a motion database (.smdb)"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: StringProperty(default=f"*{SUFFIX}", options={"HIDDEN", "SKIP_SAVE"})

    def act(self, context: Context) -> str:
        """Open the file; remember its path if it is a database."""
        databases.get(bpy.path.abspath(self.filepath))
        settings_of(context.scene).database = self.filepath
        return ""


class SPARSEMOCAP_OT_choose_output(FileOperator, Operator):
    """Choose where to save the new motion database."""

    bl_idname = "sparse_mocap.choose_output"
    bl_label = "Save Motion Database As"
    bl_description = "Choose where to save the new motion database"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    filter_glob: StringProperty(default=f"*{SUFFIX}", options={"HIDDEN", "SKIP_SAVE"})
    check_existing: BoolProperty(default=True, options={"HIDDEN", "SKIP_SAVE"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Open the file browser."""
        settings = settings_of(context.scene)
        self.filepath = settings.output or default_output(bpy.path.abspath(settings.source))
        return super().invoke(context, event)

    def act(self, context: Context) -> str:
        """Remember the path if a file can be written there."""
        settings_of(context.scene).output = checked_output(bpy.path.abspath(self.filepath))
        return ""


class SPARSEMOCAP_OT_build_database(JobOperator, Operator):
    """Build a motion database from motion files."""

    bl_idname = "sparse_mocap.build_database"
    bl_label = "Build Motion Database"
    bl_description = "Build a motion database from all motion files in the folder"
    bl_options = {"REGISTER", "UNDO"}

    source: StringProperty(
        name="Folder", description="Folder with motion files", subtype="DIR_PATH", options=SKIP
    )
    filepath: StringProperty(
        name="Save as", description="The .smdb file to write", subtype="FILE_PATH", options=SKIP
    )
    rate_hz: FloatProperty(name="Frame rate", default=25.0, options=SKIP)
    mirror: BoolProperty(
        name="Mirror", description="Also add a mirrored copy of every motion", options=SKIP
    )
    reverse: BoolProperty(
        name="Reverse", description="Also add a reversed copy of every motion", options=SKIP
    )
    tempos: BoolProperty(name="Other tempos", default=True, options=SKIP)
    strict: BoolProperty(name="Stop at the first error", options=SKIP)
    exclude: StringProperty(
        name="Exclude", description="File names to exclude, separated by commas", options=SKIP
    )

    def prepare(self, context: Context) -> Job:
        """Build from the given folder, or from all folders and files in the scene's settings."""
        settings = settings_of(context.scene)
        more = [] if self.source else [item.path for item in settings.more_sources]
        names = ("source", "rate_hz", "mirror", "reverse", "tempos", "strict", "exclude")
        self.fill_from_scene(context, *names)
        if not self.filepath:
            self.filepath = settings.output
        choices = BuildChoices(
            rate_hz=self.rate_hz,
            mirror=self.mirror,
            reverse=self.reverse,
            tempos=self.tempos,
            strict=self.strict,
            exclude=self.exclude,
        )
        sources = [bpy.path.abspath(path) for path in (self.source, *more) if path]
        job, _ = build_job(sources, bpy.path.abspath(self.filepath), choices)
        return job

    def apply(self, context: Context, result: BuildSummary) -> Steps[str]:
        """Use the new database."""
        yield 0.0
        settings_of(context.scene).database = result.path
        clips, files, skipped = result.num_clips, result.num_files, len(result.skipped)
        if skipped:
            return f"Built a database of {clips} clips from {files} files, {skipped} skipped"
        return f"Built a database of {clips} clips from {files} files"


class SPARSEMOCAP_OT_build_from_file(JobOperator, Operator):
    """Build a motion database from the armatures of the open file."""

    bl_idname = "sparse_mocap.build_from_file"
    bl_label = "Build from This File"
    bl_description = (
        "Build a motion database from every action of the scene's armatures. Import FBX, glTF or"
        " USD files first, then use this"
    )
    bl_options = {"REGISTER", "UNDO"}

    steps_label = BUILDING
    filepath: StringProperty(
        name="Save as", description="The .smdb file to write", subtype="FILE_PATH", options=SKIP
    )
    filter_glob: StringProperty(default=f"*{SUFFIX}", options={"HIDDEN", "SKIP_SAVE"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Ask where to save first."""
        if self.filepath or bpy.app.background:
            return super().invoke(context, event)
        settings = settings_of(context.scene)
        self.filepath = settings.output or default_output(bpy.data.filepath or "motions")
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        """Continue after the file browser; blocking for scripts."""
        return super().execute(context) if bpy.app.background else self.start(context)

    def prepare(self, context: Context) -> Job:
        """Find what moves; it is sampled in slices afterwards."""
        path = checked_output(bpy.path.abspath(self.filepath))
        animated = animated_armatures(context)
        if not animated:
            raise InputError(
                "No armature in this scene has an action that moves its bones: import some motion"
            )
        return Job(BUILDING, lambda progress: (path, animated))

    def apply(self, context: Context, result: tuple[str, list[AnimatedArmature]]) -> Steps[str]:
        """Sample the actions, build, and use the new database."""
        path, animated = result
        settings = settings_of(context.scene)
        render = context.scene.render
        choices = BuildChoices(
            settings.rate_hz, settings.mirror, settings.reverse, settings.tempos, settings.strict
        )
        sampled = yield from part(sampled_steps(context, animated), 0.0, 0.7)
        motions = [
            (
                f"{entry.armature}/{entry.action}".replace("..", "_"),
                bones.motion(render.fps / render.fps_base),
            )
            for entry, bones in sampled
        ]
        summary = yield from part(build_from_motions_steps(motions, path, choices), 0.7, 0.3)
        settings_of(context.scene).database = summary.path
        clips, actions, skipped = summary.num_clips, summary.num_files, len(summary.skipped)
        if skipped:
            return f"Built a database of {clips} clips from {actions} actions, {skipped} skipped"
        return f"Built a database of {clips} clips from {actions} actions"


class SPARSEMOCAP_OT_add_sources(Operator):
    """Add folders or motion files to build the database from."""

    bl_idname = "sparse_mocap.add_sources"
    bl_label = "Add Folders or Files"
    bl_description = "Add more folders or motion files to build the database from"
    bl_options = {"REGISTER", "UNDO"}

    directory: StringProperty(subtype="DIR_PATH", options=SKIP)
    files: CollectionProperty(type=OperatorFileListElement, options=SKIP)
    dirs: CollectionProperty(type=OperatorFileListElement, options=SKIP)
    filter_glob: StringProperty(default="*.bvh;*.amc", options={"HIDDEN", "SKIP_SAVE"})
    filter_folder: BoolProperty(default=True, options={"HIDDEN", "SKIP_SAVE"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Open the file browser."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        """Add what is selected; without a selection, the folder that is shown."""
        names = [item.name for item in (*self.dirs, *self.files) if item.name]
        settings = settings_of(context.scene)
        known = {settings.source, *(item.path for item in settings.more_sources)}
        for name in names or [""]:
            path = os.path.normpath(os.path.join(self.directory, name))
            if path in known:
                continue
            known.add(path)
            if settings.source:
                settings.more_sources.add().path = path
            else:
                settings.source = path
        return {"FINISHED"}


class SPARSEMOCAP_OT_remove_source(Operator):
    """Remove this folder or file from the list."""

    bl_idname = "sparse_mocap.remove_source"
    bl_label = "Remove"
    bl_description = "Remove this folder or file from the list; it stays on disk"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    index: IntProperty(options=SKIP)

    def execute(self, context: Context) -> set[str]:
        """Remove it from the list; the file stays on disk."""
        settings_of(context.scene).more_sources.remove(self.index)
        return {"FINISHED"}


class SPARSEMOCAP_OT_show_build_report(Operator):
    """Show in a text which files the last build skipped and why."""

    bl_idname = "sparse_mocap.show_build_report"
    bl_label = "Show Report"
    bl_description = (
        "List all skipped files and warnings in the Text Editor, and copy them to the clipboard"
    )
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: Context) -> set[str]:
        """Write the text and copy it to the clipboard."""
        if not last_build:
            self.report({"ERROR"}, tr_line("There is no report yet: build a motion database first"))
            return {"CANCELLED"}
        text = bpy.data.texts.get(REPORT) or bpy.data.texts.new(REPORT)
        text.clear()
        text.write(last_build[0].text())
        if not bpy.app.background:
            context.window_manager.clipboard = text.as_string()
        self.report(
            {"INFO"}, tr_line(f'The report is in the text "{text.name}" and on the clipboard')
        )
        return {"FINISHED"}


CLASSES = (
    SPARSEMOCAP_OT_open_database,
    SPARSEMOCAP_OT_choose_output,
    SPARSEMOCAP_OT_build_database,
    SPARSEMOCAP_OT_build_from_file,
    SPARSEMOCAP_OT_add_sources,
    SPARSEMOCAP_OT_remove_source,
    SPARSEMOCAP_OT_show_build_report,
)
