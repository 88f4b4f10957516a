# SPDX-License-Identifier: GPL-3.0-or-later
"""The mapping of the last imported skeleton in the sidebar."""

from bpy.types import Context, Panel

from ..scene.mapping import mapping_of
from ..session.core import missing_reason
from ..session.mapping import last_mapped
from . import text
from .step import StepPanel


class SPARSEMOCAP_PT_mapping(StepPanel, Panel):
    """The mapping, to check and correct."""

    bl_idname = "SPARSEMOCAP_PT_mapping"
    bl_label = "Skeleton Mapping"
    bl_order = 4
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only after a file was imported."""
        return not missing_reason() and bool(last_mapped)

    def draw(self, context: Context) -> None:
        """One row for each joint of the standard skeleton."""
        layout, rows, last = self.layout, mapping_of(context), last_mapped[0]
        text.paragraph(layout, context, f"Joints of {last.name}:")
        if last.problem:
            text.error(layout, context, last.problem)
        column = layout.column(align=True)
        column.use_property_split = True
        column.use_property_decorate = False
        for row in rows.joints:
            column.prop_search(row, "source", rows, "sources", text=row.name, icon="BONE_DATA")
        row = layout.row(align=True)
        row.operator("sparse_mocap.remember_mapping", icon="CHECKMARK")
        row.operator("sparse_mocap.forget_mapping", icon="X")
        row = layout.row(align=True)
        row.operator("sparse_mocap.load_mapping", text="Load", icon="IMPORT")
        row.operator("sparse_mocap.save_mapping", text="Save", icon="EXPORT")


CLASSES = (SPARSEMOCAP_PT_mapping,)
