# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots of a latent space with its phases. Needs Matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .files import replaced
from .latent_space import PHASES, LatentMap

__all__ = ["plot_latent_space"]

Floats = NDArray[np.float64]

_COLOURS = ("#7a7a7a", "#2aa7a7", "#8a5a9e", "#c2a02c", "#d1603d", "#3d8b5f")  # of PHASES


def plot_latent_space(
    maps: Sequence[LatentMap], path: Path, take: tuple[Floats, NDArray[np.int64]] | None = None
) -> Path:
    """Writes a picture of each type of motion, its frames in the colours of their phases.

    take: the latent points (T, D) of a reconstructed take and the type of each, drawn over them.
    """
    figure = Figure((5.0 * len(maps), 5.0), layout="constrained")
    for index, (axes, shown) in enumerate(
        zip(figure.subplots(1, len(maps), squeeze=False)[0], maps, strict=True)
    ):
        for frames in shown.sequences():
            axes.plot(*shown.points[frames].T, color="#d8d8d8", linewidth=0.8, zorder=0)
        for phase, (name, colour) in enumerate(zip(PHASES, _COLOURS, strict=True)):
            here = shown.points[shown.phases == phase]
            if len(here):
                label = name.replace("_", " ")
                axes.scatter(*here.T, s=14, color=colour, label=label)
        if take is not None:
            own = shown.placed(take[0][take[1] == index])
            axes.plot(*own.T, color="black", linewidth=0.8, alpha=0.6, label="take")
        axes.set_title(shown.name or "latent space")
        axes.set_aspect("equal", "datalim")
        axes.legend(frameon=False, fontsize="small")
    with replaced(path) as temporary:
        figure.savefig(temporary, format="png", dpi=120)
    return path
