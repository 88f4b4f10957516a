# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 2 in the sidebar: the take."""

from __future__ import annotations

import bpy
from bpy.types import Context, Panel, UILayout

from ..scene.settings import settings_of
from ..session.core import missing_reason
from ..session.take import takes
from . import text
from .step import StepPanel, redraw_soon, tick


class SPARSEMOCAP_PT_take(StepPanel, Panel):
    """The take in use."""

    bl_idname = "SPARSEMOCAP_PT_take"
    bl_label = "2  Take"
    bl_order = 2

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only when the core is installed."""
        return not missing_reason()

    def draw(self, context: Context) -> None:
        """The file, and its content."""
        settings = settings_of(context.scene)
        row = self.layout.row(align=True)
        row.prop(settings, "take", text="")
        row.operator("sparse_mocap.load_take", text="", icon="FILE_FOLDER")
        if settings.take:
            _contents(self.layout, context, bpy.path.abspath(settings.take))
        else:
            text.paragraph(self.layout, context, "Load a recorded take (.csv)", icon="INFO")

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
            [
                ("Duration", text.duration(take.duration_s)),
                ("Rate", f"{take.rate_hz:.4g} Hz"),
                ("Sensors", str(len(take.sensors))),
            ],
        )
        names = ", ".join(name.replace("_", " ") for name in take.sensors)
        text.paragraph(layout, context, names.capitalize())


CLASSES = (SPARSEMOCAP_PT_take,)
