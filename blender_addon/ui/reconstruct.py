# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 3 in the sidebar: the take as an action."""

from __future__ import annotations

from bpy.types import Action, Context, Panel, UILayout

from ..scene import overlay, sensor_graph
from ..scene.armature import is_ours
from ..scene.ghost import ghost_of
from ..scene.performance import Facts, alternatives_of, facts_of, performed_action
from ..scene.settings import SPARSEMOCAP_PG_settings, settings_of
from ..scene.translations import tr
from ..session.bake import PLACING_AGAIN
from ..session.core import missing_reason
from ..session.match import ODD_SENSOR, poor_parts
from ..session.methods import has_alternatives, has_best_quality, missing_file, preset_items
from ..session.names import shown_site
from ..session.reconstruct import RECONSTRUCTING, kept
from . import text
from .step import StepPanel, action_button, job_is_running

_MOST_PARTS = 4  # poor ones
_PART_SETTINGS = (
    "range_begin_s",
    "range_end_s",
    "smooth_s",
    "largest_error_deg",
    "largest_error_cm",
)
_FOOT_SETTINGS = ("least_certainty", "fastest_foot_mps", "highest_foot_m")


class SPARSEMOCAP_PT_reconstruct(StepPanel, Panel):
    """How to reconstruct, and what came of it."""

    bl_idname = "SPARSEMOCAP_PT_reconstruct"
    bl_label = "3  Reconstruct"
    bl_order = 3

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only where it can be done."""
        return not missing_reason()

    def draw(self, context: Context) -> None:
        """The choices, the button, and the action of the active armature."""
        settings = settings_of(context.scene)
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        row = layout.row()
        row.use_property_split = text.is_wide(context)  # its names are long
        row.prop(settings, "method", text=None if text.is_wide(context) else "")
        if len(preset_items(settings.method)) > 1:
            layout.prop(settings, "preset")
        _quality(layout, settings)
        text.setting(layout, context, settings, "calibration")
        layout.separator()
        character(layout, context)
        layout.prop(settings, "start_frame")
        if settings.target is not None and not is_ours(settings.target):
            text.setting(layout, context, settings, "limbs")
            layout.prop(settings, "foot_lock")
        column = layout.column(heading=tr("Keys"), translate=False)
        column.prop(settings, "whole_frames")
        column.prop(settings, "extend_scene")
        missing = missing_file(settings.method, settings.database, settings.training.model)
        if not missing and not settings.take:
            missing = "Choose a take first"
        action_button(
            layout, "sparse_mocap.reconstruct", "ARMATURE_DATA", RECONSTRUCTING,
            is_ready=not missing,
        )  # fmt: skip
        if missing:
            text.paragraph(layout, context, missing, icon="INFO")
        _performed(layout, context)


def character(layout: UILayout, context: Context) -> None:
    """Whom the takes and the live preview move."""
    settings = settings_of(context.scene)
    text.setting(layout, context, settings, "target", icon="ARMATURE_DATA")
    if settings.target is None:
        text.paragraph(layout, context, "Empty: the add-on makes a figure", icon="INFO")
        if any(is_ours(obj) for obj in context.view_layer.objects):
            row = layout.row()
            row.use_property_split = False
            row.prop(settings, "reuse_armature")
    others = [obj for obj in context.selected_objects if obj.type == "ARMATURE"]
    if settings.to_selected or any(obj != settings.target for obj in others):
        row = layout.row()
        row.use_property_split = False
        row.prop(settings, "to_selected")


class SPARSEMOCAP_PT_keys(StepPanel, Panel):
    """Which part of the take gets keys, and how many."""

    bl_idname = "SPARSEMOCAP_PT_keys"
    bl_label = "Part and Keys"
    bl_parent_id = "SPARSEMOCAP_PT_reconstruct"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """The range, smoothing and reduction."""
        settings = settings_of(context.scene)
        layout = _numbers(self.layout, context, settings, *_PART_SETTINGS)
        layout.prop(settings, "use_range")
        column = layout.column(align=True)
        column.active = settings.use_range
        column.prop(settings, "range_begin_s")
        column.prop(settings, "range_end_s")
        layout.prop(settings, "smooth_s")
        layout.prop(settings, "reduce_keys")
        column = layout.column(align=True)
        column.active = settings.reduce_keys
        column.prop(settings, "largest_error_deg")
        column.prop(settings, "largest_error_cm")


class SPARSEMOCAP_PT_foot_lock(StepPanel, Panel):
    """When a foot is locked."""

    bl_idname = "SPARSEMOCAP_PT_foot_lock"
    bl_label = "Foot Lock"
    bl_parent_id = "SPARSEMOCAP_PT_reconstruct"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only for a character of the animator's own."""
        target = settings_of(context.scene).target
        return target is not None and not is_ours(target)

    def draw(self, context: Context) -> None:
        """The floor and the thresholds."""
        settings = settings_of(context.scene)
        layout = _numbers(self.layout, context, settings, *_FOOT_SETTINGS)
        layout.active = settings.foot_lock > 0.0
        text.setting(layout, context, settings, "floor")
        for name in _FOOT_SETTINGS:
            layout.prop(settings, name)


