# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes TRACKERS.md: how far reconstructions from six simulated trackers are off.

trackers_table.py HDM05 CMU [-o TRACKERS.md] [--json-folder DIR] [--every N]

HDM05 and CMU are folders of recorded motion (CMU as BVH). Figures 6 and 7 of Liu et al. 2011 and
its combinations of sensor data: clips are left out one by one, punching is four parts of CMU's
02_05 with 0.5 s left out at the borders. Then the same with noisy trackers, and trackers without
positions, by liu2011 and by path_regression. With --json-folder what is there already is not run
again; --every N takes every N-th clip only.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from sparse_mocap import MotionDatabase, build_database, read_motion, write_bvh
from sparse_mocap.evaluation import Contender, Evaluation, Settings, evaluate, variants
from sparse_mocap.methods import method_info
from sparse_mocap.plots import plot_errors_over_time

TRACKERS = Path(__file__).with_name("TRACKERS.md")
RATE_HZ = 40.0  # that of the paper's sensors
PAPER_SITES = ("left_hand", "right_hand", "left_ankle", "right_ankle", "head", "torso")
WORN_SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle", "head", "pelvis")
COMPARED = ("positions_and_orientations", "positions")
COMBINED = "combinations"
BEST = "local dynamic models, best quality"


@dataclass(frozen=True)
class Action:
    """A kind of movement of the paper, and the clips that it is tested on."""

    source: str
    tests: str
    every: int = 1
    plotted: str = ""
    """The clip whose errors are shown frame by frame."""


# Of HDM05 performer mm, and of CMU clips on which no setting was chosen.
ACTIONS = {
    "walk": Action("cmu", "*_01*", 2, plotted="08_01"),
    "run": Action("cmu", "*35_2[0-6]*", 2),
    "jump": Action("hdm05", "HDM_mm_hopBothLegs*", plotted="HDM_mm_hopBothLegs1hops_031_120"),
    "kick": Action("hdm05", "HDM_mm_kick*", 2),
    "squat": Action("hdm05", "HDM_mm_squat*", 2),
    "throw": Action("hdm05", "HDM_mm_throw*"),
    "dance": Action("cmu", "*05_0[2-9].*", 2),
}
WITHOUT_POSITIONS_TESTS = {"hdm05": ("HDM_mm_*", 3), "cmu": ("*_0[13]*", 2)}
PUNCHING = "02_05"
FOLDS, LEFT_OUT_S = 4, 0.5
NOISES = {
    "optical": "Noise of optical trackers (2 mm, 0.3°)",
    "ultrasonic": "Noise of ultrasonic trackers, as the paper's (1 cm, 2 % of the positions wrong)",
}
WITHOUT_POSITIONS = (
    Contender("path_regression, live", "path_regression"),
    Contender("path_regression, best", "path_regression", best_quality=True),
    Contender("liu2011, live", "liu2011"),
    Contender("liu2011, best", "liu2011", best_quality=True),
)
LEFT_OUT = ("playback", "window of 10", "mean pose")
"""Baselines of sensors that measure accelerations."""

Figures = dict[str, dict[str, Any]]
"""By label: mean_cm, euler_angle_deg with its deviation, joint_angle_deg."""

HEAD = """# Six trackers

How far poses are off that are reconstructed from six simulated trackers.
`tests/evaluation/trackers_table.py HDM05 CMU` writes this file.

- Euler: mean error of a joint angle, and its deviation over the frames, as Liu et al. 2011 measure;
  geodesic: mean angle of a joint's rotation. cm: RMS over the joints in the heading frame.
- Jump, kick, squat and throw are clips of HDM05's performer mm; walk, run, dance and punch are of
  CMU. No setting of `liu2011` was chosen on any of them. The tested clip and its mirror image are
  not in the database, which has 40 frames a second for the paper's comparisons, and 25 without
  positions. Of punching there is one clip in CMU; a quarter of it is tested with the others as
  database, without the 0.5 s beside it. Golf and table tennis are in neither collection.
- In the paper's comparisons sensors give 40 readings a second, as its own did, without positions
  100. They have no noise unless it is said; with noise every second of the clips is tested.
- *Nearest pose* is the pose of the database that is nearest to the truth: no reconstruction.
"""


