# SPDX-License-Identifier: GPL-3.0-or-later
"""The characters that the scene's takes are put on."""

from __future__ import annotations

from bpy.types import Context, Object

from ..session.bake import Placement
from ..session.errors import InputError
from ..session.retarget import Target
from .armature import editable, is_ours
from .binding import bind
from .settings import settings_of


def chosen_armatures(context: Context) -> list[Object]:
    """The scene's character and, if wanted, the other selected ones; none for a new figure."""
    settings = settings_of(context.scene)
    chosen = [settings.target] if settings.target is not None else []
    if settings.to_selected:
        selected = (obj for obj in context.view_layer.objects if obj.select_get())
        chosen += [obj for obj in selected if obj.type == "ARMATURE" and obj not in chosen]
    return chosen


def placement_of(
    context: Context,
    armatures: list[Object],
    *,
    start_frame: float,
    whole_frames: bool,
) -> Placement:
    """The placement on these characters, of which the add-on's own figure is none.

    Raises InputError when a character cannot be animated.
    """
    render = context.scene.render
    targets = [bind(context, editable(obj)) for obj in armatures if not is_ours(obj)]
    return Placement(start_frame, render.fps / render.fps_base, whole_frames, tuple(targets))


def own_figure(armatures: list[Object]) -> Object | None:
    """The add-on's own figure among them. Raises InputError when there are several."""
    own = [obj for obj in armatures if is_ours(obj)]
    if len(own) > 1:
        raise InputError("Several Sparse Mocap figures are chosen: choose one of them")
    return editable(own[0]) if own else None


def held_warning(target: Target) -> str:
    """One line on bones of a character that do not follow."""
    names = ", ".join(target.held[:3]) + (" and others" if len(target.held) > 3 else "")
    return f'"{target.armature}": held by constraints or drivers and may not follow: {names}'
