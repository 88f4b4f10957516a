# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 3 in the sidebar: the take as an action."""

from __future__ import annotations

from bpy.types import Context, Panel, UILayout

from ..scene.armature import is_ours
from ..scene.performance import facts_of, performed_action
from ..scene.settings import settings_of
from ..session.core import missing_reason
from ..session.reconstruct import RECONSTRUCTING
from . import text
from .step import StepPanel, action_button


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
        """The choices, the button, and what the active armature performs."""
        settings = settings_of(context.scene)
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.row().prop(settings, "preset", expand=True)
        row = layout.row(align=True, heading="Mode")
        row.prop(settings, "offline", text="Online", toggle=True, invert_checkbox=True)
        row.prop(settings, "offline", text="Offline", toggle=True)
        layout.prop(settings, "start_frame")
        layout.prop(settings, "calibration")
        if any(is_ours(obj) for obj in context.view_layer.objects):
            row = layout.row()
            row.use_property_split = False
            row.prop(settings, "reuse_armature")
        is_ready = bool(settings.database and settings.take)
        action_button(
            layout, "sparse_mocap.reconstruct", "ARMATURE_DATA", RECONSTRUCTING, is_ready=is_ready
        )
        if not is_ready:
            missing = "a take" if settings.database else "a motion database"
            text.paragraph(layout, context, f"Choose {missing} first", icon="INFO")
        _performed(layout, context)


def _performed(layout: UILayout, context: Context) -> None:
    """What the active armature performs."""
    action = performed_action(context.view_layer.objects.active)
    facts = None if action is None else facts_of(action)
    if action is not None and facts is not None:
        first, last = action.frame_range
        rows = [
            ("Action", action.name),
            ("Duration", text.duration(facts.duration_s)),
            ("Frames", f"{first:.0f} to {last:.0f}"),
            ("Misfit", f"{facts.misfit_mps2:.2f} m/s²"),
        ]
        text.facts(layout, rows)
        if facts.is_guess:
            text.paragraph(
                layout, context, "The database holds nothing like this take", icon="ERROR"
            )


CLASSES = (SPARSEMOCAP_PT_reconstruct,)