def figures_of(evaluation: Evaluation, skip: Sequence[str] = ()) -> Figures:
    """What the tables show of an evaluation."""
    keys = ("mean_cm", "euler_angle_deg", "euler_angle_deviation_deg", "joint_angle_deg")
    found = {}
    for label in evaluation.methods:
        told = evaluation.summary(label)
        if label not in skip:
            name = "nearest pose" if label == "oracle" else label
            found[name] = {key: told[key] for key in keys}
    return found


def curves_of(evaluation: Evaluation, clip: str) -> dict[str, list[float]]:
    """The errors of a clip's frames (degrees), by label."""
    tests = [test for test in evaluation.tests if clip and clip in test.name]
    return {
        label: [round(float(value), 2) for value in result.euler_errors_deg]
        for test in tests[:1]
        for label, result in test.results.items()
        if result.euler_errors_deg is not None and label not in LEFT_OUT
    }


def kept(path: Path, run: Callable[[], dict[str, Any]]) -> dict[str, Any]:
    """What is in the file; if there is none, what run finds, which is kept there."""
    if not path.exists():
        path.write_text(json.dumps(run(), indent=1), encoding="utf-8")
    found: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return found


def database_of(source: Path, rate_hz: float, folder: Path) -> MotionDatabase:
    """The folder's database with mirror images."""
    path = folder / f"{source.name}_{rate_hz:g}.smdb"
    if not path.exists():
        build_database([source], path, rate_hz=rate_hz, mirror=True)
    return MotionDatabase(path)


def contenders(names: Sequence[str], is_short: bool = False) -> tuple[Contender, ...]:
    """What the paper's experiments compare, labelled EXPERIMENT/WHAT, and our best quality.

    The short list lacks that and the paper's own search.
    """
    known = {experiment.name: experiment for experiment in method_info("liu2011").experiments}
    found = []
    for name in names:
        those = variants("liu2011", known[name])
        if is_short:
            those = those[:3]
        elif name in COMPARED:
            those.append(replace(those[0], label=BEST, best_quality=True))
        found += [replace(one, label=f"{name}/{one.label}") for one in those]
    return tuple(found)


def tested(
    database: MotionDatabase, source: Path, action: Action, every: int, noise: str
) -> dict[str, Any]:
    """The paper's experiments on the clips of an action."""
    is_short = noise != "none"
    settings = Settings(
        1,
        contenders=contenders(COMPARED if is_short else (*COMPARED, COMBINED), is_short),
        tests=action.tests,
        every=action.every * every,
        sites=PAPER_SITES,
        noise=noise,
        sensor_rate_hz=RATE_HZ,
    )
    found = evaluate(database, source, settings)
    return {
        "clips": len(found.tests),
        "figures": figures_of(found, LEFT_OUT),
        "curves": curves_of(found, action.plotted),
    }


def punching_parts(cmu: Path, folder: Path) -> tuple[tuple[str, str], ...]:
    """Writes the parts of the punching clip: patterns of training and test files, a fold each."""
    (path,) = (path for path in cmu.rglob("*.bvh") if path.stem.startswith(PUNCHING))
    motion = read_motion(path)[0]
    left_out = round(LEFT_OUT_S / motion.frame_time_s)
    borders = [round(k * motion.num_frames / FOLDS) for k in range(FOLDS + 1)]
    for fold in range(FOLDS):
        begin, end = borders[fold], borders[fold + 1]
        write_bvh(folder / f"test{fold}.bvh", motion.trimmed(begin, end))
        if fold > 0:
            write_bvh(folder / f"train{fold}_before.bvh", motion.trimmed(0, begin - left_out))
        if fold < FOLDS - 1:
            after = motion.trimmed(end + left_out, motion.num_frames)
            write_bvh(folder / f"train{fold}_after.bvh", after)
    return tuple((f"train{fold}_*", f"test{fold}.bvh") for fold in range(FOLDS))


