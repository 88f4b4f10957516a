# SPDX-License-Identifier: GPL-3.0-or-later
"""What the performer is to do, written so large in the viewports that it is read from afar."""

from __future__ import annotations

from typing import Any

import blf
import bpy

from ..session import job as jobs
from ..session.calibrating import CALIBRATING

_FONT = 0
_LARGEST_PX = 64.0
_COLOUR = (1.0, 0.75, 0.2, 1.0)
_SHADOW = (0.0, 0.0, 0.0, 0.9)

_handler: Any = None


def show() -> None:
    """Write what the calibration at work says, as long as it does."""
    global _handler
    if _handler is None:
        _handler = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")


def hide() -> None:
    """Leave the viewports as they were."""
    global _handler
    if _handler is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
        _handler = None


def _draw() -> None:
    job = jobs.current()
    if job is None or job.label != CALIBRATING or job.is_cancelled:
        return
    text, _, seconds = job.what.rpartition(": ")
    region = bpy.context.region
    _line(text, region.width, 0.62 * region.height)
    _line(seconds, region.width, 0.5 * region.height)


def _line(text: str, width: int, y: float) -> None:
    """Centred, and as large as the width allows."""
    blf.size(_FONT, _LARGEST_PX)
    length = blf.dimensions(_FONT, text)[0]
    if length > 0.9 * width:
        blf.size(_FONT, _LARGEST_PX * 0.9 * width / length)
        length = blf.dimensions(_FONT, text)[0]
    blf.enable(_FONT, blf.SHADOW)
    blf.shadow(_FONT, 5, *_SHADOW)
    blf.color(_FONT, *_COLOUR)
    blf.position(_FONT, 0.5 * (width - length), y, 0.0)
    blf.draw(_FONT, text)
    blf.disable(_FONT, blf.SHADOW)
