# SPDX-License-Identifier: GPL-3.0-or-later
"""Points and lines of one colour in a viewport, in three dimensions or in pixels."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import gpu
from gpu_extras.batch import batch_for_shader
from mathutils import Vector

from . import compat

Colour = tuple[float, float, float, float]
_MOST_DASHES = 60


def points(places: Sequence[Vector], colour: Colour, size_px: float) -> None:
    """Draw points."""
    if not places:
        return
    shader = compat.point_shader()
    gpu.state.point_size_set(size_px)
    shader.uniform_float("color", colour)
    batch_for_shader(shader, "POINTS", {"pos": places}).draw(shader)


def lines(ends: Sequence[Vector], colour: Colour, width_px: float) -> None:
    """Draw a line between the ends of each pair."""
    if not ends:
        return
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width_px)
    shader.uniform_float("color", colour)
    batch_for_shader(shader, "LINES", {"pos": ends}).draw(shader)


def polyline(places: Sequence[Vector], colour: Colour, width_px: float) -> None:
    """Draw a line through all places."""
    lines([place for pair in pairwise(places) for place in pair], colour, width_px)


def rectangle(lowest: tuple[float, float], highest: tuple[float, float], colour: Colour) -> None:
    """Fill a rectangle in pixels."""
    (left, bottom), (right, top) = lowest, highest
    corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
    shader = compat.plain_shader()
    shader.uniform_float("color", colour)
    indices = [(0, 1, 2), (0, 2, 3)]
    batch_for_shader(shader, "TRIS", {"pos": corners}, indices=indices).draw(shader)


def square(middle: Vector, half: float) -> list[Vector]:
    """The ends of the lines of a level square."""
    corners = [
        middle + Vector((half * x, half * y, 0.0)) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))
    ]
    return [
        corner for pair in zip(corners, [*corners[1:], corners[0]], strict=True) for corner in pair
    ]


def dashes(begin: Vector, end: Vector, length: float) -> list[Vector]:
    """The ends of dashes between two places, as long as the gaps between them."""
    along = end - begin
    count = min(max(round(along.length / max(length, 1e-9)), 1), _MOST_DASHES)
    steps = [begin + along * (number / count) for number in range(count + 1)]
    found = []
    for number in range(0, count, 2):
        found += [steps[number], steps[number + 1]]
    return found