def punching(cmu: Path) -> dict[str, Any]:
    """The paper's experiments on the folds of the punching clip."""
    with tempfile.TemporaryDirectory(prefix="sparse_mocap_") as temporary:
        folder = Path(temporary) / "parts"
        folder.mkdir()
        pairs = punching_parts(cmu, folder)
        settings = Settings(
            1,
            contenders=contenders((*COMPARED, COMBINED)),
            pairs=pairs,
            sites=PAPER_SITES,
            sensor_rate_hz=RATE_HZ,
        )
        found = evaluate(database_of(folder, RATE_HZ, Path(temporary)), folder, settings)
        return {"clips": len(found.tests), "figures": figures_of(found, LEFT_OUT), "curves": {}}


def without_positions(
    database: MotionDatabase, source: Path, which: str, scenario: int, noise: str, every: int
) -> dict[str, Any]:
    """Trackers of orientation and acceleration."""
    tests, own_every = WITHOUT_POSITIONS_TESTS[which]
    settings = Settings(
        scenario,
        contenders=WITHOUT_POSITIONS,
        tests=tests,
        every=own_every * every,
        sites=WORN_SITES,
        channels=("orientation", "specific_force"),
        noise=noise,
    )
    found = evaluate(database, source, settings)
    return {"clips": len(found.tests), "figures": figures_of(found, ("playback", "window of 10"))}


def means(parts: Sequence[Figures]) -> Figures:
    """The mean figures of several evaluations of the same labels."""
    out: Figures = {}
    for label, first in parts[0].items():
        out[label] = {}
        for key in first:
            values = [part[label][key] for part in parts if part[label][key] is not None]
            out[label][key] = sum(values) / len(values) if values else None
    return out


def part_of(figures: Figures, name: str) -> Figures:
    """The figures of one experiment, by its own labels, and the nearest pose."""
    own = {
        label.partition("/")[2]: found
        for label, found in figures.items()
        if label.startswith(f"{name}/")
    }
    return own | {label: found for label, found in figures.items() if "/" not in label}


def _told(value: float | None) -> str:
    return "" if value is None else f"{value:.2f}"


def _euler(figures: dict[str, Any]) -> str:
    euler = _told(figures["euler_angle_deg"])
    return f"{euler} ± {_told(figures['euler_angle_deviation_deg'])}" if euler else "–"


def _geodesic_and_cm(figures: dict[str, Any]) -> str:
    return f"{_told(figures['joint_angle_deg']) or '–'} / {_told(figures['mean_cm'])}"


def table(parts: Mapping[str, Figures], cell: Callable[[dict[str, Any]], str]) -> list[str]:
    """A table with a line for each label and a column for each part; the mean, if there are more
    than two.
    """
    columns = dict(parts)
    if len(columns) > 2:
        columns["mean"] = means(list(parts.values()))
    lines = ["", "| | " + " | ".join(columns) + " |", "|---" + "|---:" * len(columns) + "|"]
    for label in next(iter(parts.values())):
        cells = (cell(figures[label]) for figures in columns.values())
        lines.append(f"| {label} | " + " | ".join(cells) + " |")
    return lines


def section(title: str, parts: Mapping[str, Figures], level: int = 2) -> list[str]:
    """Both tables of one comparison."""
    lines = ["", f"{'#' * level} {title}", "", "Euler, °:", *table(parts, _euler)]
    return [*lines, "", "Geodesic, ° / position, cm:", *table(parts, _geodesic_and_cm)]


