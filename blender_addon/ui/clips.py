# SPDX-License-Identifier: GPL-3.0-or-later
"""The clips of the motion database in the sidebar."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.types import Context, Panel, UILayout, UIList

from ..scene.clips import clip_list, fill, is_listed, opened_database
from ..scene.preview import clip_in_preview
from ..scene.translations import tr
from ..session.core import missing_reason
from ..session.database import Database
from . import text
from .step import StepPanel, later

_ROWS = 6


class SPARSEMOCAP_UL_clips(UIList):
    """One line for each clip: name, actor where there is room, seconds."""

    bl_idname = "SPARSEMOCAP_UL_clips"

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
        """Draw the clip at that index."""
        database = opened_database(context)
        if database is None or index >= len(database.clips.rows):
            return
        row = database.clips.rows[index]
        has_room = text.is_wide(context)
        split = layout.split(factor=0.58 if has_room else 0.72, align=True)
        split.label(text=row.label, translate=False)
        if has_room:
            split = split.split(factor=0.45, align=True)
            split.label(text=row.actor, translate=False)
        split.label(text=f"{row.length_s:.1f} s", translate=False)

    def filter_items(
        self, context: Context, data: Any, propname: str
    ) -> tuple[list[int], list[int]]:
        """Which clips are listed and in which order; cached, since this runs at every redraw."""
        database = opened_database(context)
        if database is None or not is_listed(context, database):
            return [], []
        shown = clip_list(context)
        bit = self.bitflag_filter_item
        searched = f"{shown.search} {self.filter_name}"
        chosen = database.clips.chosen(searched, shown.shows_copies)
        order = database.clips.order(shown.sort)
        return [bit if is_chosen else 0 for is_chosen in chosen], list(order)


class SPARSEMOCAP_PT_clips(StepPanel, Panel):
    """The clip list and the preview."""

    bl_idname = "SPARSEMOCAP_PT_clips"
    bl_parent_id = "SPARSEMOCAP_PT_database"
    bl_label = "Clips"

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only when a database is open."""
        return not missing_reason() and opened_database(context) is not None

    def draw(self, context: Context) -> None:
        """The list, and the buttons for the selected clip."""
        database = opened_database(context)
        if database is None or not is_listed(context, database):
            self.layout.label(text="Listing the clips", icon="SORTTIME")
            later(_fill)
            return
        shown = clip_list(context)
        row = self.layout.row(align=True)
        row.prop(shown, "search", text="", icon="VIEWZOOM")
        row.prop(shown, "sort", text="", icon="SORTSIZE", icon_only=True)
        if database.clips.has_copies:
            row.prop(shown, "shows_copies", text="", icon="MOD_MIRROR")
        self.layout.template_list(
            SPARSEMOCAP_UL_clips.bl_idname, "", shown, "items", shown, "index", rows=_ROWS
        )
        _draw_selected(self.layout, context, database)


def _draw_selected(layout: UILayout, context: Context, database: Database) -> None:
    index = clip_list(context).index
    if index >= len(database.clips.rows):
        return
    row = layout.row(align=True)
    row.operator("sparse_mocap.preview_clip", icon="PLAY").index = index
    name = clip_in_preview(context.scene)
    if not name:
        return
    is_playing = context.screen is not None and context.screen.is_animation_playing
    icon = "PAUSE" if is_playing else "FRAME_NEXT"
    row.operator("screen.animation_play", text="Pause" if is_playing else "Resume", icon=icon)
    row = layout.row(align=True)
    row.operator("sparse_mocap.fit_preview_range", icon="PREVIEW_RANGE")
    row.operator("sparse_mocap.keep_preview", icon="CHECKMARK")
    text.paragraph(layout, context, tr("Previewing {name}").format(name=name))


def _fill() -> None:
    fill(bpy.context)


CLASSES = (SPARSEMOCAP_UL_clips, SPARSEMOCAP_PT_clips)
