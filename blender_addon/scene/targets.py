# SPDX-License-Identifier: GPL-3.0-or-later
"""The characters that the scene's takes are put on."""

from __future__ import annotations

from dataclasses import replace

from bpy.types import Context, Object

from ..session.bake import Placement
from ..session.character import FootLock
from ..session.errors import InputError
from ..session.retarget import Target
from .armature import editable, is_ours, units_per_metre
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
    render, settings = context.scene.render, settings_of(context.scene)
    others = [editable(obj) for obj in armatures if not is_ours(obj)]
    targets = [bound(context, armature) for armature in others]
    lock = foot_lock_of(context)
    errors = (settings.largest_error_deg, settings.largest_error_cm)
    return Placement(
        start_frame,
        render.fps / render.fps_base,
        whole_frames,
        part_s=(settings.range_begin_s, settings.range_end_s) if settings.use_range else None,
        smooth_s=settings.smooth_s,
        largest_errors=errors if settings.reduce_keys else None,
        lock=lock,
        targets=tuple(targets),
    )


def foot_lock_of(context: Context) -> FootLock:
    """The scene's choice of how feet are kept where they stand."""
    settings = settings_of(context.scene)
    return FootLock(
        settings.foot_lock,
        settings.least_certainty,
        settings.fastest_foot_mps,
        settings.highest_foot_m,
    )


def bound(context: Context, armature: Object) -> Target:
    """The character with the scene's choice of limbs and floor. Raises InputError."""
    settings = settings_of(context.scene)
    target = bind(context, armature, settings.limbs)
    if settings.floor is None:
        return target
    above = settings.floor.matrix_world.translation.z - armature.matrix_world.translation.z
    return replace(target, floor_m=above / units_per_metre(context.scene))


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
