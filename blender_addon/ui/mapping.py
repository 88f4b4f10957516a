# SPDX-License-Identifier: GPL-3.0-or-later
"""The mapping of a character or of an imported file in the sidebar."""

from bpy.types import Context, Panel

from ..scene.mapping import mapping_of
from ..scene.settings import settings_of
from ..session.core import missing_reason
from ..session.mapping import LABELS, label_of, last_mapped
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
        """Only with a character or after a file was imported."""
        if missing_reason():
            return False
        return bool(last_mapped) or settings_of(context.scene).target is not None

    def draw(self, context: Context) -> None:
        """One row for each part of the body."""
        layout, target = self.layout, settings_of(context.scene).target
        last = last_mapped[0] if last_mapped else None
        if target is not None and (last is None or last.name != target.name):
            layout.operator("sparse_mocap.show_mapping", icon="VIEWZOOM")
        if last is None:
            return
        rows = mapping_of(context)
        text.paragraph(layout, context, f"Bones of {last.name}", icon="ARMATURE_DATA")
        if last.problem:
            text.error(layout, context, last.problem)
        column = layout.column(align=True)
        for row in rows.joints:
            if row.name not in LABELS and not row.source:
                continue
            split = column.split(factor=0.36, align=True)
            split.label(text=label_of(row.name))
            fields = split.row(align=True)
            fields.prop_search(row, "source", rows, "sources", text="", icon="BONE_DATA")
            if context.mode == "POSE":
                pick = fields.operator("sparse_mocap.pick_bone", text="", icon="EYEDROPPER")
                pick.joint = row.name
        row = layout.row(align=True)
        row.operator("sparse_mocap.remember_mapping", icon="CHECKMARK")
        row.operator("sparse_mocap.forget_mapping", icon="X")
        row = layout.row(align=True)
        row.operator("sparse_mocap.load_mapping", text="Load", icon="IMPORT")
        row.operator("sparse_mocap.save_mapping", text="Save", icon="EXPORT")


CLASSES = (SPARSEMOCAP_PT_mapping,)
