# SPDX-License-Identifier: GPL-3.0-or-later
"""What the database holds: table I, figures 8, 9a and 10 of Tautges et al. 2011."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..protocol import Content
from ..runner import Settings
from .common import (
    BEST,
    EASED,
    LIVE,
    PAPER,
    SCENARIO_NAMES,
    by_actor,
    cm,
    mean_cm,
    plain,
    variant,
)
from .runs import Found, Runs
from .section import Lines, Matrix, Section, Table

__all__ = ["content", "histogram", "proportions", "scenarios"]

LOCOMOTION = ("walk*", "run*", "jog*", "sneak*", "hop*")
UNSCALED = variant("`tautges2011`, K = 4096 and I = 256", scales_with_database=False)
SCALES = (0.5, 0.6, 0.8, 1.0, 1.2, 1.4, 1.5)


def scenarios(runs: Runs) -> Section:
    """Table I, in both frames, with all that is measured."""
    contenders = (PAPER, EASED, UNSCALED, LIVE, BEST)
    found = {s: runs.evaluation(Settings(s, contenders)) for s in SCENARIO_NAMES}
    section = Section(
        "Three scenarios (table I)",
        "Errors are noticeably smaller when the database has motion of the performer (scenarios 1"
        " and 2); without it (scenario 3) they are still satisfying.",
        "One clip for each performer and class. `tautges2011` takes K and I in the paper's"
        " proportion to the database; the row with K = 4096 and I = 256 has its numbers as they"
        " are. Below it what every method is compared with.",
    )
    labels = list(found[1]["methods"])
    for frame, name in (("root_frame", "full root frame"), ("heading", "heading frame")):
        rows = [[label, *(cm(mean_cm(found[s], label, frame)) for s in found)] for label in labels]
        caption = f"Mean error in the {name}, cm"
        section.tables.append(Table(caption, ["", *SCENARIO_NAMES.values()], rows))
    for scenario, name in SCENARIO_NAMES.items():
        section.tables.append(_figures(found[scenario], f"All figures, {name}"))
    for kind, figures in (
        ("class, cm", "class_errors_cm"),
        ("joint, cm", "joint_errors_cm"),
        ("limb, degrees between true and shown direction", "limb_angles_deg"),
    ):
        section.tables.append(_breakdown(found, f"Mean error of each {kind}", figures))
    for label in (PAPER.label, LIVE.label, BEST.label):
        one, two, three = (mean_cm(found[s], label) for s in found)
        section.findings.append(
            f"{label}: {one:.1f}, {two:.1f} and {three:.1f} cm in scenarios 1, 2 and 3;"
            f" an unknown performer costs {100 * (three / one - 1):.0f} %."
        )
    late = {label: told["latency_ms"] for label, told in found[1]["methods"].items()}
    section.findings.append(
        "Latency: "
        + ", ".join(f"{label} {ms:.0f} ms" for label, ms in late.items() if ms is not None)
        + "; `path_regression`, best, needs the whole take."
    )
    return section


def _figures(found: Found, caption: str) -> Table:
    rows = []
    for label, told in found["methods"].items():
        late, root = told["latency_ms"], told["root_frame"]
        rows.append(
            [
                label,
                *(cm(root[key]) for key in ("mean_cm", "median_cm", "p90_cm")),
                *(cm(told[key]) for key in ("mean_cm", "median_cm", "p90_cm", "centred_cm")),
                cm(float(np.mean(list(told["limb_angles_deg"].values())))),
                "" if late is None else f"{late:.0f}",
            ]
        )
    head = ["", "root: mean", "median", "90 %", "heading: mean", "median", "90 %"]
    head += ["without the clip's mean error", "limbs °", "latency ms"]
    return Table(caption, head, rows)


def _breakdown(found: dict[int, Found], caption: str, figures: str) -> Table:
    shown = [(label, s) for label in (PAPER.label, LIVE.label, BEST.label) for s in (1, 3)]
    names = list(found[1]["methods"][PAPER.label][figures])
    rows = [
        [name, *(cm(found[s]["methods"][label][figures][name]) for label, s in shown)]
        for name in names
    ]
    return Table(caption, ["", *(f"{label}, scenario {s}" for label, s in shown)], rows)


@dataclass(frozen=True)
class _Row:
    """A database of figure 8, and the scenario that it is tested in."""

    name: str
    scenario: int
    content: Content


def _rows(runs: Runs) -> list[_Row]:
    own = Content(runs.actors, with_reversed=False)
    rows = []
    for classes, of in ((LOCOMOTION, "locomotion"), ((), "all classes")):
        for actor in runs.actors:
            one = replace(own, actors=(actor,), classes=classes)
            rows.append(_Row(f"{actor}, {of}, M", 1, one))
        for is_mirrored, is_reversed, mark in (
            (False, False, ""),
            (True, False, ", M"),
            (True, True, ", M, R"),
        ):
            everyone = Content(runs.actors, classes, is_mirrored, is_reversed)
            rows += [_Row(f"all, {of}{mark}", scenario, everyone) for scenario in (1, 3)]
    for every, part in ((4, "quarter"), (2, "half")):
        few = replace(own, every=every)
        rows += [_Row(f"all, {part} of the files, M", scenario, few) for scenario in (1, 3)]
    if runs.more is not None:
        there = {clip.actor for clip in runs.database("diverse").clips}
        everything = replace(own, actors=())
        rows += [
            _Row("all, all classes, and other recordings, M", scenario, everything)
            for scenario in (1, 3)
        ]
        others = replace(own, actors=tuple(sorted(there - set(runs.actors))))
        rows.append(_Row("other recordings alone, M", 3, others))
    return rows


def content(runs: Runs) -> Section:
    """Figure 8: size and diversity of the database, for each performer."""
    rows, actors = _rows(runs), runs.actors
    tested = Content(actors, LOCOMOTION, with_mirrored=False, with_reversed=False)
    lines: list[str] = []
    cells: list[list[str]] = []
    values: dict[str, list[list[float]]] = {PAPER.label: [], LIVE.label: []}
    for row in rows:
        settings = plain(row.scenario, PAPER, LIVE, among=tested, per_class=2, known=row.content)
        found = runs.evaluation(settings, "diverse")
        frames = runs.count(row.content, "diverse")
        of_paper = by_actor(found, PAPER.label, actors)
        for label in values:
            values[label].append(by_actor(found, label, actors))
        lines.append(f"{row.name} ({row.scenario})")
        ours = float(np.nanmean(by_actor(found, LIVE.label, actors)))
        means = [*of_paper, float(np.nanmean(of_paper)), ours]
        cells.append([row.name, str(row.scenario), f"{frames:,}", *map(cm, means)])
    head = ["database", "scenario", "frames", *actors, "mean", LIVE.label]
    section = Section(
        "Size and diversity of the database (figure 8)",
        "Better when the performer is in the database; only slightly worse when it becomes larger"
        " and less uniform, and diversity matters more than size.",
        "Six clips of locomotion of each performer (two of each class). M: with mirrored copies,"
        " R: with reversed ones. A row of one performer is scenario 2 for that performer and 3 for"
        " the others; frames are those before the test's own are taken out. `tautges2011` as"
        " published for each performer, in the root frame, cm.",
        tables=[Table("Error in the root frame, cm", head, cells)],
    )
    for label, grid in values.items():
        name = "published" if label == PAPER.label else "path_regression"
        section.plots[f"fig08_{name}"] = Matrix(f"{label}: root frame, cm", lines, actors, grid)
    section.findings = _content_findings(cells)
    return section


def _content_findings(cells: list[list[str]]) -> list[str]:
    means = {(row[0], row[1]): float(row[-2]) for row in cells}
    ours = {(row[0], row[1]): float(row[-1]) for row in cells}
    findings = []
    for scenario in ("1", "3"):
        told = [
            f"{name}: {means[name, scenario]:.1f} (`path_regression` {ours[name, scenario]:.1f})"
            for name in (
                "all, locomotion, M",
                "all, all classes, M",
                "all, all classes, and other recordings, M",
            )
            if (name, scenario) in means
        ]
        findings.append(f"From uniform to diverse in scenario {scenario}, cm: {'; '.join(told)}.")
    return findings


def histogram(runs: Runs) -> Section:
    """Figure 9a: how the errors of all frames of all clips are spread."""
    section = Section(
        "Errors of all frames (figure 9a)",
        "Histograms in bins of 0.5 cm have narrow peaks at low errors; scenarios 1 and 2 are better"
        " than 3.",
        "All clips as they were recorded; root frame.",
    )
    rows = []
    curves: dict[str, dict[str, tuple[list[float], list[float]]]] = {}
    for scenario, name in SCENARIO_NAMES.items():
        found = runs.evaluation(plain(scenario, PAPER, LIVE, tests="*"))
        for label in (PAPER.label, LIVE.label):
            told = found["methods"][label]["root_frame"]["histogram"]
            shares = 100.0 * np.array(told["frames"]) / sum(told["frames"])
            edges = told["bin_cm"] * np.arange(len(shares))
            curves.setdefault(label, {})[name] = (edges.tolist(), shares.tolist())
            peak = float(edges[shares.argmax()])
            under = float(shares[edges < 10.0].sum())
            count = f"{sum(told['frames']):,}"
            fullest = f"{peak:.1f} to {peak + told['bin_cm']:.1f}"
            mean = cm(mean_cm(found, label))
            clips = str(len(found["tests"]))
            rows.append([label, name, clips, count, fullest, f"{under:.0f}", mean])
    head = ["", "", "clips", "frames", "fullest bin, cm", "frames under 10 cm, %", "mean, cm"]
    section.tables.append(Table("Root frame", head, rows))
    for label, of_scenarios in curves.items():
        name = "published" if label == PAPER.label else "path_regression"
        section.plots[f"fig09a_{name}"] = Lines(
            f"{label}: error of each frame",
            "RMS over the joints, root frame (cm)",
            "frames (%) in bins of 0.5 cm",
            of_scenarios,
            has_steps=True,
        )
    section.findings = [
        f"{row[0]}, {row[1]}: most frames {row[4]} cm, {row[5]} % under 10 cm." for row in rows
    ]
    return section


def proportions(runs: Runs) -> Section:
    """Figure 10: bodies in the database and performers of other sizes."""
    section = Section(
        "Size of the performer (figure 10)",
        "Virtually the same whether readings are simulated on each body's own proportions or on"
        " averaged ones; relatively robust against performers of half to one and a half times"
        " their size.",
        "(a) Databases with readings of averaged and of own proportions; performers always have"
        " their own. (b) Performers scaled, shown at their own size. Root frame, cm.",
    )
    rows = []
    for scenario in SCENARIO_NAMES:
        settings = plain(scenario, PAPER, LIVE)
        found = [runs.evaluation(settings, name) for name in ("plain", "own proportions")]
        for label in (PAPER.label, LIVE.label):
            averaged, own = (mean_cm(one, label) for one in found)
            rows.append(
                [label, str(scenario), cm(averaged, 2), cm(own, 2), f"{own - averaged:+.2f}"]
            )
    head = ["", "scenario", "averaged", "own", "own - averaged"]
    section.tables.append(Table("(a) Proportions of the database's readings", head, rows))
    largest = max(abs(float(row[-1])) for row in rows)
    section.findings.append(f"(a) The two differ by {largest:.2f} cm at most.")
    _scaled_performers(runs, section)
    return section


def _scaled_performers(runs: Runs, section: Section) -> None:
    curves: dict[str, tuple[list[float], list[float]]] = {}
    for scenario in SCENARIO_NAMES:
        for scale in SCALES:
            found = runs.evaluation(plain(scenario, PAPER, LIVE, body_scale=scale))
            for label in (PAPER.label, LIVE.label):
                x, y = curves.setdefault(f"{label}, scenario {scenario}", ([], []))
                x.append(scale)
                y.append(mean_cm(found, label))
    rows = [[name, *(cm(value) for value in y)] for name, (_, y) in curves.items()]
    head = ["times as large", *(f"{scale:g}" for scale in SCALES)]
    section.tables.append(Table("(b) Scaled performers", head, rows))
    section.plots["fig10b"] = Lines(
        "Scaled performers", "times as large", "error, root frame (cm)", curves
    )
    for name, (x, y) in curves.items():
        usual = y[x.index(1.0)]
        section.findings.append(
            f"(b) {name}: {y[0]:.1f} cm at half the size, {usual:.1f} as recorded,"
            f" {y[-1]:.1f} at one and a half."
        )
