# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's own figure: a simple body for previews."""

from bpy.types import Context, Operator

from ..scene.armature import is_ours
from ..scene.body import new_body
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


CLASSES = (SPARSEMOCAP_OT_add_body,)
