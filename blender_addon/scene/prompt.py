# SPDX-License-Identifier: GPL-3.0-or-later
"""Instructions for the performer, in large letters in the viewports."""

from __future__ import annotations

from typing import Any

import blf
import bpy

from ..session import job as jobs
from ..session.calibrating import CALIBRATING
from .translations import tr

_FONT = 0
LARGEST_PX = 64.0
_COLOUR = (1.0, 0.75, 0.2, 1.0)
_SHADOW = (0.0, 0.0, 0.0, 0.9)

_handler: Any = None
_countdown = 0


def show() -> None:
    """Show the instructions while a calibration is running."""
    global _handler
    if _handler is None:
        _handler = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")


def show_countdown(seconds: int) -> None:
    """Show how many seconds are left; 0 ends it."""
    global _countdown
    _countdown = seconds
    if seconds > 0:
        show()
    elif jobs.current() is None:
        hide()


def hide() -> None:
    """Remove the instructions from the viewports."""
    global _handler
    if _handler is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
        _handler = None


def _draw() -> None:
    if _countdown > 0:
        left, width, height = free_view()
        line(tr("Recording starts in"), 0.5 * LARGEST_PX, left, width, 0.62 * height)
        line(str(_countdown), 2.5 * LARGEST_PX, left, width, 0.62 * height - 3.0 * LARGEST_PX)
        return
    job = jobs.current()
    if job is None or job.label != CALIBRATING or job.is_cancelled:
        return
    what, _, seconds = job.what.rpartition(": ")
    headline, _, hint = tr(what).partition(", ")
    left, width, height = free_view()
    line(headline, LARGEST_PX, left, width, 0.62 * height)
    line(hint, 0.5 * LARGEST_PX, left, width, 0.62 * height - 0.9 * LARGEST_PX)
    line(seconds, 1.5 * LARGEST_PX, left, width, 0.62 * height - 2.8 * LARGEST_PX)


def free_view() -> tuple[float, float, float]:
    """Left edge, width and height of the viewport without sidebar and toolbar, px."""
    whole, left, right = bpy.context.region, 0.0, 0.0
    if bpy.context.preferences.system.use_region_overlap:
        for region in bpy.context.area.regions:
            if region.type == "UI" and region.width > 1:
                right = region.width
            elif region.type == "TOOLS" and region.width > 1:
                left = region.width
    return left, max(whole.width - left - right, 1.0), whole.height


def line(text: str, size: float, left: float, width: float, y: float) -> None:
    """Draw the text centred, smaller if it would not fit."""
    blf.size(_FONT, size)
    length = blf.dimensions(_FONT, text)[0]
    if length > 0.9 * width:
        blf.size(_FONT, size * 0.9 * width / length)
        length = blf.dimensions(_FONT, text)[0]
    blf.enable(_FONT, blf.SHADOW)
    blf.shadow(_FONT, 5, *_SHADOW)
    blf.color(_FONT, *_COLOUR)
    blf.position(_FONT, left + 0.5 * (width - length), y, 0.0)
    blf.draw(_FONT, text)
    blf.disable(_FONT, blf.SHADOW)
