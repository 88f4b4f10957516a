# SPDX-License-Identifier: GPL-3.0-or-later
"""Trying it again, and what a bug report needs."""

from __future__ import annotations

from bpy.types import Context, Panel

from ..scene.settings import settings_of
from ..session import log_file
from ..session.core import missing_reason
from . import text
from .database import first_try
from .step import StepPanel


class SPARSEMOCAP_PT_help(StepPanel, Panel):
    """A report to copy, the log, and the first try."""

    bl_idname = "SPARSEMOCAP_PT_help"
    bl_label = "Help"
    bl_order = 9
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only when the core is installed."""
        return not missing_reason()

    def draw(self, context: Context) -> None:
        """The buttons."""
        layout = self.layout
        if settings_of(context.scene).database:
            first_try(layout, context)
        text.paragraph(layout, context, "Something is wrong? Paste this into a bug report:")
        layout.operator("sparse_mocap.copy_report", icon="COPYDOWN")
        file = log_file.path()
        row = layout.row()
        row.enabled = file is not None
        row.operator("wm.path_open", text="Open Log", icon="TEXT").filepath = str(file or "")


CLASSES = (SPARSEMOCAP_PT_help,)
