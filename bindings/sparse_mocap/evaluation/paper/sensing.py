# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sensors give: table II, figures 6, 12 and 13 of Tautges et al. 2011."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ... import Motion
from ..contender import Contender
from ..performance import PAPER_SITES
from ..protocol import Content
from ..runner import Settings
from .common import BEST, LIVE, PAPER, cm, mean_cm, plain, variant
from .runs import Found, Runs
from .section import Bars, Lines, Section, Table

__all__ = ["noise", "root_speed", "sensors", "tempo"]

Floats = NDArray[np.float64]

_FEWEST_TO_CORRELATE = 3
SETUPS = {
    "1: right wrist": ("right_wrist",),
    "1: pelvis": ("pelvis",),
    "2: wrists": ("left_wrist", "right_wrist"),
    "2: ankles": ("left_ankle", "right_ankle"),
    "2: left wrist, right ankle": ("left_wrist", "right_ankle"),
    "3: wrists, left ankle": ("left_wrist", "right_wrist", "left_ankle"),
    "4: wrists, ankles": PAPER_SITES,
    "5: and pelvis": (*PAPER_SITES, "pelvis"),
    "6: and pelvis, head": (*PAPER_SITES, "pelvis", "head"),
}
LOCOMOTION = Content(classes=("walk*", "run*", "jog*"))


def sensors(runs: Runs) -> Section:
    """Table II and figure 12: one to six sensors."""
    section = Section(
        "One to six sensors (table II, figure 12)",
        "More sensors tend to help; where motion is done alike by everybody, such as walking and"
        " running, more than four give no substantial gain.",
        "Accelerometers alone. Table II is a picture in the paper, so these setups are our choice."
        " Root frame, cm; the last columns: walks, runs and jogs alone, scenario 1.",
    )
    methods = (PAPER, LIVE, BEST)
    contenders = [_worn(one, name, sites) for one in methods for name, sites in SETUPS.items()]
    found = {s: runs.evaluation(plain(s, *contenders)) for s in (1, 3)}
    groups = {
        f"{one.label}, scenario {scenario}": {
            name: mean_cm(of_scenario, f"{one.label}: {name}") for name in SETUPS
        }
        for one in methods
        for scenario, of_scenario in found.items()
    }
    shown = dict(groups)
    if runs.can_test(LOCOMOTION):
        moving = runs.evaluation(plain(1, *contenders, among=LOCOMOTION, per_class=4))
        for one in (PAPER, BEST):
            shown[f"{one.label}, walks and runs"] = {
                name: mean_cm(moving, f"{one.label}: {name}") for name in SETUPS
            }
    rows = [[name, *(cm(errors[name]) for errors in shown.values())] for name in SETUPS]
    section.tables.append(Table("Root frame, cm", ["", *shown], rows))
    section.plots["fig12"] = Bars("One to six sensors", "error, root frame (cm)", groups)
    for label, errors in shown.items():
        best = min(errors, key=lambda name: errors[name])
        four = errors["4: wrists, ankles"]
        section.findings.append(
            f"{label}: {max(errors.values()):.1f} cm at worst, {four:.1f} with four,"
            f' {errors[best]:.1f} with "{best}".'
        )
    _histograms(found[1], section)
    return section


def _worn(one: Contender, name: str, sites: Sequence[str]) -> Contender:
    channels = {site: ("specific_force",) for site in sites}
    return replace(one, label=f"{one.label}: {name}", sensors=channels)


def _histograms(found: Found, section: Section) -> None:
    curves = {}
    for name in ("1: right wrist", "2: wrists", "4: wrists, ankles", "6: and pelvis, head"):
        told = found["methods"][f"{PAPER.label}: {name}"]["root_frame"]["histogram"]
        shares = 100.0 * np.array(told["frames"]) / sum(told["frames"])
        edges = told["bin_cm"] * np.arange(len(shares))
        curves[name] = (edges.tolist(), shares.tolist())
    section.plots["fig12a"] = Lines(
        f"{PAPER.label}, scenario 1: error of each frame",
        "RMS over the joints, root frame (cm)",
        "frames (%) in bins of 0.5 cm",
        curves,
        has_steps=True,
    )


