# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 1 in the sidebar: the motion database."""

from __future__ import annotations

import bpy
from bpy.types import Context, Panel, UILayout

from ..scene.settings import SPARSEMOCAP_PG_settings, settings_of
from ..session.core import missing_reason
from ..session.database import BUILDING, databases, default_output
from . import text
from .step import StepPanel, action_button, redraw_soon


class SPARSEMOCAP_PT_database(StepPanel, Panel):
    """The database in use."""

    bl_idname = "SPARSEMOCAP_PT_database"
    bl_label = "1  Motion Database"
    bl_order = 1

    def draw(self, context: Context) -> None:
        """The file, and what is in it."""
        if missing_reason():
            text.error(self.layout, context, missing_reason())
            return
        settings = settings_of(context.scene)
        row = self.layout.row(align=True)
        row.prop(settings, "database", text="")
        row.operator("sparse_mocap.open_database", text="", icon="FILE_FOLDER")
        if not settings.database:
            text.paragraph(
                self.layout, context, "Open a motion database, or build one below", icon="INFO"
            )
            return
        _contents(self.layout, context, settings)


class SPARSEMOCAP_PT_build(StepPanel, Panel):
    """A new database from motion files."""

    bl_idname = "SPARSEMOCAP_PT_build"
    bl_label = "Build from Motion Files"
    bl_parent_id = "SPARSEMOCAP_PT_database"

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only where it can be done."""
        return not missing_reason()

    def draw(self, context: Context) -> None:
        """What to build from, and the button."""
        settings = settings_of(context.scene)
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(settings, "source")
        row = layout.row(align=True)
        row.prop(settings, "output")
        row.operator("sparse_mocap.choose_output", text="", icon="FILE_FOLDER")
        layout.prop(settings, "exclude")
        layout.prop(settings, "mirror", text="Mirror motions")
        if settings.source and not settings.output:
            path = default_output(bpy.path.abspath(settings.source))
            text.paragraph(layout, context, f"Writes {path}")
        action_button(
            layout,
            "sparse_mocap.build_database",
            "FILE_REFRESH",
            BUILDING,
            is_ready=bool(settings.source),
        )


def _contents(layout: UILayout, context: Context, settings: SPARSEMOCAP_PG_settings) -> None:
    entry = databases.peek(bpy.path.abspath(settings.database))
    if entry.is_opening:
        layout.label(text="Opening the database", icon="SORTTIME")
        redraw_soon()
    elif entry.error:
        text.error(layout, context, entry.error)
    else:
        database = entry.value
        text.facts(
            layout,
            [
                ("Clips", f"{database.num_clips:,} of {database.num_sources:,} files"),
                ("Motion", f"{database.minutes:.1f} min"),
                ("Rate", f"{database.rate_hz:g} Hz"),
                ("Size", text.size(database.size_bytes)),
            ],
        )


CLASSES = (SPARSEMOCAP_PT_database, SPARSEMOCAP_PT_build)
