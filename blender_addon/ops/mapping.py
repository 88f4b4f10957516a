# SPDX-License-Identifier: GPL-3.0-or-later
"""The skeleton mapping: remembered for a skeleton, saved to a file, loaded from one."""

import bpy
from bpy.props import BoolProperty, StringProperty
from bpy.types import Context, Operator

from ..scene.binding import rest_bones
from ..scene.mapping import mapping_of, show_joints, show_mapping, shown_joints
from ..scene.settings import settings_of
from ..session import mapping
from ..session.character import still_motion
from ..session.errors import InputError
from .now_operator import FileOperator, NowOperator

SKIP = {"HIDDEN", "SKIP_SAVE"}


class SPARSEMOCAP_OT_show_mapping(NowOperator, Operator):
    """Show which of the character's bones are mapped, to check and correct."""

    bl_idname = "sparse_mocap.show_mapping"
    bl_label = "Show Mapping"
    bl_description = "Show which bones of the character are mapped, to check and correct them"
    bl_options = {"REGISTER"}

    def act(self, context: Context) -> str:
        """Map the character."""
        armature = settings_of(context.scene).target
        if armature is None:
            raise InputError("Choose a character first")
        still = still_motion(rest_bones(context, armature))
        found = mapping.mapped(armature.name, still)
        show_mapping(context, found)
        if found.problem:
            raise InputError(f'"{armature.name}": {found.problem}')
        return f'Mapped {len(found.joints)} bones of "{armature.name}"'


class SPARSEMOCAP_OT_pick_bone(NowOperator, Operator):
    """Map the active bone to this joint."""

    bl_idname = "sparse_mocap.pick_bone"
    bl_label = "Use Active Bone"
    bl_description = "Use the active bone for this part of the body"
    bl_options = {"REGISTER", "INTERNAL"}

    joint: StringProperty(name="Joint", options=SKIP)

    def act(self, context: Context) -> str:
        """Put its name into the row."""
        bone = context.active_pose_bone or context.active_bone
        rows = mapping_of(context)
        if bone is None or bone.name not in rows.sources:
            raise InputError("Select a bone of the character in Pose Mode first")
        rows.joints[self.joint].source = bone.name
        return f"{mapping.label_of(self.joint)}: {bone.name}"


class SPARSEMOCAP_OT_remember_mapping(NowOperator, Operator):
    """Use this mapping for every file with this skeleton."""

    bl_idname = "sparse_mocap.remember_mapping"
    bl_label = "Remember"
    bl_description = "Use this mapping for every character and file with this skeleton from now on"
    bl_options = {"REGISTER"}

    def act(self, context: Context) -> str:
        """Remember the rows."""
        found = mapping.remember(shown_joints(context))
        show_mapping(context, found)
        return f'Mapping remembered for every skeleton like that of "{found.name}"'


class SPARSEMOCAP_OT_forget_mapping(NowOperator, Operator):
    """Forget the remembered mapping of this skeleton."""

    bl_idname = "sparse_mocap.forget_mapping"
    bl_label = "Forget"
    bl_description = "Forget this skeleton's mapping and detect its joints automatically again"
    bl_options = {"REGISTER"}

    def act(self, context: Context) -> str:
        """Forget the mapping."""
        show_mapping(context, mapping.forget())
        return "Mapping forgotten; the joints are detected automatically again"


class SPARSEMOCAP_OT_save_mapping(FileOperator, Operator):
    """Save this mapping to a file."""

    bl_idname = "sparse_mocap.save_mapping"
    bl_label = "Save Mapping"
    bl_description = "Save this mapping to a .json file"
    bl_options = {"REGISTER"}

    filter_glob: StringProperty(default=f"*{mapping.SUFFIX}", options=SKIP)
    check_existing: BoolProperty(default=True, options=SKIP)

    def act(self, context: Context) -> str:
        """Write the file."""
        path = mapping.save(bpy.path.abspath(self.filepath), shown_joints(context))
        return f"Saved {path}"


class SPARSEMOCAP_OT_load_mapping(FileOperator, Operator):
    """Load a mapping from a file."""

    bl_idname = "sparse_mocap.load_mapping"
    bl_label = "Load Mapping"
    bl_description = "Load a mapping from a .json file"
    bl_options = {"REGISTER"}

    filter_glob: StringProperty(default=f"*{mapping.SUFFIX}", options=SKIP)

    def act(self, context: Context) -> str:
        """Show the file's mapping; it takes effect with Remember."""
        show_joints(context, mapping.load(bpy.path.abspath(self.filepath)))
        return "Mapping loaded: press Remember to use it"


CLASSES = (
    SPARSEMOCAP_OT_show_mapping,
    SPARSEMOCAP_OT_pick_bone,
    SPARSEMOCAP_OT_remember_mapping,
    SPARSEMOCAP_OT_forget_mapping,
    SPARSEMOCAP_OT_save_mapping,
    SPARSEMOCAP_OT_load_mapping,
)
