# SPDX-License-Identifier: GPL-3.0-or-later
"""Differences between Blender 3.4 and 5.x, by checking for features, not version numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
import gpu
from bpy.types import Action, Context, FCurve, Header, Object, UILayout
from bpy_extras import anim_utils

SLOT_NAME = "Sparse Mocap"  # always the same, so that takes can be swapped on an armature

HAS_PROGRESS_BAR = "progress" in UILayout.bl_rna.functions
HAS_FILE_HANDLERS = hasattr(bpy.types, "FileHandler")  # drag and drop of files

_PLAIN_SHADER = "UNIFORM_COLOR"

_DRAGS = ("TRANSFORM_OT_", "SCULPT_OT_", "PAINT_OT_", "GPENCIL_OT_", "GREASE_PENCIL_OT_")

NewCurve = Callable[[str, int, str], FCurve]
"""Creates the curve for a data path, array index and group name."""


def new_curve_of(action: Action) -> NewCurve:
    """A function that creates curves in a new action for an object."""
    if not hasattr(action, "slots"):
        return lambda path, index, group: action.fcurves.new(path, index=index, action_group=group)
    return _new_in(_bag(action, action.slots.new(id_type="OBJECT", name=SLOT_NAME)))


class Curves:
    """The curves of one slot of an action."""

    def __init__(self, collection: Any, new: NewCurve) -> None:
        self._collection = collection
        self._new = new

    def all(self) -> list[FCurve]:
        """All of them."""
        return list(self._collection)

    def new(self, path: str, index: int, group: str) -> FCurve:
        """A new curve; index -1 for a property that is no array."""
        return self._new(path, max(index, 0), group)

    def remove(self, curve: FCurve) -> None:
        """Remove a curve."""
        self._collection.remove(curve)


def curves_for(action: Action, slot: Any) -> Curves:
    """The curves of the action's slot of that one's identifier; without it, of its first or new."""
    if not hasattr(action, "slots"):
        return Curves(action.fcurves, new_curve_of(action))
    wanted = slot.identifier if slot is not None else ""
    found = next((own for own in action.slots if own.identifier == wanted), None)
    if found is None:
        new = new_curve_of(action)
        return Curves(_bag(action, action.slots[0]).fcurves, new)
    bag = _bag(action, found)
    return Curves(bag.fcurves, _new_in(bag))


def _bag(action: Action, slot: Any) -> Any:
    if hasattr(anim_utils, "action_ensure_channelbag_for_slot"):
        return anim_utils.action_ensure_channelbag_for_slot(action, slot)
    layer = action.layers[0] if action.layers else action.layers.new("Layer")
    strip = layer.strips[0] if layer.strips else layer.strips.new(type="KEYFRAME")
    return strip.channelbag(slot, ensure=True)


def _new_in(bag: Any) -> NewCurve:
    if hasattr(anim_utils, "action_ensure_channelbag_for_slot"):
        return lambda path, index, group: bag.fcurves.new(path, index=index, group_name=group)

    def new_curve(path: str, index: int, group: str) -> FCurve:
        curve = bag.fcurves.new(path, index=index)
        curve.group = bag.groups.get(group) or bag.groups.new(group)
        return curve

    return new_curve


def curves_of(action: Action) -> list[FCurve]:
    """The curves of an action's only slot."""
    if not hasattr(action, "slots"):
        return list(action.fcurves)
    bags = (bag for layer in action.layers for strip in layer.strips for bag in strip.channelbags)
    return [curve for bag in bags for curve in bag.fcurves]


def assign_action(obj: Object, action: Action) -> None:
    """Assign the action to the object, with the slot of the action before if it has that one."""
    data = obj.animation_data or obj.animation_data_create()
    before = getattr(data, "action_slot", None)
    wanted = before.identifier if before is not None else ""
    data.action = action
    if hasattr(action, "slots") and action.slots:
        same = (slot for slot in action.slots if slot.identifier == wanted)
        data.action_slot = next(same, action.slots[0])


Playing = tuple[Any, Any, bool]
"""What an object plays: its action, the action's slot where there are any, and whether its strips
play too."""


def playing(obj: Object) -> Playing | None:
    """What the object plays; None for one that was never animated."""
    data = obj.animation_data
    if data is None:
        return None
    return data.action, getattr(data, "action_slot", None), data.use_nla


def play_alone(obj: Object, action: Action) -> None:
    """Let the object play this action and no strips."""
    assign_action(obj, action)
    obj.animation_data.use_nla = False


def play_again(obj: Object, before: Playing | None) -> None:
    """Let the object play what it did before."""
    if before is None:
        obj.animation_data_clear()
        return
    data = obj.animation_data or obj.animation_data_create()
    data.action, slot, data.use_nla = before
    if slot is not None:
        data.action_slot = slot


def file_handler(name: str, label: str, operator: str, endings: str) -> type:
    """A file handler that calls the operator for files dropped on a 3D view."""

    def poll_drop(cls: type, context: Context) -> bool:
        return context.area is not None and context.area.type == "VIEW_3D"

    return type(
        name,
        (bpy.types.FileHandler,),
        {
            "bl_idname": name,
            "bl_label": label,
            "bl_import_operator": operator,
            "bl_file_extensions": endings,
            "poll_drop": classmethod(poll_drop),
        },
    )


def point_shader() -> Any:
    """The bound shader that draws points of one colour."""
    try:
        shader = gpu.shader.from_builtin("POINT_UNIFORM_COLOR")
    except ValueError:  # before 5.0
        shader = gpu.shader.from_builtin(_PLAIN_SHADER)
    shader.bind()
    return shader


def plain_shader() -> Any:
    """The bound shader that fills shapes in pixels with one colour."""
    try:
        shader = gpu.shader.from_builtin(_PLAIN_SHADER)
    except ValueError:  # before 4.0
        shader = gpu.shader.from_builtin("2D_UNIFORM_COLOR")
    shader.bind()
    return shader


def is_rendering() -> bool:
    """Whether a render is running, during which nothing may be changed."""
    return bpy.app.is_job_running("RENDER")


def is_busy(context: Context) -> bool:
    """Whether nothing may be changed now: during a render, or a stroke or drag by the user."""
    modal: Any = getattr(context.window, "modal_operators", ())
    return is_rendering() or any(tool.bl_idname.startswith(_DRAGS) for tool in modal)


def play(context: Context, *, is_wanted: bool) -> None:
    """Start or stop playback; the current frame stays. Without a window nothing plays."""
    screen = context.screen
    if bpy.app.background or screen is None or screen.is_animation_playing == is_wanted:
        return
    if is_wanted:
        bpy.ops.screen.animation_play()
    else:
        bpy.ops.screen.animation_cancel(restore_frame=False)


def show_status(context: Context, text: str, fraction: float) -> None:
    """Show in the status bar what is running, its progress and how to cancel."""

    def draw(header: Header, _: Context) -> None:
        row = header.layout.row()
        if HAS_PROGRESS_BAR:
            row.label(text=text)
            row.progress(factor=fraction, text=f"{fraction:.0%}")
        else:
            row.label(text=f"{text}: {fraction:.0%}", icon="SORTTIME")
        row.label(text="Cancel", icon="EVENT_ESC")

    if context.workspace is not None:
        context.workspace.status_text_set(draw)


def clear_status(context: Context) -> None:
    """Restore Blender's own status bar."""
    if context.workspace is not None:
        context.workspace.status_text_set(None)


def redraw_views(context: Context) -> None:
    """Redraw all 3D views and file browsers."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in ("VIEW_3D", "FILE_BROWSER"):
                area.tag_redraw()
