# SPDX-License-Identifier: GPL-3.0-or-later
"""The character in the viewport: a body for the add-on's own figure, sensors, contacts."""

from bpy.types import Context, Operator

from ..scene import overlay, sensor_graph
from ..scene.armature import is_ours
from ..scene.body import new_body
from ..scene.live import followed
from ..scene.settings import settings_of
from ..scene.translations import tr_line
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
            self.report({"ERROR"}, tr_line(one_line(error)))
            return {"CANCELLED"}
        armature.show_in_front = False
        self.report({"INFO"}, tr_line(f'"{body.name}" moves with "{armature.name}"'))
        return {"FINISHED"}


class SPARSEMOCAP_OT_toggle_overlay(Operator):
    """Show the sensors on the body and which feet stand on the floor."""

    bl_idname = "sparse_mocap.toggle_overlay"
    bl_label = "Show Sensors"
    bl_description = (
        "Show where the sensors are (blue; orange and small without data), which feet stand (green "
        "squares), and limbs that are typically more than 8 cm off (long orange dashes) or 15 cm "
        "(short pink dashes)"
    )
    bl_options = {"INTERNAL"}

    def execute(self, context: Context) -> set[str]:
        """Switch it on for the character, or off."""
        target = settings_of(context.scene).target
        try:
            overlay.toggle(context, followed() or target or context.view_layer.objects.active)
        except Exception as error:
            self.report({"ERROR"}, tr_line(one_line(error)))
            return {"CANCELLED"}
        return {"FINISHED"}


class SPARSEMOCAP_OT_toggle_sensor_graph(Operator):
    """Show what each sensor measured and what it should read."""

    bl_idname = "sparse_mocap.toggle_sensor_graph"
    bl_label = "Sensor Graph"
    bl_description = (
        "Show around the current frame what each sensor measured (blue) and what it should read on "
        "the result (orange, dashed), in m/s² with gravity. Where they differ, the result is not "
        "what was performed"
    )
    bl_options = {"INTERNAL"}

    def execute(self, context: Context) -> set[str]:
        """Switch it on or off."""
        try:
            sensor_graph.toggle(context)
        except Exception as error:
            self.report({"ERROR"}, tr_line(one_line(error)))
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = (
    SPARSEMOCAP_OT_add_body,
    SPARSEMOCAP_OT_toggle_overlay,
    SPARSEMOCAP_OT_toggle_sensor_graph,
)
