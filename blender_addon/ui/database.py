# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 1 in the sidebar: the motion database."""

from __future__ import annotations

import os

import bpy
from bpy.types import Context, Panel, UILayout

from ..scene.settings import SPARSEMOCAP_PG_settings, settings_of
from ..scene.translations import tr
from ..session.core import missing_reason
from ..session.database import BUILDING, databases, default_output, last_build
from ..session.demo import MAKING, TRYING
from ..session.free_motions import FREE_MOTIONS
from . import text
from .step import StepPanel, action_button, job_is_running, redraw_soon, tick
from .teaching import draw_teaching

_MOST_SHOWN = 3  # skipped files


class SPARSEMOCAP_PT_database(StepPanel, Panel):
    """The database in use."""

    bl_idname = "SPARSEMOCAP_PT_database"
    bl_label = "1  Motion Database"
    bl_order = 1

    def draw(self, context: Context) -> None:
        """The file, and its content."""
        if missing_reason():
            text.error(self.layout, context, missing_reason())
            return
        settings = settings_of(context.scene)
        row = self.layout.row(align=True)
        row.prop(settings, "database", text="")
        row.operator("sparse_mocap.open_database", text="", icon="FILE_FOLDER")
        if settings.database:
            _contents(self.layout, context, settings)
        else:
            first_try(self.layout, context)
            hint = "Open a motion database (.smdb), or build one:"
            text.paragraph(self.layout, context, hint, icon="INFO")
        _outcome(self.layout, context)
        if settings.database:
            draw_teaching(self.layout, context)
        _build_form(self.layout, context, settings, is_first=not settings.database)
        if not settings.database:
            _free_motions(self.layout, context)

    def draw_header_preset(self, context: Context) -> None:
        """A check mark when the step is done."""
        tick(self.layout, databases, bpy.path.abspath(settings_of(context.scene).database))


def first_try(layout: UILayout, context: Context) -> None:
    """What a new user can do without files and sensors."""
    box = layout.box()
    box.label(text="New here?")
    action_button(box, "sparse_mocap.try_it", "PLAY", TRYING, is_ready=True)
    text.paragraph(
        box,
        context,
        "A simulated performer with four simulated sensors, and a Rigify character that follows: "
        "no file and no sensor is needed",
    )
    action_button(box, "sparse_mocap.make_starter_set", "ADD", MAKING, is_ready=True, is_main=False)
    text.paragraph(box, context, "Demo movements, made by a program, to try things out")


def _free_motions(layout: UILayout, context: Context) -> None:
    """Where motion files come from."""
    box = layout.box()
    box.label(text="Motion capture to download")
    for found in FREE_MOTIONS:
        box.operator("wm.url_open", text=found.name, icon="URL").url = found.url
        text.paragraph(box, context, found.terms)


def _build_form(
    layout: UILayout, context: Context, settings: SPARSEMOCAP_PG_settings, *, is_first: bool
) -> None:
    """A new database from motion files; folded once a database is chosen."""
    box = layout.box()
    is_open = is_first or settings.is_build_open or job_is_running(BUILDING)
    row = box.row()
    row.alignment = "LEFT"
    if is_first:
        row.label(text="Build from motion files")
    else:
        icon = "TRIA_DOWN" if is_open else "TRIA_RIGHT"
        is_pressed = settings.is_build_open  # which would make its text white
        row.prop(settings, "is_build_open", icon=icon, emboss=False, invert_checkbox=is_pressed)
    if not is_open:
        return
    column = box.column()
    column.use_property_split = True
    column.use_property_decorate = False
    _sources(column, settings)
    row = column.row(align=True)
    row.prop(settings, "output")
    row.operator("sparse_mocap.choose_output", text="", icon="FILE_FOLDER")
    text.setting(column, context, settings, "exclude", margin_px=text.BOX_MARGIN_PX)
    column.prop(settings, "rate_hz")
    column = box.column(heading="Add copies")
    column.use_property_split = True
    column.use_property_decorate = False
    for name, label in (("mirror", "Mirrored"), ("reverse", "Reversed"), ("tempos", "Tempos")):
        column.prop(settings, name, text=tr(label), translate=False)
    box.prop(settings, "strict")  # too long for a column of a narrow sidebar
    if settings.source and not settings.output:
        path = default_output(bpy.path.abspath(settings.source))
        text.paragraph(box, context, tr("Will be saved as {path}").format(path=path))
    action_button(
        box,
        "sparse_mocap.build_database",
        "FILE_REFRESH",
        BUILDING,
        is_ready=bool(settings.source),
    )
    if not settings.source:
        text.paragraph(box, context, "Choose a folder with motion files first", icon="INFO")
    box.operator("sparse_mocap.build_from_file", icon="ARMATURE_DATA")


def _sources(column: UILayout, settings: SPARSEMOCAP_PG_settings) -> None:
    """The folders and files to build the database from."""
    column.prop(settings, "source")
    for index, item in enumerate(settings.more_sources):
        row = column.row(align=True)
        row.prop(item, "path", text="and" if index == 0 else " ")
        row.operator("sparse_mocap.remove_source", text="", icon="X").index = index
    row = column.row()
    row.operator("sparse_mocap.add_sources", icon="ADD")


def _outcome(layout: UILayout, context: Context) -> None:
    """What the last build skipped, if it made the database in use."""
    summary = last_build[0] if last_build else None
    path = bpy.path.abspath(settings_of(context.scene).database)
    if summary is None or summary.path != path or not (summary.skipped or summary.warnings):
        return
    box = layout.box()
    line = tr("{files} files: {skipped} skipped, {warnings} warnings").format(
        files=summary.num_files, skipped=len(summary.skipped), warnings=len(summary.warnings)
    )
    text.paragraph(box, context, line, icon="INFO")
    for name, reason in summary.skipped[:_MOST_SHOWN]:
        base = os.path.basename(name)
        reason = reason.removeprefix(name).lstrip(": ")
        text.paragraph(box, context, text.shortened(f"{base}: {reason}"))
    more = len(summary.skipped) - _MOST_SHOWN
    if more > 0:
        text.paragraph(box, context, tr("and {count} more").format(count=more))
    box.operator("sparse_mocap.show_build_report", icon="TEXT")


def _contents(layout: UILayout, context: Context, settings: SPARSEMOCAP_PG_settings) -> None:
    entry = databases.peek(bpy.path.abspath(settings.database))
    if entry.is_opening:
        layout.label(text="Opening the database", icon="SORTTIME")
        redraw_soon()
    elif (database := entry.value) is None:
        text.error(layout, context, entry.error)
    else:
        text.facts(
            layout,
            context,
            [
                ("Clips", f"{database.num_clips:,}"),
                ("Length", f"{database.minutes:.1f} min"),
                ("Rate", f"{database.rate_hz:g} Hz"),
                ("Size", text.size(database.size_bytes)),
            ],
        )


CLASSES = (SPARSEMOCAP_PT_database,)
