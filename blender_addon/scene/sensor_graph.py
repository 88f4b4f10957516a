# SPDX-License-Identifier: GPL-3.0-or-later
"""A graph in the viewport of what each sensor measured and what it should read on the result."""

from __future__ import annotations

from typing import Any

import blf
import bpy
import numpy as np
from bpy.types import Context
from mathutils import Vector

from ..session.certainty import SensorCurves
from ..session.errors import InputError
from ..session.names import shown_site
from ..session.reconstruct import Performance, kept
from . import compat
from .axes import Floats
from .drawing import Colour, lines, polyline, rectangle
from .performance import Facts, facts_of, performed_action
from .translations import tr

HALF_S = 2.5
"""How much is shown before and after the playhead."""

# Colours that people with any colour vision tell apart (Okabe and Ito 2008); one line is dashed.
_MEASURED = (0.337, 0.706, 0.914, 1.0)
_EXPECTED = (0.902, 0.624, 0.0, 1.0)
_PLAYHEAD = (1.0, 1.0, 1.0, 0.9)
_GROUND = (0.1, 0.1, 0.1, 0.75)
_WORDS = (0.95, 0.95, 0.95, 1.0)

_Part = tuple[str, Colour]

_ROW_PX, _GAP_PX, _MARGIN_PX, _FONT_PX, _LABEL_PX = 52.0, 6.0, 14.0, 11.0, 17.0
_BOTTOM_PX = 40.0  # above the settings of the last operator
_LEAST_TOP_MPS2 = 15.0

_handler: Any = None


def is_shown() -> bool:
    """Whether the graph is on."""
    return _handler is not None


def toggle(context: Context) -> bool:
    """Switch the graph; returns whether it is on. Raises InputError without a take."""
    if is_shown():
        hide()
        compat.redraw_views(context)
        return False
    if _shown_take(context) is None:
        raise InputError(
            "Select a character with a take that was reconstructed since Blender was started"
        )
    _show()
    compat.redraw_views(context)
    return True


def hide() -> None:
    """Draw nothing any more."""
    global _handler
    if _handler not in (None, _NOT_DRAWN):
        bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
    _handler = None


_NOT_DRAWN = object()  # stands for the handler in the background


def _show() -> None:
    global _handler
    _handler = _NOT_DRAWN
    if not bpy.app.background:
        _handler = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL")


def curves_at_playhead(context: Context) -> SensorCurves | None:
    """What is shown: around the playhead, which is at 0 s; None without a take."""
    found = _shown_take(context)
    if found is None:
        return None
    facts, performance = found
    time_s = facts.time_s(context.scene.frame_current_final)
    if performance.curves is None or not np.isfinite(time_s):
        return None
    return performance.curves.around(time_s, HALF_S)


def _shown_take(context: Context) -> tuple[Facts, Performance] | None:
    """The take that the active character plays."""
    action = performed_action(context.view_layer.objects.active)
    facts = facts_of(action) if action is not None else None
    performance = kept(facts.take) if facts is not None else None
    if facts is None or performance is None or performance.curves is None:
        return None
    return facts, performance


def _draw() -> None:
    context = bpy.context
    if not context.space_data.overlay.show_overlays:
        return
    curves = curves_at_playhead(context)
    if curves is None:
        return
    scale = context.preferences.system.ui_scale
    left, right = _free_width(context)
    left, right = left + _MARGIN_PX * scale, right - _MARGIN_PX * scale
    row, bottom = _ROW_PX * scale, _BOTTOM_PX * scale
    if right - left < 2.0 * row:
        return
    top = max(curves.largest, _LEAST_TOP_MPS2)
    for number, site in enumerate(reversed(curves.sites)):
        sensor = len(curves.sites) - 1 - number
        low = (left, bottom + number * (row + _GAP_PX * scale))
        high = (right, low[1] + row)
        rectangle(low, high, _GROUND)
        _plot(curves, sensor, low, (right, high[1] - _LABEL_PX * scale), top)
        _write(curves, sensor, shown_site(site), low, high, scale)


def _plot(
    curves: SensorCurves,
    sensor: int,
    low: tuple[float, float],
    high: tuple[float, float],
    top: float,
) -> None:
    (left, bottom), (right, above) = low, high
    x = left + (right - left) * (curves.times_s + HALF_S) / (2.0 * HALF_S)

    def places(values: Floats) -> list[Vector]:
        known = np.isfinite(values)
        y = bottom + (above - bottom) * values[known] / top
        return [Vector((a, b, 0.0)) for a, b in zip(x[known], y, strict=True)]

    polyline(places(curves.measured[:, sensor]), _MEASURED, 2.0)
    expected = places(curves.expected[:, sensor])
    for begin in range(0, len(expected), 3):  # dashes of two steps and gaps of one
        polyline(expected[begin : begin + 3][:2], _EXPECTED, 2.0)
    middle = 0.5 * (left + right)
    lines([Vector((middle, bottom, 0.0)), Vector((middle, above, 0.0))], _PLAYHEAD, 1.0)


def _write(
    curves: SensorCurves,
    sensor: int,
    site: str,
    low: tuple[float, float],
    high: tuple[float, float],
    scale: float,
) -> None:
    """The sensor's name and its values at the playhead, as far as there is room."""
    if len(curves.times_s) == 0:
        return
    now = int(np.argmin(np.abs(curves.times_s)))
    measured, expected = curves.measured[now, sensor], curves.expected[now, sensor]
    name, numbers = (tr(site), _WORDS), (f"{measured:.1f}", f"{expected:.1f}")
    words = (tr("measured {value}"), tr("expected {value} m/s²"))
    told = [word.format(value=number) for word, number in zip(words, numbers, strict=True)]
    versions = [
        [name, *zip(values, (_MEASURED, _EXPECTED), strict=True)] for values in (told, numbers)
    ]
    blf.size(0, _FONT_PX * scale)
    gap = _GAP_PX * scale
    parts = _first_that_fits([*versions, [name]], high[0] - low[0] - 2.0 * gap, 3.0 * gap)
    x = low[0] + gap
    y = low[1] + (_ROW_PX - _FONT_PX - 3.0) * scale
    blf.enable(0, blf.CLIPPING)
    blf.clipping(0, *low, *high)
    for text, colour in parts:
        blf.color(0, *colour)
        blf.position(0, x, y, 0.0)
        blf.draw(0, text)
        x += blf.dimensions(0, text)[0] + 3.0 * gap
    blf.disable(0, blf.CLIPPING)


def _first_that_fits(versions: list[list[_Part]], room: float, gap: float) -> list[_Part]:
    """The last one where none does."""
    for parts in versions[:-1]:
        lengths = [blf.dimensions(0, text)[0] for text, _ in parts]
        if sum(lengths) + gap * (len(parts) - 1) <= room:
            return parts
    return versions[-1]


def _free_width(context: Context) -> tuple[float, float]:
    """From where to where in the region nothing else is drawn over it."""
    left, right = 0.0, float(context.region.width)
    if not context.preferences.system.use_region_overlap:
        return left, right
    for region in context.area.regions:
        if region.type == "TOOLS":
            left = max(left, float(region.width))
        elif region.type == "UI" and region.width > 1:
            right = min(right, float(context.region.width - region.width))
    return left, right
