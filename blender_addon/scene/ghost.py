# SPDX-License-Identifier: GPL-3.0-or-later
"""Another action of a character beside the one that it plays, to compare them."""

from __future__ import annotations

import bpy
from bpy.types import Action, Context, Object

from ..session.errors import InputError
from .compat import assign_action

_MARK = "sparse_mocap_ghost"  # custom property of the object: whose ghost it is


def ghost_of(context: Context, armature: Object | None) -> Object | None:
    """The armature's ghost in the scene."""
    if armature is None:
        return None
    for obj in context.scene.objects:
        if obj.get(_MARK) == armature.name:
            return obj
    return None


def show_ghost(context: Context, armature: Object, action: Action) -> Object:
    """Play the action on a copy of the armature that cannot be selected. Raises InputError."""
    if armature.animation_data is None or armature.animation_data.action is None:
        raise InputError(f'"{armature.name}" plays no action to compare with')
    hide_ghost(context, armature)
    ghost = armature.copy()
    ghost.name, ghost[_MARK] = f"{armature.name} ghost", armature.name
    ghost.animation_data_clear()
    for collection in armature.users_collection or (context.scene.collection,):
        collection.objects.link(ghost)
    assign_action(ghost, action)
    ghost.display_type, ghost.show_in_front, ghost.hide_select = "WIRE", True, True
    ghost.select_set(False)
    for bone, original in zip(ghost.pose.bones, armature.pose.bones, strict=True):
        bone.rotation_mode = original.rotation_mode
    return ghost


def hide_ghost(context: Context, armature: Object) -> bool:
    """Remove the ghost; returns whether there was one."""
    ghost = ghost_of(context, armature)
    if ghost is None:
        return False
    bpy.data.objects.remove(ghost)
    return True