class SPARSEMOCAP_PT_options(StepPanel, Panel):
    """The options of the method."""

    bl_idname = "SPARSEMOCAP_PT_options"
    bl_label = "Method Options"
    bl_parent_id = "SPARSEMOCAP_PT_reconstruct"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: Context) -> None:
        """The options that differ from their defaults."""
        settings = settings_of(context.scene)
        column = self.layout.column(align=True)
        for index, option in enumerate(settings.options):
            row = column.row(align=True)
            split = row.split(factor=0.6, align=True)
            split.label(text=option.name.replace("_", " "), translate=False)
            split.prop(option, "value", text="")
            row.operator("sparse_mocap.remove_option", text="", icon="X").index = index
        self.layout.operator("sparse_mocap.add_option", icon="ADD")


def _numbers(
    layout: UILayout, context: Context, settings: SPARSEMOCAP_PG_settings, *names: str
) -> UILayout:
    """Where settings have their names beside them, or inside where there is no room."""
    labels = (settings.bl_rna.properties[name].name for name in names)
    layout.use_property_split = text.has_room_beside(
        context, *labels, margin_px=text.SUBPANEL_MARGIN_PX
    )
    layout.use_property_decorate = False
    return layout


def _quality(layout: UILayout, settings: SPARSEMOCAP_PG_settings) -> None:
    """Live or best quality; only live where the method has no other."""
    row = layout.row(align=True, heading="Quality")
    if not has_best_quality(settings.method):
        row.label(text="Live")
        return
    row.prop(settings, "offline", text="Live", toggle=True, invert_checkbox=True)
    row.prop(settings, "offline", text="Best", toggle=True)
    if settings.offline and has_alternatives(settings.method):
        layout.prop(settings, "alternatives")


def _performed(layout: UILayout, context: Context) -> None:
    """What the active character plays, and what can be done with it."""
    active = context.view_layer.objects.active
    if is_ours(active) and not active.children:
        layout.operator("sparse_mocap.add_body", icon="OUTLINER_OB_MESH")
    action = performed_action(active)
    facts = None if action is None else facts_of(action)
    if action is None or facts is None:
        return
    first, last = action.frame_range
    rows = [
        ("Action", action.name),
        ("Duration", text.duration(facts.duration_s)),
        ("Frames", tr("{first} to {last}").format(first=f"{first:.0f}", last=f"{last:.0f}")),
        ("Match", tr(facts.match)),
    ]
    text.facts(layout, context, rows)
    _alternatives(layout, context, action, facts)
    _poor(layout, context, facts)
    if job_is_running(PLACING_AGAIN):
        action_button(layout, "sparse_mocap.update_action", "NONE", PLACING_AGAIN, is_ready=True)
    elif kept(facts.take) is not None:
        layout.operator("sparse_mocap.update_action", icon="FILE_REFRESH")
    row = layout.row(align=True)
    row.operator(
        "sparse_mocap.toggle_overlay", text="Sensors", icon="HIDE_OFF", depress=overlay.is_shown()
    )
    row.operator(
        "sparse_mocap.toggle_sensor_graph", text="Graph", icon="GRAPH",
        depress=sensor_graph.is_shown(),
    )  # fmt: skip
    row = layout.row(align=True)
    if ghost_of(context, active) is None:
        row.operator("sparse_mocap.compare", icon="GHOST_ENABLED")
    else:
        row.operator("sparse_mocap.stop_comparing", icon="GHOST_DISABLED")
    row.operator("sparse_mocap.push_to_nla", text="To NLA", icon="NLA_PUSHDOWN")


def _alternatives(layout: UILayout, context: Context, action: Action, facts: Facts) -> None:
    """The motions of the take to choose from, and where the shown one differs from the first."""
    letters = alternatives_of(action)
    if not letters:
        return
    row = layout.row(align=True)
    for letter in letters:
        row.operator(
            "sparse_mocap.show_alternative", text=letter, translate=False,
            depress=letter == facts.letter,
        ).letter = letter  # fmt: skip
    if facts.differences:
        told = tr("Differs from A: {parts}").format(parts=facts.differences)
        text.paragraph(layout, context, told)


def _poor(layout: UILayout, context: Context, facts: Facts) -> None:
    """Where the result is poor, and what would help."""
    parts = poor_parts(facts.seconds.split())
    if parts:
        row = layout.row(align=True)
        shown = ", ".join(f"{begin}-{end}" for begin, end in parts[:_MOST_PARTS])
        shown += " ..." if len(parts) > _MOST_PARTS else ""
        row.label(text=tr("Poor: {parts} s").format(parts=shown), translate=False)
        row.operator("sparse_mocap.next_poor_part", text="", icon="FF")
    if facts.odd_sensor:
        odd = tr(ODD_SENSOR).format(site=tr(shown_site(facts.odd_sensor)))
        text.paragraph(layout, context, odd, icon="ERROR")
    if facts.advice:
        icon = "ERROR" if facts.is_guess else "INFO"
        text.paragraph(layout, context, facts.advice, icon=icon)


CLASSES = (
    SPARSEMOCAP_PT_reconstruct,
    SPARSEMOCAP_PT_keys,
    SPARSEMOCAP_PT_foot_lock,
    SPARSEMOCAP_PT_options,
)