def noise(runs: Runs) -> Section:
    """Figure 6: simulated sensors against noisy ones."""
    section = Section(
        "Simulated against noisy sensors (figure 6)",
        "Over 41 motions of one performer real sensors give hardly larger errors than simulated"
        " ones; both curves run alike.",
        "Real sensors on recorded motion are not in the data; the noise models stand for them"
        " (bias, scale, misalignment, latency, white noise). Scenario 1, all clips of table I.",
    )
    models = ("none", "research", "consumer")
    methods = (PAPER, LIVE, BEST)
    found = {model: runs.evaluation(plain(1, *methods, noise=model)) for model in models}
    rows = []
    for one in methods:
        errors = [mean_cm(found[model], one.label) for model in models]
        added = [100.0 * (error / errors[0] - 1.0) for error in errors[1:]]
        rows.append([one.label, *map(cm, errors), *(f"{share:+.1f}" for share in added)])
    head = ["", *models, "research adds, %", "consumer adds, %"]
    section.tables.append(Table("Root frame, cm", head, rows))
    clips = [test["name"] for test in found["none"]["tests"]]
    order = np.argsort([test["root_frame_cm"][PAPER.label] for test in found["none"]["tests"]])
    curves = {}
    for model in models:
        of_clips = np.array([t["root_frame_cm"][PAPER.label] for t in found[model]["tests"]])
        curves[model] = (list(range(1, len(clips) + 1)), of_clips[order].tolist())
    section.plots["fig06"] = Lines(
        f"{PAPER.label}: noise of the sensors",
        "clips, by their error without noise",
        "error, root frame (cm)",
        curves,
    )
    section.findings = [
        f"{row[0]}: consumer noise adds {row[-1]} %, research noise {row[-2]} %." for row in rows
    ]
    if len(clips) > _FEWEST_TO_CORRELATE:
        correlation = np.corrcoef(curves["none"][1], curves["consumer"][1])[0, 1]
        section.findings.append(
            f"Clips without and with consumer noise correlate by {correlation:.2f}."
        )
    return section


TEMPOS = (0.5, 0.6, 0.75, 0.9, 1.0, 1.15, 1.35, 1.6, 2.0)
SWAYING = (0.6, 1.6, 0.6, 1.6, 0.6)
NO_WARPING = variant("`tautges2011`, no warping", is_time_warping=False)


def tempo(runs: Runs) -> Section:
    """Figure 13b: performances at other tempos, with and without warping in the graph."""
    section = Section(
        "Performances at other tempos (figure 13b)",
        "On jumping jacks whose tempo changes smoothly, paths that warp give lower errors than"
        " without warping.",
        "All clips of table I performed at another tempo (2: twice as fast), readings computed for"
        " it; scenario 1, root frame, cm. Then each clip with a tempo that sways between 0.6 and"
        " 1.6. There are no jumping jacks in these recordings.",
    )
    methods = (PAPER, NO_WARPING, LIVE)
    curves: dict[str, tuple[list[float], list[float]]] = {one.label: ([], []) for one in methods}
    for factor in TEMPOS:
        found = runs.evaluation(plain(1, *methods, tempos=(factor,)))
        for one in methods:
            curves[one.label][0].append(factor)
            curves[one.label][1].append(mean_cm(found, one.label))
    swaying = runs.evaluation(plain(1, *methods, tempos=SWAYING))
    rows = [[label, *map(cm, y), cm(mean_cm(swaying, label))] for label, (_, y) in curves.items()]
    head = ["tempo", *(f"{factor:g}" for factor in TEMPOS), "swaying"]
    section.tables.append(Table("Root frame, cm", head, rows))
    section.plots["fig13b"] = Lines(
        "Performances at other tempos", "tempo", "error, root frame (cm)", curves
    )
    with_warping, without = (np.array(curves[one.label][1]) for one in methods[:2])
    gains = without - with_warping
    section.findings = [
        "Warping gains "
        + ", ".join(
            f"{gain:+.2f} cm at {factor:g}" for factor, gain in zip(TEMPOS, gains, strict=True)
        )
        + f"; swaying {mean_cm(swaying, NO_WARPING.label) - mean_cm(swaying, PAPER.label):+.2f} cm."
    ]
    _swaying_clip(runs, section, methods[:2])
    return section


