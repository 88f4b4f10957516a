# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the plots of the paper's evaluation. Needs Matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, ScalarFormatter

from ...files import replaced
from .section import Bars, Lines, Matrix, Plot

__all__ = ["draw"]

_COLOURS = ("#1b6ca8", "#d1603d", "#3d8b5f", "#8a5a9e", "#7a7a7a", "#c2a02c", "#4f4f4f", "#b0b0b0")
_MARKS = "osD^vPX*"
_LEVEL = 0.3
_MOST_LEVEL_LABELS = 5


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
    elif all(float(x).is_integer() for xs, _ in plot.curves.values() for x in xs):
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    _set_height(axes, [value for _, y in plot.curves.values() for value in y])
    _legend(figure)
    return figure


def _set_height(axes: Axes, values: Sequence[float]) -> None:
    """Begins at 0, unless curves that are nearly level would then be one line."""
    lowest, highest = min(values), max(values)
    spread = highest - lowest
    if spread < _LEVEL * highest:
        axes.set_ylim(max(0.0, lowest - 1.5 * spread), highest + 0.5 * spread)
    else:
        axes.set_ylim(0.0, 1.08 * highest)


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
    axes.set_xticks(range(len(labels)), [label.replace(" (", "\n(") for label in labels])
    if len(labels) > _MOST_LEVEL_LABELS:
        axes.tick_params(axis="x", labelrotation=25)
    axes.set_ylim(top=1.1 * max(max(heights.values()) for heights in plot.groups.values()))
    axes.set(ylabel=plot.ylabel, title=_plain(plot.title))
    _legend(figure)
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
    axes.grid(visible=False)
    axes.set_title(_plain(plot.title))
    figure.colorbar(image, ax=axes, label="cm")
    return figure


def _figure(width: float, height: float) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(width, height), layout="constrained")
    axes = figure.add_subplot()
    axes.grid(axis="y", color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    return figure, axes


def _legend(figure: Figure) -> None:
    figure.legend(loc="outside lower center", frameon=False, fontsize="small", ncols=2)


def _plain(text: str) -> str:
    """Returns a text without the marks of Markdown."""
    return text.replace("`", "")
