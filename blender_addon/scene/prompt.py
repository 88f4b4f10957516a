# SPDX-License-Identifier: GPL-3.0-or-later
"""Instructions for the performer, in large letters in the viewports."""

from __future__ import annotations

import textwrap
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


def countdown_s() -> int:
    """How many seconds are left; 0: nothing is counted."""
    return _countdown


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
    left, width, height = free_view()
    y = instruction(tr(what), left, width, 0.62 * height)
    line(seconds, 1.5 * LARGEST_PX, left, width, y - 1.9 * LARGEST_PX)


def instruction(text: str, left: float, width: float, y: float) -> float:
    """Draw what to do in large letters, and how below, which is behind the first comma.

    Returns where the last line is.
    """
    headline, _, hint = text.partition(", ")
    line(headline, LARGEST_PX, left, width, y)
    y -= 0.9 * LARGEST_PX
    for number, part in enumerate(_halves(hint, 0.5 * LARGEST_PX, 0.9 * width)):
        y -= 0.7 * LARGEST_PX * (number > 0)
        line(part, 0.5 * LARGEST_PX, left, width, y)
    return y


def _halves(text: str, size: float, room: float) -> list[str]:
    """The text, on two lines if it is too long for one."""
    blf.size(_FONT, size)
    if blf.dimensions(_FONT, text)[0] <= room:
        return [text]
    widths = range(len(text) // 2, len(text))
    parts = (textwrap.wrap(text, most, break_long_words=False) for most in widths)
    return next((halves for halves in parts if len(halves) == 2), [text])


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