def _swaying_clip(runs: Runs, section: Section, methods: Sequence[Contender]) -> None:
    """Draws one clip whose tempo sways, frame by frame."""
    cyclic = Content(classes=("*jack*", "*elbow*", "*hop*"))
    if not runs.can_test(cyclic):
        return
    found = runs.evaluation(plain(1, *methods, tempos=SWAYING, among=cyclic, every=5))
    longest = max(
        (test for test in found["tests"] if "root_frame_by_frame_cm" in test),
        key=lambda test: int(test["frames"]),
        default=None,
    )
    if longest is None:
        return
    errors = longest["root_frame_by_frame_cm"]
    section.plots["fig13b_clip"] = Lines(
        f"{longest['name']}: tempo sways between 0.6 and 1.6",
        "time (s)",
        "error, root frame (cm)",
        {
            label: ((np.arange(len(own)) / found["rate_hz"]).tolist(), own)
            for label, own in errors.items()
        },
        has_points=False,
    )


SHOWN_RUNS = 5
JOGS = Content(classes=("run*", "jog*"))
FAST_SLOW_FAST = (1.0, 1.0, 0.5, 0.5, 1.0, 1.0)


def root_speed(runs: Runs) -> Section:
    """Figure 13a: the speed of the root while someone runs, slows down and runs again."""
    section = Section(
        "Speed of the root (figure 13a)",
        "The phases of a run, a walk and a run show clearly in the estimated speed of the root.",
        "Runs and jogs slowed down to half their tempo in the middle; speed on the floor over half"
        " a second, scenario 1.",
    )
    if not runs.can_test(JOGS):
        section.findings = ["No clip of a run or a jog is there."]
        return section
    settings = plain(1, PAPER, LIVE, BEST, tempos=FAST_SLOW_FAST, among=JOGS)
    speeds = runs.figures(
        "speed of the root", settings, lambda some: _root_speeds(runs, some), SHOWN_RUNS
    )
    runs.num_clips.add(len(speeds))
    rows = [[name, *_agreement(curves)] for name, curves in speeds.items()]
    longest = max(speeds, key=lambda name: len(speeds[name]["truth"]))
    labels = [label for label in speeds[longest] if label != "truth"]
    head = ["", *(f"{label}: {what}" for label in labels for what in ("correlation", "off, m/s"))]
    section.tables.append(Table("Speed of the root", head, rows))
    for column, label in enumerate(labels):
        correlations = [float(row[1 + 2 * column]) for row in rows]
        section.findings.append(
            f"{label}: correlation with the true speed {np.mean(correlations):.2f} on average,"
            f" {min(correlations):.2f} at worst."
        )
    section.plots["fig13a"] = Lines(
        f"{longest}: run, half as fast, run",
        "time (s)",
        "speed of the root (m/s)",
        {
            label: ((np.arange(len(own)) / _SPEED_HZ).tolist(), own)
            for label, own in speeds[longest].items()
        },
        has_points=False,
    )
    return section


def _root_speeds(runs: Runs, settings: Settings) -> dict[str, dict[str, list[float]]]:
    """Returns each clip's speeds by label, the truth's first."""
    found = {}
    for clip, performance, solved in runs.reconstructions(settings):
        curves = {"truth": _speeds(performance.motion)}
        for label, solution in solved.items():
            curves[label] = _speeds(solution.motion.without_extremities())
        count = min(len(own) for own in curves.values())
        found[clip.name] = {label: own[:count].tolist() for label, own in curves.items()}
    return found


_SPEED_HZ = 25.0


def _speeds(motion: Motion, over_s: float = 0.5) -> Floats:
    """Returns the root's speed on the floor (m/s), a mean over half a second."""
    roots = np.asarray(motion.resampled(_SPEED_HZ).root_positions)[:, [0, 2]]
    steps = np.linalg.norm(np.diff(roots, axis=0), axis=1) * _SPEED_HZ
    width = max(1, min(round(over_s * _SPEED_HZ), len(steps)))
    return np.asarray(np.convolve(steps, np.full(width, 1.0 / width), mode="valid"))


def _agreement(curves: dict[str, list[float]]) -> list[str]:
    true = np.array(curves["truth"])
    cells = []
    for label, own in curves.items():
        if label != "truth":
            cells.append(f"{np.corrcoef(true, own)[0, 1]:.2f}")
            cells.append(f"{np.abs(np.array(own) - true).mean():.2f}")
    return cells
