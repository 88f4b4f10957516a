# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots of motions. Needs Matplotlib."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ._core import Motion
from .files import replaced
from .inspection import Inspection

__all__ = ["plot_inspections"]

Floats = NDArray[np.float64]

_NUM_FRAMES = 6
_TURN_RAD = math.radians(35.0)
"""View slightly from the figure's left, so that arms and legs do not hide each other."""


def plot_inspections(inspections: Sequence[Inspection], path: Path) -> Path:
    """Writes a sheet: a row of six frames for each file, its skeleton next to the standard one.

    Files that were rejected have an empty row with the reason.
    """
    rows = len(inspections)
    figure = Figure(figsize=(2.6 * _NUM_FRAMES, 2.5 * rows), layout="constrained")
    grid = figure.subplots(rows, _NUM_FRAMES, squeeze=False)
    for inspection, cells in zip(inspections, grid, strict=True):
        title = f"{inspection.path.parent.name}/{inspection.path.name}"
        if inspection.mapping is not None:
            title += f"   {inspection.worst_error_deg:.1f}° at worst"
        cells[0].set_title(title, loc="left", fontsize=9)
        for cell in cells:
            cell.set_axis_off()
        if inspection.standard is None:
            cells[0].text(0.0, 0.5, f"rejected: {inspection.refusal}", fontsize=8)
        else:
            _draw_row(inspection, cells)
    with replaced(path) as temporary:
        figure.savefig(temporary, dpi=80)
    return path


def _draw_row(inspection: Inspection, cells: Sequence[Axes]) -> None:
    motion, mapping, standard = inspection.motion, inspection.mapping, inspection.standard
    assert motion is not None
    assert mapping is not None
    assert standard is not None
    lead = motion.num_frames - standard.num_frames
    own_root = motion.skeleton.names.index(mapping.joints["root"])
    for cell, frame in zip(cells, _spread(standard.num_frames), strict=True):
        own = motion.trimmed(lead + frame, lead + frame + 1)
        bones = mapping.unit_scale * _bones(own) @ mapping.R_world_file.T
        _draw(cell, bones, bones[own_root, 0], "#1b6ca8", -0.75)
        bones = _bones(standard.trimmed(frame, frame + 1))
        _draw(cell, bones, bones[0, 0], "#d1603d", 0.75)
        cell.set_aspect("equal")
        cell.set_xlim(-1.7, 1.7)
        cell.set_ylim(-1.2, 1.2)


def _spread(num_frames: int) -> NDArray[np.int64]:
    return np.linspace(0, num_frames - 1, _NUM_FRAMES).round().astype(np.int64)


def _bones(motion: Motion) -> Floats:
    """(2J, 2, 3): ends of each joint's bone, and of the link from its parent's bone."""
    pivots, ends = motion.pivot_positions()[0], motion.joint_positions("world")[0]
    parents = np.maximum(motion.skeleton.parents, 0)
    return np.concatenate([np.stack([pivots, ends], 1), np.stack([ends[parents], pivots], 1)])


def _draw(cell: Axes, bones: Floats, centre: Floats, colour: str, x: float) -> None:
    around = bones - centre
    across = around[..., 0] * math.cos(_TURN_RAD) - around[..., 2] * math.sin(_TURN_RAD)
    lines = np.stack([across + x, around[..., 1]], axis=-1)
    cell.add_collection(LineCollection(list(lines), colors=colour, linewidths=1.4))
