# SPDX-License-Identifier: GPL-3.0-or-later
"""The pose that the performer imitates, drawn in the viewports, with what to do and a countdown."""

from __future__ import annotations

import math
from typing import Any

import bpy
from mathutils import Vector

from ..session import job as jobs
from ..session import pose_guide
from ..session.pose_guide import CALIBRATING_BY_POSES
from . import drawing
from .prompt import LARGEST_PX, free_view, instruction, line
from .translations import tr

_READY = (0.35, 0.65, 1.0, 1.0)
_HELD = (0.3, 0.9, 0.4, 1.0)
_WIDTH_PX = 6.0
_JOINT_PX = 9.0
_CAPTION_PX = 24.0
_SHARE = 0.45
"""Of the viewport's height that the figures take."""

_handler: Any = None


def show() -> None:
    """Show the poses while such a calibration is running."""
    global _handler
    if _handler is None:
        _handler = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")


def hide() -> None:
    """Remove the poses from the viewports."""
    global _handler
    if _handler is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
        _handler = None


def _draw() -> None:
    job, now = jobs.current(), pose_guide.shown
    if job is None or job.label != CALIBRATING_BY_POSES or job.is_cancelled or not now.pose:
        return
    left, width, height = free_view()
    _figures(now.pose, _HELD if now.is_held else _READY, left, width, height)
    y = instruction(tr(pose_guide.POSE_TEXTS[now.pose]), left, width, 0.32 * height)
    what = tr(pose_guide.HOLD if now.is_held else pose_guide.READY)
    y -= 1.3 * LARGEST_PX
    line(f"{what}: {math.ceil(now.seconds)}", LARGEST_PX, left, width, y)
    more = now.problem
    if now.missed_deg is not None:
        more = tr(pose_guide.MISSED).format(degrees=round(now.missed_deg))
    if more:
        line(more, 0.5 * LARGEST_PX, left, width, y - 0.9 * LARGEST_PX)


def _figures(pose: str, colour: drawing.Colour, left: float, width: float, height: float) -> None:
    """The pose as in a mirror, and beside it as seen from the performer's right."""
    points, parents = pose_guide.points_of(pose)
    lowest = float(points[:, 1].min())
    scale = min(_SHARE * height / 2.1, 0.4 * width / 2.1)  # px a metre; arms reach up or out
    for number, (view, places) in enumerate(pose_guide.views_of(points).items()):
        begin = left + 0.5 * width * number
        across = begin + 0.25 * width
        line(tr(view), _CAPTION_PX, begin, 0.5 * width, 0.4 * height + 2.3 * scale)
        drawn = [
            Vector((across + scale * float(x), 0.4 * height + scale * (float(y) - lowest), 0.0))
            for x, y in places
        ]
        ends = [
            drawn[k] for joint, parent in enumerate(parents) if parent >= 0 for k in (parent, joint)
        ]
        drawing.lines(ends, colour, _WIDTH_PX)
        drawing.points(drawn, colour, _JOINT_PX)