def document(found: Mapping[str, Mapping[str, dict[str, Any]]], pictures: Mapping[str, str]) -> str:
    """TRACKERS.md, from what was found by noise, or "without_positions", and part."""
    titles = {e.name: e.help for e in method_info("liu2011").experiments}
    plain = found["none"]
    counts = ", ".join(f"{action} {told['clips']}" for action, told in plain.items())
    lines = [HEAD, f"Clips tested: {counts}."]
    for name in (*COMPARED, COMBINED):
        parts = {action: part_of(told["figures"], name) for action, told in plain.items()}
        lines += section(titles[name], parts)
    lines += ["", "## Frame by frame (figure 7)"]
    for title, picture in pictures.items():
        lines += ["", f"![{title}]({picture})"]
    for noise, title in NOISES.items():
        lines += ["", f"## {title}"]
        for name in COMPARED:
            parts = {a: part_of(told["figures"], name) for a, told in found[noise].items()}
            lines += section(titles[name], parts, 3)
    for noise, title in (
        ("without_positions_none", "Orientation and acceleration alone"),
        (
            "without_positions_inertial",
            "The same, turned by 2° and with drifting headings (0.1°/s)",
        ),
    ):
        parts = {part: told["figures"] for part, told in found[noise].items()}
        told = ", ".join(f"{part} {one['clips']}" for part, one in found[noise].items())
        lines += [*section(title, parts), "", f"Clips tested: {told}."]
    return "\n".join(lines) + "\n"


def plotted(action: str, curves: Mapping[str, Sequence[float]], path: Path) -> None:
    """Draws the errors of a clip's frames, from positions alone."""
    shown = {}
    for label, errors in curves.items():
        name = label.removeprefix("positions/")
        if label != "oracle" and (name == label or name.endswith("paper")):
            continue
        told = {BEST: "local dynamic models, best", "oracle": "nearest pose"}.get(name, name)
        shown[told] = np.arange(len(errors)) / RATE_HZ, np.array(errors)
    title = f"{action.capitalize()}, from positions alone"
    plot_errors_over_time(shown, title, path, "degrees an angle")


def find(
    sources: Mapping[str, Path], folder: Path, every: int
) -> dict[str, dict[str, dict[str, Any]]]:
    """Every evaluation; what is in the folder already is not run again."""
    databases = {n: database_of(source, RATE_HZ, folder) for n, source in sources.items()}
    found: dict[str, dict[str, dict[str, Any]]] = {}
    for noise in ("none", *NOISES):
        part = found.setdefault(noise, {})
        fewer = 1 if noise == "none" else 2
        for name, action in ACTIONS.items():
            about = databases[action.source], sources[action.source], action
            run = partial(tested, *about, every * fewer, noise)
            part[name] = kept(folder / f"{noise}_{name}.json", run)
        if noise == "none":
            part["punch"] = kept(folder / "punch.json", partial(punching, sources["cmu"]))
    for noise in ("none", "inertial"):
        part = found.setdefault(f"without_positions_{noise}", {})
        for which, source in sources.items():
            database = database_of(source, 25.0, folder)
            for scenario, who in ((1, "known"), (3, "unknown")):
                name = f"without_positions_{which}_{scenario}_{noise}.json"
                run = partial(without_positions, database, source, which, scenario, noise, every)
                part[f"{which.upper()}, {who} performer"] = kept(folder / name, run)
    return found


def main(arguments: Sequence[str] | None = None) -> None:
    """Evaluate and write."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("hdm05", type=Path)
    parser.add_argument("cmu", type=Path)
    parser.add_argument("-o", "--output", type=Path, default=TRACKERS)
    parser.add_argument("--json-folder", type=Path, help="keeps what each evaluation found")
    parser.add_argument("--every", type=int, default=1, help="test every N-th clip only")
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="sparse_mocap_") as temporary:
        folder = given.json_folder or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        found = find({"hdm05": given.hdm05, "cmu": given.cmu}, folder, given.every)
    pictures = {}
    for name, action in ACTIONS.items():
        if not found["none"][name]["curves"]:
            continue
        path = given.output.with_name(f"{given.output.stem.lower()}_{name}.png")
        plotted(name, found["none"][name]["curves"], path)
        pictures[f"{name.capitalize()} ({action.plotted})"] = path.name
    given.output.write_text(document(found, pictures), encoding="utf-8")


if __name__ == "__main__":
    main()
