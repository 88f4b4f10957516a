# SPDX-License-Identifier: GPL-3.0-or-later
"""What the paper's method is made of: figures 9b and 11, sections 4 and 5.3 of Tautges et al."""

from __future__ import annotations

from typing import Any

import numpy as np

from ... import graph_times
from ..runner import Settings
from .common import (
    LIVE,
    PAPER,
    SCENARIO_NAMES,
    cm,
    difference,
    mean_cm,
    plain,
    told_difference,
    variant,
)
from .runs import Found, Runs
from .section import Bars, Lines, Section, Table

__all__ = ["energy", "graph", "priors", "window"]

WINDOWS = (1, 2, 4, 8, 16, 32, 64)
WAYS: dict[str, dict[str, Any]] = {
    "energy, warping": {},
    "energy, no warping": {"is_time_warping": False},
    "plain mean, warping": {"pose": "mean"},
    "plain mean, no warping": {"pose": "mean", "is_time_warping": False},
}
PRIORS: dict[str, dict[str, Any]] = {
    "kernel regression (the paper's)": {"prior": "kernel"},
    "Mahalanobis distance for every term": {"prior": "mahalanobis"},
    "normal distribution of poses, least acceleration (Chai and Hodgins)": {"prior": "normal"},
    "no energy: weighted mean of the paths' poses": {"pose": "mean"},
}


def window(runs: Runs) -> Section:
    """Figure 9b: how far paths reach back, with and without warping and the energy."""
    section = Section(
        "How far paths reach back (figure 9b)",
        "M only bounds the length of paths, so it is far less critical than in the static graph.",
        "`tautges2011` as published but for M, time warping (paths at half to double speed), and"
        " the energy, in place of which poses are the paths' weighted mean. Root frame, cm.",
    )
    for scenario in (1, 3):
        contenders = [
            variant(f"{name}, M = {count}", window_readings=count, **options)
            for name, options in WAYS.items()
            for count in WINDOWS
        ]
        found = runs.evaluation(plain(scenario, *contenders))
        curves = {
            name: (list(WINDOWS), [mean_cm(found, f"{name}, M = {count}") for count in WINDOWS])
            for name in WAYS
        }
        head = ["M", *map(str, WINDOWS)]
        rows = [[name, *map(cm, y)] for name, (_, y) in curves.items()]
        section.tables.append(Table(SCENARIO_NAMES[scenario], head, rows))
        section.plots[f"fig09b_scenario{scenario}"] = Lines(
            f"Window size, scenario {scenario}",
            "M (readings)",
            "error, root frame (cm)",
            curves,
            is_logarithmic=True,
        )
        section.findings += [
            f"Scenario {scenario}, {name}: from {min(y):.1f} (M = {WINDOWS[int(np.argmin(y))]}) to"
            f" {max(y):.1f} cm (M = {WINDOWS[int(np.argmax(y))]})."
            for name, (_, y) in curves.items()
        ]
    return section


def priors(runs: Runs) -> Section:
    """Figure 11: kernel regression against normal distributions."""
    section = Section(
        "Prior models (figure 11)",
        "The new priors with kernel regression decrease the error by about 30 % against both"
        " others, in each scenario.",
        "`tautges2011` as published with each prior model. Root frame, cm.",
    )
    contenders = [variant(name, **options) for name, options in PRIORS.items()]
    groups: dict[str, dict[str, float]] = {name: {} for name in PRIORS}
    for scenario, title in SCENARIO_NAMES.items():
        found = runs.evaluation(plain(scenario, *contenders))
        for name in PRIORS:
            groups[name][title] = mean_cm(found, name)
    rows = [[name, *map(cm, errors.values())] for name, errors in groups.items()]
    section.tables.append(Table("Root frame, cm", ["", *SCENARIO_NAMES.values()], rows))
    section.plots["fig11"] = Bars("Prior models", "error, root frame (cm)", groups)
    kernel = groups[next(iter(PRIORS))]
    for name in list(PRIORS)[1:]:
        saved = [100.0 * (1.0 - kernel[title] / groups[name][title]) for title in kernel]
        section.findings.append(
            f"Kernel regression against {name}: {saved[0]:+.0f}, {saved[1]:+.0f} and"
            f" {saved[2]:+.0f} % less error in scenarios 1, 2 and 3."
        )
    return section


ABLATIONS: dict[str, dict[str, Any]] = {
    "nearest frame alone": {"num_neighbours": 1, "num_paths": 1, "window_readings": 1,
                            "pose": "mean"},
    "plain mean of nearest frames (M = 1, no energy)": {"window_readings": 1, "pose": "mean"},
    "plain mean of paths, M = 20": {"pose": "mean"},
    "energy, M = 1": {"window_readings": 1},
    "energy without warping": {"is_time_warping": False},
    "energy without its motion prior": {"w_motion": 0},
    "energy without its smoothness prior": {"w_smooth": 0},
    "energy without its control term": {"w_contr": 0},
    "energy, weights of the priors halved": {"w_prior": 2.5},
    "energy, weights of the priors doubled": {"w_prior": 10},
}  # fmt: skip


