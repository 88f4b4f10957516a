# SPDX-License-Identifier: GPL-3.0-or-later
"""The clips of the opened motion database in the sidebar."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.types import Context, Panel, UILayout, UIList

from ..scene.clips import clip_list, fill, is_listed, opened_database
from ..scene.preview import clip_in_preview
from ..session.core import missing_reason
from ..session.database import Database
from . import text
from .step import StepPanel, later

_ROWS = 6


class SPARSEMOCAP_UL_clips(UIList):
    """One line a clip: name, actor, seconds, and a button that plays it."""

    bl_idname = "SPARSEMOCAP_UL_clips"
    use_filter_show = True

    def draw_item(
        self,
        context: Context,
        layout: UILayout,
        data: Any,
        item: Any,
        icon: int,
        active_data: Any,
        active_property: str,
        index: int,
    ) -> None:
        """The line of the clip at that index."""
        database = opened_database(context)
        if database is None or index >= len(database.clips.rows):
            return
        row = database.clips.rows[index]
        split = layout.split(factor=0.6)
        split.label(text=row.label)
        split = split.split(factor=0.4)
        split.label(text=row.actor)
        line = split.row(align=True)
        line.alignment = "RIGHT"
        line.label(text=f"{row.length_s:.1f} s")
        button = line.operator("sparse_mocap.preview_clip", text="", icon="PLAY", emboss=False)
        button.index = index

    def draw_filter(self, context: Context, layout: UILayout) -> None:
        """Search, sorting and whether copies are listed."""
        shown = clip_list(context)
        column = layout.column(align=True)
        column.prop(self, "filter_name", text="", icon="VIEWZOOM")
        row = column.row(align=True)
        row.prop(shown, "sort", expand=True)
        row.prop(self, "use_filter_sort_reverse", text="", icon="SORT_DESC", toggle=True)
        database = opened_database(context)
        if database is not None and database.clips.has_copies:
            column.prop(shown, "shows_copies", text="Mirrored and other copies too")

    def filter_items(
        self, context: Context, data: Any, propname: str
    ) -> tuple[list[int], list[int]]:
        """Which clips are listed and in which order; looked up, not computed, at each redraw."""
        database = opened_database(context)
        if database is None or not is_listed(context, database):
            return [], []
        shown = clip_list(context)
        bit = self.bitflag_filter_item
        chosen = database.clips.chosen(self.filter_name, shown.shows_copies)
        return [bit if is_chosen else 0 for is_chosen in chosen], list(
            database.clips.order(shown.sort)
        )


class SPARSEMOCAP_PT_clips(StepPanel, Panel):
    """The clip list and the preview."""

    bl_idname = "SPARSEMOCAP_PT_clips"
    bl_parent_id = "SPARSEMOCAP_PT_database"
    bl_label = "Clips"

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only when a database is opened."""
        return not missing_reason() and opened_database(context) is not None

    def draw(self, context: Context) -> None:
        """The list, and what can be done with the marked clip."""
        database = opened_database(context)
        if not is_listed(context, database):
            self.layout.label(text="Listing the clips", icon="SORTTIME")
            later(_fill)
            return
        shown = clip_list(context)
        self.layout.template_list(
            SPARSEMOCAP_UL_clips.bl_idname, "", shown, "items", shown, "index", rows=_ROWS
        )
        _draw_marked(self.layout, context, database)


def _draw_marked(layout: UILayout, context: Context, database: Database) -> None:
    index = clip_list(context).index
    if index >= len(database.clips.rows):
        return
    playing = context.screen is not None and context.screen.is_animation_playing
    row = layout.row(align=True)
    row.operator("sparse_mocap.preview_clip", icon="PLAY").index = index
    row.operator(
        "screen.animation_play",
        text="Pause" if playing else "Resume",
        icon="PAUSE" if playing else "FRAME_NEXT",
    )
    name = clip_in_preview(context.scene)
    if name:
        text.paragraph(layout, context, f"In the viewport: {name}")
        row = layout.row(align=True)
        row.operator("sparse_mocap.fit_preview_range", icon="PREVIEW_RANGE")
        row.operator("sparse_mocap.keep_preview", icon="CHECKMARK")


def _fill() -> None:
    fill(bpy.context)


CLASSES = (SPARSEMOCAP_UL_clips, SPARSEMOCAP_PT_clips)
