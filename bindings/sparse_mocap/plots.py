# SPDX-License-Identifier: GPL-3.0-or-later
"""Plots of errors. Needs Matplotlib."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from .evaluation.result import HISTOGRAM_BIN_CM, Evaluation
from .files import replaced

__all__ = ["plot_errors_over_time", "plot_evaluation"]

Floats = NDArray[np.float64]

_MOST_TESTS_OVER_TIME = 12
_COLOURS = ("#1b6ca8", "#d1603d", "#3d8b5f", "#8a5a9e", "#7a7a7a", "#c2a02c", "#4f4f4f", "#b0b0b0")


def plot_evaluation(evaluation: Evaluation, folder: Path) -> list[Path]:
    """Writes the evaluation's plots to a folder and returns their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    prefix = f"scenario{evaluation.scenario}"
    return [
        *_angles_over_time(evaluation, folder),
        _histogram(evaluation, folder / f"{prefix}_histogram.png"),
        _bars(
            {method: evaluation.class_errors_cm(method) for method in evaluation.methods},
            f"Scenario {evaluation.scenario}: mean error in each class",
            folder / f"{prefix}_classes.png",
        ),
        _bars(
            {method: evaluation.joint_errors_cm(method) for method in evaluation.methods},
            f"Scenario {evaluation.scenario}: mean error of each joint",
            folder / f"{prefix}_joints.png",
        ),
    ]


def _angles_over_time(evaluation: Evaluation, folder: Path) -> list[Path]:
    """Writes a plot a test of the errors of its joint angles, frame by frame.

    It is as figure 7 of Liu et al. 2011; for evaluations of few tests.
    """
    written = []
    for test in evaluation.tests if len(evaluation.tests) <= _MOST_TESTS_OVER_TIME else []:
        curves = {}
        for method, result in test.results.items():
            errors = result.euler_errors_deg
            if errors is not None and len(errors) == test.num_frames:
                curves[method] = (np.arange(len(errors)) / evaluation.settings["rate_hz"], errors)
        if curves:
            path = folder / f"scenario{evaluation.scenario}_{test.name}_angles.png"
            written.append(plot_errors_over_time(curves, test.name, path, "degrees an angle"))
    return written


def plot_errors_over_time(
    curves: Mapping[str, tuple[Floats, Floats]], title: str, path: Path, unit: str = "cm"
) -> Path:
    """Writes a plot of errors over times (s), with each curve's mean."""
    figure, axes = _figure(9.0, 4.0)
    for colour, (name, (times, errors)) in zip(_COLOURS, curves.items(), strict=False):
        mean = float(errors.mean())
        axes.plot(times, errors, color=colour, linewidth=1.4, label=f"{name}, mean {mean:.1f}")
        axes.axhline(mean, color=colour, linewidth=1.0, linestyle="--")
    axes.set(xlabel="time (s)", ylabel=f"error ({unit})", title=title)
    axes.margins(x=0.01, y=0.2)
    axes.set_ylim(bottom=0)
    columns = min(len(curves), 3)
    size = "medium" if len(curves) <= columns else "small"
    axes.legend(frameon=False, loc="upper left", ncols=columns, fontsize=size)
    return _saved(figure, axes, path)


def _histogram(evaluation: Evaluation, path: Path) -> Path:
    figure, axes = _figure(8.0, 4.5)
    for colour, method in zip(_COLOURS, evaluation.methods, strict=False):
        errors = evaluation.frame_errors_cm(method)
        num_bins = int(errors.max() / HISTOGRAM_BIN_CM) + 1
        shares, edges = np.histogram(errors, num_bins, (0.0, num_bins * HISTOGRAM_BIN_CM))
        axes.stairs(100 * shares / len(errors), edges, color=colour, linewidth=1.4, label=method)
    axes.set(
        xlabel="RMS error over the joints (cm)",
        ylabel=f"frames (%) in bins of {HISTOGRAM_BIN_CM:g} cm",
        title=f"Scenario {evaluation.scenario}: error of each frame",
    )
    axes.set_xlim(left=0)
    _legend_beside(axes)
    return _saved(figure, axes, path)


def _bars(groups: Mapping[str, Mapping[str, float]], title: str, path: Path) -> Path:
    labels = list(next(iter(groups.values())))
    figure, axes = _figure(max(8.0, 0.15 * len(labels) * (len(groups) + 1)), 5.0)
    width = 0.85 / len(groups)
    for i, (name, values) in enumerate(groups.items()):
        places = np.arange(len(labels)) + (i - (len(groups) - 1) / 2) * width
        heights = [values[label] for label in labels]
        axes.bar(places, heights, width, color=_COLOURS[i % len(_COLOURS)], label=name)
    axes.set_xticks(range(len(labels)), labels, rotation=45, ha="right")
    axes.set(ylabel="mean error (cm)", title=title)
    axes.margins(x=0.01)
    _legend_beside(axes)
    return _saved(figure, axes, path)


def _figure(width: float, height: float) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.add_subplot()


def _legend_beside(axes: Axes) -> None:
    axes.legend(frameon=False, fontsize="small", loc="upper left", bbox_to_anchor=(1.0, 1.0))


def _saved(figure: Figure, axes: Axes, path: Path) -> Path:
    axes.grid(axis="y", color="#dddddd", linewidth=0.6)
    axes.set_axisbelow(True)
    with replaced(path) as temporary:
        figure.savefig(temporary, dpi=130)
    return path
