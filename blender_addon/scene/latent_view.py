# SPDX-License-Identifier: GPL-3.0-or-later
"""The latent space of the model in the viewport: phases in colours, and where the motion is."""

from __future__ import annotations

from typing import Any

import blf
import bpy
import numpy as np
from bpy.types import Context
from mathutils import Vector

from ..session.errors import InputError
from ..session.reconstruct import kept
from ..session.training import PHASES, LatentView, latent_views
from . import compat
from . import live as live_scene
from .axes import Floats
from .drawing import points, polyline, rectangle
from .performance import facts_of, performed_action
from .settings import settings_of
from .translations import tr

# Colours that people with any colour vision tell apart (Okabe and Ito 2008), of PHASES.
_COLOURS = (
    (0.6, 0.6, 0.6, 1.0),
    (0.902, 0.624, 0.0, 1.0),
    (0.337, 0.706, 0.914, 1.0),
    (0.0, 0.62, 0.451, 1.0),
    (0.941, 0.894, 0.259, 1.0),
    (0.8, 0.475, 0.655, 1.0),
)
_HERE = (1.0, 1.0, 1.0, 1.0)
_GROUND = (0.1, 0.1, 0.1, 0.75)
_LINE = (0.4, 0.4, 0.4, 1.0)
_SIZE_PX, _MARGIN_PX, _INSET_PX, _FONT_PX = 180.0, 14.0, 12.0, 11.0
_TOP_PX = 120.0  # below the viewport's own texts

_handler: Any = None
_NOT_DRAWN = object()  # stands for the handler in the background


def is_shown() -> bool:
    """Whether the view is on."""
    return _handler is not None


def toggle(context: Context) -> bool:
    """Switch the view; returns whether it is on. Raises InputError without a model."""
    global _handler
    if is_shown():
        hide()
    else:
        if not views(context):
            raise InputError("Train or open a model first")
        _handler = _NOT_DRAWN
        if not bpy.app.background:
            _handler = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")
    compat.redraw_views(context)
    return is_shown()


def hide() -> None:
    """Draw nothing any more."""
    global _handler
    if _handler not in (None, _NOT_DRAWN):
        bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
    _handler = None


def views(context: Context) -> list[LatentView]:
    """The latent space of each type of motion in the scene's model; none without a model."""
    path = bpy.path.abspath(settings_of(context.scene).training.model)
    try:
        return latent_views(path) if path else []
    except (OSError, ValueError):
        return []


def place_now(context: Context) -> tuple[int, Floats] | None:
    """The type of motion and the place (x, y from 0 to 1) of the live pose or at the playhead."""
    shown = views(context)
    found = live_scene.latent_now() or _at_playhead(context)
    if found is None or found[0] >= len(shown):
        return None
    motion_type, latent = found
    if len(latent) != shown[motion_type].dimensions:
        return None
    return motion_type, shown[motion_type].place(latent)


def _at_playhead(context: Context) -> tuple[int, Floats] | None:
    action = performed_action(context.view_layer.objects.active)
    facts = facts_of(action) if action is not None else None
    performance = kept(facts.take) if facts is not None else None
    if facts is None or performance is None or performance.latent.shape[1] == 0:
        return None
    frame = performance.frame_at(facts.time_s(context.scene.frame_current_final))
    if frame is None or not np.isfinite(performance.latent[frame]).all():
        return None
    return int(performance.motion_types[frame]), performance.latent[frame]


def _draw() -> None:
    context = bpy.context
    if not context.space_data.overlay.show_overlays:
        return
    scale = context.preferences.system.ui_scale
    size, margin = _SIZE_PX * scale, _MARGIN_PX * scale
    now = place_now(context)
    left = _left_edge(context) + margin
    bottom = context.region.height - _TOP_PX * scale - size
    for number, shown in enumerate(views(context)):
        here = now[1] if now is not None and now[0] == number else None
        _draw_one(shown, here, (left, bottom), size, scale)
        left += size + margin
        if left + size > context.region.width:
            return


def _draw_one(
    shown: LatentView, here: Floats | None, low: tuple[float, float], size: float, scale: float
) -> None:
    inset = _INSET_PX * scale

    def pixels(places: Floats) -> list[Vector]:
        inside = np.asarray(low) + inset + (size - 2.0 * inset) * np.clip(places, -0.05, 1.05)
        return [Vector((x, y, 0.0)) for x, y in inside]

    rectangle(low, (low[0] + size, low[1] + size), _GROUND)
    for frames in shown.sequences:
        polyline(pixels(shown.points[frames]), _LINE, 1.0)
    for phase, colour in enumerate(_COLOURS[: len(PHASES)]):
        points(pixels(shown.points[shown.phases == phase]), colour, 5.0 * scale)
    if here is not None:
        points(pixels(here[None]), _HERE, 12.0 * scale)
    blf.size(0, _FONT_PX * scale)
    blf.color(0, *_HERE)
    blf.position(0, low[0] + 0.5 * inset, low[1] + size - 1.5 * _FONT_PX * scale, 0.0)
    blf.draw(0, shown.name or tr("Latent Space"))


def _left_edge(context: Context) -> float:
    """From where in the region nothing else is drawn over it."""
    if not context.preferences.system.use_region_overlap:
        return 0.0
    tools = [float(r.width) for r in context.area.regions if r.type == "TOOLS"]
    return max([0.0, *tools])
