# SPDX-License-Identifier: GPL-3.0-or-later
"""The mapping of a character or of an imported file in the sidebar."""

from __future__ import annotations

from typing import Any

from bpy.types import Context, Panel, UILayout, UIList

from ..scene.mapping import mapping_of
from ..scene.settings import settings_of
from ..scene.translations import tr
from ..session.core import missing_reason
from ..session.mapping import LABELS, label_of, last_mapped
from . import text
from .step import StepPanel

_ROWS = 10


class SPARSEMOCAP_UL_mapping(UIList):
    """One line for each part of the body: its name and the bone."""

    bl_idname = "SPARSEMOCAP_UL_mapping"

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
        """Draw the part."""
        split = layout.split(factor=0.48, align=True)
        split.label(text=label_of(item.name))
        split.label(text=item.source or "-", translate=False)

    def filter_items(
        self, context: Context, data: Any, propname: str
    ) -> tuple[list[int], list[int]]:
        """Parts that no usual rig has are listed only where they are mapped."""
        bit = self.bitflag_filter_item
        rows = getattr(data, propname)
        return [bit if row.name in LABELS or row.source else 0 for row in rows], []


def _chosen(layout: UILayout, context: Context) -> None:
    """The bone of the chosen part, to be changed."""
    rows = mapping_of(context)
    if not 0 <= rows.index < len(rows.joints):
        return
    row = rows.joints[rows.index]
    layout.label(text=f"{tr(label_of(row.name))}:", translate=False)
    fields = layout.row(align=True)
    fields.prop_search(row, "source", rows, "sources", text="", icon="BONE_DATA")
    pick = fields.row(align=True)
    pick.enabled = context.mode == "POSE"
    pick.operator("sparse_mocap.pick_bone", text="", icon="EYEDROPPER").joint = row.name


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
        whose = tr("Bones of {name}").format(name=last.name)
        text.paragraph(layout, context, whose, icon="ARMATURE_DATA")
        if last.problem:
            text.error(layout, context, last.problem)
        layout.template_list(
            "SPARSEMOCAP_UL_mapping", "", rows, "joints", rows, "index", rows=_ROWS
        )
        _chosen(layout, context)
        row = layout.row(align=True)
        row.operator("sparse_mocap.remember_mapping", icon="CHECKMARK")
        row.operator("sparse_mocap.forget_mapping", icon="X")
        row = layout.row(align=True)
        row.operator("sparse_mocap.load_mapping", text=tr("Load"), translate=False, icon="IMPORT")
        row.operator("sparse_mocap.save_mapping", text="Save", icon="EXPORT")


CLASSES = (SPARSEMOCAP_UL_mapping, SPARSEMOCAP_PT_mapping)
