# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the plots of the paper's evaluation. Needs Matplotlib."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import ScalarFormatter

from ...files import replaced
from .section import Bars, Lines, Matrix, Plot

__all__ = ["draw"]

_COLOURS = ("#1b6ca8", "#d1603d", "#3d8b5f", "#8a5a9e", "#7a7a7a", "#c2a02c", "#4f4f4f", "#b0b0b0")
_MARKS = "osD^vPX*"


def draw(plot: Plot, path: Path) -> Path:
    """Writes a plot as a PNG file and returns its path."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if isinstance(plot, Lines):
        figure = _lines(plot)
    elif isinstance(plot, Bars):
        figure = _bars(plot)
    else:
        figure = _matrix(plot)
    with replaced(path) as temporary:
        figure.savefig(temporary, dpi=110)
    return path


def _lines(plot: Lines) -> Figure:
    figure, axes = _figure(8.0, 4.2)
    for k, (label, (x, y)) in enumerate(plot.curves.items()):
        style: dict[str, Any] = {
            "color": _COLOURS[k % len(_COLOURS)],
            "linewidth": 1.6,
            "label": _plain(label),
        }
        if plot.has_steps:
            axes.step(x, y, where="post", **style)
        else:
            marker = _MARKS[k % len(_MARKS)] if plot.has_points else None
            axes.plot(x, y, marker=marker, markersize=5, **style)
    axes.set(xlabel=plot.xlabel, ylabel=plot.ylabel, title=_plain(plot.title))
    if plot.is_logarithmic:
        axes.set_xscale("log", base=2)
        axes.set_xticks(next(iter(plot.curves.values()))[0])
        axes.xaxis.set_major_formatter(ScalarFormatter())
    axes.set_ylim(bottom=0)
    _legend(axes, len(plot.curves))
    return figure


def _bars(plot: Bars) -> Figure:
    labels = list(next(iter(plot.groups.values())))
    figure, axes = _figure(max(8.0, 0.16 * len(labels) * (len(plot.groups) + 1)), 4.8)
    width = 0.85 / len(plot.groups)
    for k, (name, heights) in enumerate(plot.groups.items()):
        places = np.arange(len(labels)) + (k - (len(plot.groups) - 1) / 2) * width
        values = [heights[label] for label in labels]
        bars = axes.bar(
            places, values, width, color=_COLOURS[k % len(_COLOURS)], label=_plain(name)
        )
        if len(labels) * len(plot.groups) <= 16:
            axes.bar_label(bars, fmt="%.1f", fontsize="small", padding=2)
    turned = 30 if max(map(len, labels)) * len(labels) > 90 else 0
    axes.set_xticks(range(len(labels)), labels, rotation=turned, ha="right" if turned else "center")
    axes.set(ylabel=plot.ylabel, title=_plain(plot.title))
    _legend(axes, len(plot.groups))
    return figure


def _matrix(plot: Matrix) -> Figure:
    values = np.array(plot.values, float)
    figure, axes = _figure(3.2 + 0.75 * len(plot.columns), 1.2 + 0.29 * len(plot.rows))
    image = axes.imshow(values, aspect="auto", cmap="RdYlBu_r")
    middle = 0.5 * (np.nanmin(values) + np.nanmax(values))
    reach = max(0.5 * (np.nanmax(values) - np.nanmin(values)), 1e-9)
    for (row, column), value in np.ndenumerate(values):
        if not np.isnan(value):
            is_dark = abs(value - middle) > 0.75 * reach
            axes.text(
                column, row, f"{value:.1f}", ha="center", va="center", fontsize="small",
                color="white" if is_dark else "black",
            )  # fmt: skip
    axes.set_xticks(range(len(plot.columns)), plot.columns)
    axes.set_yticks(range(len(plot.rows)), plot.rows, fontsize="small")
    axes.xaxis.tick_top()
    axes.set_title(_plain(plot.title))
    figure.colorbar(image, ax=axes, label="cm")
    return figure


def _figure(width: float, height: float) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.add_subplot()
    axes.grid(axis="y", color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    return figure, axes


def _legend(axes: Axes, count: int) -> None:
    if count > 4:
        axes.legend(
            frameon=False,
            fontsize="small",
            loc="upper center",
            bbox_to_anchor=(0.5, -0.14),
            ncols=2,
        )
    else:
        axes.legend(frameon=False, fontsize="small")


def _plain(text: str) -> str:
    """Returns a text without the marks of Markdown."""
    return text.replace("`", "")
