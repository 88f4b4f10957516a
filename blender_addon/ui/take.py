# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 2 in the sidebar: the takes."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.types import Context, Panel, UILayout, UIList

from ..scene.settings import settings_of
from ..scene.takes import is_missing
from ..scene.translations import tr
from ..session.core import missing_reason
from ..session.names import shown_site
from ..session.take import takes
from . import text
from .step import StepPanel, redraw_soon, tick

_ROWS = 4
_MATCH_ICONS = {"good": "CHECKMARK", "fair": "REMOVE", "poor": "ERROR"}


class SPARSEMOCAP_UL_takes(UIList):
    """One line for each take: star, name, length, sensors where there is room, match."""

    bl_idname = "SPARSEMOCAP_UL_takes"

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
        """Draw the take."""
        row = layout.row(align=True)
        star = "SOLO_ON" if item.is_starred else "SOLO_OFF"
        row.prop(item, "is_starred", text="", icon=star, emboss=False)
        if is_missing(item):
            split = row.split(factor=0.5, align=True)
            split.label(text=item.name, translate=False)
            split.label(text="missing")
            row.label(text="", icon="QUESTION")
            return
        split = row.split(factor=0.5 if text.is_wide(context) else 0.56, align=True)
        split.label(text=item.name, translate=False)
        seconds = split.row(align=True)
        seconds.alignment = "RIGHT"
        seconds.label(text=text.duration(item.duration_s))
        if text.is_wide(context) and item.num_sensors:
            sensors = tr("{count} sensors").format(count=item.num_sensors)
            seconds.label(text=sensors, translate=False)
        if item.letters:
            row.label(text=item.letters, translate=False)
        row.label(text="", icon=_MATCH_ICONS.get(item.match, "BLANK1"))


class SPARSEMOCAP_PT_take(StepPanel, Panel):
    """The takes, and the one in use."""

    bl_idname = "SPARSEMOCAP_PT_take"
    bl_label = "2  Take"
    bl_order = 2

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only when the core is installed."""
        return not missing_reason()

    def draw(self, context: Context) -> None:
        """The list, and the content of the chosen one."""
        settings = settings_of(context.scene)
        if settings.takes:
            row = self.layout.row()
            row.template_list(
                "SPARSEMOCAP_UL_takes", "", settings, "takes", settings, "take_index", rows=_ROWS
            )
            column = row.column(align=True)
            column.operator("sparse_mocap.load_take", text="", icon="FILE_FOLDER")
            column.operator("sparse_mocap.find_takes", text="", icon="VIEWZOOM")
            column.operator("sparse_mocap.remove_take", text="", icon="REMOVE")
        else:
            row = self.layout.row(align=True)
            row.prop(settings, "take", text="")
            row.operator("sparse_mocap.load_take", text="", icon="FILE_FOLDER")
            row.operator("sparse_mocap.find_takes", text="", icon="VIEWZOOM")
        if settings.take:
            _contents(self.layout, context, bpy.path.abspath(settings.take))
        else:
            text.paragraph(
                self.layout, context, "Load a recorded take (.csv), or record one", icon="INFO"
            )

    def draw_header_preset(self, context: Context) -> None:
        """A check mark when the step is done."""
        tick(self.layout, takes, bpy.path.abspath(settings_of(context.scene).take))


def _contents(layout: UILayout, context: Context, path: str) -> None:
    entry = takes.peek(path)
    if entry.is_opening:
        layout.label(text="Loading the take", icon="SORTTIME")
        redraw_soon()
    elif (take := entry.value) is None:
        text.error(layout, context, entry.error)
    else:
        text.facts(
            layout,
            context,
            [
                ("Duration", text.duration(take.duration_s)),
                ("Rate", f"{take.rate_hz:.4g} Hz"),
                ("Sensors", str(len(take.sensors))),
            ],
        )
        names = ", ".join(tr(shown_site(name)) for name in take.sensors)
        text.paragraph(layout, context, names)


CLASSES = (SPARSEMOCAP_UL_takes, SPARSEMOCAP_PT_take)
