# SPDX-License-Identifier: GPL-3.0-or-later
"""The character in the viewport: a body for the add-on's own figure, sensors, contacts."""

from bpy.types import Context, Operator

from ..scene import overlay
from ..scene.armature import is_ours
from ..scene.body import new_body
from ..scene.live import followed
from ..scene.settings import settings_of
from ..session.errors import one_line


class SPARSEMOCAP_OT_add_body(Operator):
    """Add a simple body to the figure, for previews and test renders."""

    bl_idname = "sparse_mocap.add_body"
    bl_label = "Add Body"
    bl_description = "Add a simple body to the active figure, for previews and test renders"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only on an armature that the add-on made, without a body."""
        armature = context.view_layer.objects.active
        return is_ours(armature) and not any(child.type == "MESH" for child in armature.children)

    def execute(self, context: Context) -> set[str]:
        """Make the mesh."""
        armature = context.view_layer.objects.active
        try:
            body = new_body(context, armature)
        except Exception as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        armature.show_in_front = False
        self.report({"INFO"}, f'"{body.name}" moves with "{armature.name}"')
        return {"FINISHED"}


class SPARSEMOCAP_OT_toggle_overlay(Operator):
    """Show the sensors on the body and which feet stand on the floor."""

    bl_idname = "sparse_mocap.toggle_overlay"
    bl_label = "Show Sensors"
    bl_description = (
        "Show in the viewport where the sensors are on the character (blue; without data orange "
        "and small) and which feet stand on the floor (green squares)"
    )
    bl_options = {"INTERNAL"}

    def execute(self, context: Context) -> set[str]:
        """Switch it on for the character, or off."""
        target = settings_of(context.scene).target
        try:
            overlay.toggle(context, followed() or target or context.view_layer.objects.active)
        except Exception as error:
            self.report({"ERROR"}, one_line(error))
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = (SPARSEMOCAP_OT_add_body, SPARSEMOCAP_OT_toggle_overlay)