def energy(runs: Runs) -> Section:
    """Whether warping, M and the energy buy anything over a plain mean."""
    section = Section(
        "What each part is worth",
        "The control signal alone gives jitter and degenerate poses; priors, warping and paths are"
        " what makes motion plausible. Slightly other weights do not matter.",
        "`tautges2011` as published against itself with one part taken away: how much larger"
        " (+) or smaller (-) the error becomes, paired over the clips with 95 % intervals; root"
        " frame, cm. Jerk in scenario 1, km/s³.",
    )
    contenders = [PAPER, *(variant(name, **options) for name, options in ABLATIONS.items()), LIVE]
    found = {s: runs.evaluation(plain(s, *contenders)) for s in (1, 3)}
    rows = []
    for one in contenders:
        label = one.label
        row = [label]
        for of_scenario in found.values():
            row.append(cm(mean_cm(of_scenario, label), 2))
            row.append("" if one is PAPER else told_difference(of_scenario, label, PAPER.label))
        rows.append([*row, f"{found[1]['methods'][label]['jerk_kmps3']:.3f}"])
    head = ["", "scenario 1", "difference", "scenario 3", "difference", "jerk"]
    section.tables.append(Table("Root frame, cm", head, rows))
    for name in ("plain mean of nearest frames (M = 1, no energy)", "plain mean of paths, M = 20"):
        section.findings.append(_verdict(found, name))
    section.findings.append(_verdict(found, "energy without warping"))
    section.findings.append(_verdict(found, "energy, M = 1"))
    means = ("plain mean of paths, M = 20", "plain mean of nearest frames (M = 1, no energy)")
    energy_jerk, *mean_jerks = (
        found[1]["methods"][label]["jerk_kmps3"] for label in (PAPER.label, *means)
    )
    told = " and ".join(f"{jerk:.2f}" for jerk in mean_jerks)
    section.findings.append(
        f"Smoothness: jerk in scenario 1 is {energy_jerk:.2f} km/s³ with the energy, {told} for the"
        " plain means of paths and of nearest frames."
    )
    return section


def _verdict(found: dict[int, Found], name: str) -> str:
    """Returns whether the whole method is better than a variant, and by how much."""
    told = []
    for scenario, of_scenario in found.items():
        off, half = difference(of_scenario, name, PAPER.label)
        if np.isnan(half) or abs(off) <= half:
            word = "no difference that can be told"
        else:
            word = f"the whole method is {'better' if off > 0 else 'worse'}"
        shown = told_difference(of_scenario, name, PAPER.label)
        told.append(f"scenario {scenario}: {word} ({shown} cm)")
    return f'Against "{name}": {"; ".join(told)}.'


SHARES = (0.8, 0.9, 0.95, 0.99, 0.999)
ITERATIONS = (1, 2, 4, 8, 16, 50)
GRAPH_WINDOWS = (4, 8, 16, 32, 64)
TIMED_CLIPS = 3


def graph(runs: Runs) -> Section:
    """Speed of the graph, components kept, and iterations."""
    section = Section(
        "The graph's speed, components and iterations (sections 4, 5.3 and 6.3)",
        "The online graph is more than ten times faster than the static one, and the gain grows"
        " linearly with M. With 99 % of the variance 14 components of 43 are kept on average; few"
        " iterations are enough.",
        "Graph: both on the same neighbours (K = 4096), the static one made anew from the last M"
        " readings at each; processor time. Components and iterations: scenario 1.",
    )
    _graph_speed(runs, section)
    shares = [variant(f"{share:g}", pca_variance=share) for share in SHARES]
    counts = [variant(str(count), max_iterations=count) for count in ITERATIONS]
    for title, contenders in (
        ("Share of the poses' variance that is kept", shares),
        ("Iterations at most", counts),
    ):
        found = runs.evaluation(plain(1, *contenders))
        rows = []
        for one in contenders:
            work = found["methods"][one.label]["work"]
            kept = [cm(work["components"]), cm(work["iterations"])]
            rows.append([one.label, *kept, cm(mean_cm(found, one.label), 2)])
        head = ["", "components", "iterations", "error, root frame, cm"]
        section.tables.append(Table(title, head, rows))
        usual = rows[SHARES.index(0.99)] if contenders is shares else rows[-1]
        section.findings.append(
            f"{title} {usual[0]}: {usual[1]} components and {usual[2]} iterations on average."
        )
    return section


def _graph_times(runs: Runs, settings: Settings) -> list[list[float]]:
    """Returns, for each of GRAPH_WINDOWS, what graph_times() says in the mean of some clips."""
    readings = [solved[PAPER.label].readings for _, _, solved in runs.reconstructions(settings)]
    return [
        np.mean([graph_times(runs.database(), one, count) for one in readings], axis=0).tolist()
        for count in GRAPH_WINDOWS
    ]


def _graph_speed(runs: Runs, section: Section) -> None:
    what = f"times of the graph for M = {GRAPH_WINDOWS}"
    times = runs.figures(
        what, plain(1, PAPER), lambda settings: _graph_times(runs, settings), TIMED_CLIPS
    )
    online = [1000.0 * one for one, _, _ in times]
    anew = [1000.0 * one for _, one, _ in times]
    rows = [
        [str(count), f"{one:.3f}", f"{other:.3f}", f"{other / one:.1f}", f"{100 * same:.0f}"]
        for count, one, other, (_, _, same) in zip(GRAPH_WINDOWS, online, anew, times, strict=True)
    ]
    head = ["M", "online, ms a reading", "made anew, ms", "times slower", "same best path, %"]
    section.tables.append(Table("Online graph against one made anew", head, rows))
    section.findings.append(
        f"Made anew the graph takes {rows[0][3]} times as long at M = {rows[0][0]} and"
        f" {rows[-1][3]} times at M = {rows[-1][0]}."
    )
    section.plots["graph_speed"] = Lines(
        "The graph's time",
        "M (readings)",
        "ms a reading",
        {
            "online": (list(GRAPH_WINDOWS), online),
            "made anew": (list(GRAPH_WINDOWS), anew),
        },
        is_logarithmic=True,
    )
