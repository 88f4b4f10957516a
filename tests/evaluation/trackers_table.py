# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes TRACKERS.md: how far reconstructions from six simulated trackers are off.

trackers_table.py HDM05 CMU [-o TRACKERS.md] [--json-folder DIR] [--every N]

HDM05 and CMU are folders of recorded motion (CMU as BVH). Figures 6 and 7 of Liu et al. 2011 and
its
combinations of sensor data: clips are left out one by one, punching is four parts of CMU's 02_05
with 0.5 s left out at the borders. Then trackers without positions, by liu2011 and by
path_regression. With --json-folder what is there already is not run again; --every N takes every
N-th clip of those that are tested by default.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

from sparse_mocap import MotionDatabase, build_database, read_motion, write_bvh
from sparse_mocap.evaluation import Contender, Evaluation, Settings, evaluate, variants
from sparse_mocap.methods import method_info

TRACKERS = Path(__file__).with_name("TRACKERS.md")
RATE_HZ = 40.0  # that of the paper's sensors
PAPER_SITES = ("left_hand", "right_hand", "left_ankle", "right_ankle", "head", "torso")
WORN_SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle", "head", "pelvis")
FIGURES = ("positions_and_orientations", "positions", "combinations")
ACTIONS = {
    "walk": ("cmu", "*35_01*"),
    "run": ("cmu", "*35_17*"),
    "dance": ("cmu", "*05_02*"),
    "jump": ("hdm05", "HDM_dg_hopBothLegs1hops_022*"),
    "kick": ("hdm05", "HDM_dg_kickLFront1Reps_013*"),
    "squat": ("hdm05", "HDM_dg_squat1Reps_025*"),
    "throw": ("hdm05", "HDM_dg_throwBasketball_007*"),
}
PUNCHING = "02_05"
FOLDS, LEFT_OUT_S = 4, 0.5
WITHOUT_POSITIONS = (
    Contender("path_regression, live", "path_regression"),
    Contender("path_regression, best", "path_regression", best_quality=True),
    Contender("liu2011, live", "liu2011"),
    Contender("liu2011, best", "liu2011", best_quality=True),
)

Figures = dict[str, dict[str, Any]]
"""By label: mean_cm, euler_angle_deg with its deviation, joint_angle_deg."""

HEAD = """# Six trackers

How far poses are off that are reconstructed from six simulated trackers without noise.
`tests/evaluation/trackers_table.py HDM05 CMU` writes this file.

- Euler: mean error of a joint angle, and its deviation over the frames, as Liu et al. 2011 measure;
  geodesic: mean angle of a joint's rotation. cm: RMS over the joints in the heading frame.
- The tested clip and its mirror image are not in the database, which has 40 frames a second for the
  paper's comparisons, and 25 without positions. Golf and table tennis are not in the data.
"""


def figures_of(evaluation: Evaluation, skip: Sequence[str] = ()) -> Figures:
    """What the tables show of an evaluation."""
    keys = ("mean_cm", "euler_angle_deg", "euler_angle_deviation_deg", "joint_angle_deg")
    found = {}
    for label in evaluation.methods:
        told = evaluation.summary(label)
        if label not in skip:
            found[label] = {key: told[key] for key in keys}
    return found


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


def compared(
    sources: dict[str, Path], databases: dict[str, MotionDatabase]
) -> Iterator[tuple[str, str, Callable[[], dict[str, Any]]]]:
    """Each experiment of the paper for each action, and how to run it."""
    known = {experiment.name: experiment for experiment in method_info("liu2011").experiments}
    for name in FIGURES:
        for action, (source, pattern) in ACTIONS.items():

            def run(
                name: str = name, source: str = source, pattern: str = pattern
            ) -> dict[str, Any]:
                settings = Settings(
                    1,
                    contenders=tuple(variants("liu2011", known[name])),
                    tests=pattern,
                    sites=PAPER_SITES,
                )
                found = evaluate(databases[source], sources[source], settings)
                return figures_of(found, ("playback", "window of 10", "mean pose"))

            yield name, action, run


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


def punching(cmu: Path, name: str) -> dict[str, Any]:
    """An experiment of the paper on the folds of the punching clip."""
    (experiment,) = (e for e in method_info("liu2011").experiments if e.name == name)
    with tempfile.TemporaryDirectory(prefix="sparse_mocap_") as temporary:
        folder = Path(temporary) / "parts"
        folder.mkdir()
        pairs = punching_parts(cmu, folder)
        settings = Settings(
            1, contenders=tuple(variants("liu2011", experiment)), pairs=pairs, sites=PAPER_SITES
        )
        found = evaluate(database_of(folder, RATE_HZ, Path(temporary)), folder, settings)
        return figures_of(found, ("playback", "window of 10", "mean pose"))


def without_positions(
    database: MotionDatabase, source: Path, scenario: int, every: int, noise: str
) -> dict[str, Any]:
    """Trackers of orientation and acceleration."""
    settings = Settings(
        scenario,
        contenders=WITHOUT_POSITIONS,
        sites=WORN_SITES,
        channels=("orientation", "specific_force"),
        noise=noise,
        every=every,
    )
    return figures_of(evaluate(database, source, settings), ("playback", "window of 10"))


def row(label: str, figures: dict[str, Any]) -> str:
    """One line of a table."""

    def told(key: str) -> str:
        return "" if figures[key] is None else f"{figures[key]:.2f}"

    euler = told("euler_angle_deg")
    if euler:
        euler += f" ± {told('euler_angle_deviation_deg')}"
    return f"| {label} | {euler} | {told('joint_angle_deg')} | {told('mean_cm')} |"


def table(title: str, figures: Figures) -> list[str]:
    """A table of one evaluation."""
    lines = ["", f"### {title}", "", "| | Euler, ° | geodesic, ° | cm |", "|---|---:|---:|---:|"]
    return lines + [row(label, found) for label, found in figures.items()]


def means(parts: Sequence[Figures]) -> Figures:
    """The mean figures of several evaluations of the same labels."""
    out: Figures = {}
    for label, first in parts[0].items():
        out[label] = {}
        for key in first:
            values = [part[label][key] for part in parts if part[label][key] is not None]
            out[label][key] = sum(values) / len(values) if values else None
    return out


def document(found: dict[str, dict[str, Figures]]) -> str:
    """TRACKERS.md, from the figures by section and part."""
    lines = [HEAD]
    for section, parts in found.items():
        lines += ["", f"## {section}"]
        if len(parts) > 2:
            lines += table("Mean over the actions", means(list(parts.values())))
        for part, figures in parts.items():
            lines += table(part, figures)
    return "\n".join(lines) + "\n"


def main(arguments: Sequence[str] | None = None) -> None:
    """Evaluate and write."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("hdm05", type=Path)
    parser.add_argument("cmu", type=Path)
    parser.add_argument("-o", "--output", type=Path, default=TRACKERS)
    parser.add_argument("--json-folder", type=Path, help="keeps what each evaluation found")
    parser.add_argument("--every", type=int, default=1, help="test every N-th clip only")
    given = parser.parse_args(arguments)
    sources = {"hdm05": given.hdm05, "cmu": given.cmu}
    titles = {e.name: e.help for e in method_info("liu2011").experiments}
    with tempfile.TemporaryDirectory(prefix="sparse_mocap_") as temporary:
        folder = given.json_folder or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        databases = {n: database_of(source, RATE_HZ, folder) for n, source in sources.items()}
        found: dict[str, dict[str, Figures]] = {}
        for name, action, run in compared(sources, databases):
            part = found.setdefault(titles[name], {})
            part[action] = kept(folder / f"{name}_{action}.json", run)
        for name in FIGURES:
            found[titles[name]]["punch"] = kept(
                folder / f"{name}_punch.json", lambda name=name: punching(given.cmu, name)
            )
        for which, source in sources.items():
            database = database_of(source, 25.0, folder)
            for scenario, who in ((1, "known performer"), (3, "unknown performer")):
                section = found.setdefault("Orientation and acceleration alone", {})
                section[f"{which}, {who}"] = kept(
                    folder / f"without_positions_{which}_{scenario}.json",
                    lambda d=database, s=source, n=scenario: without_positions(
                        d, s, n, given.every, "none"
                    ),
                )
        given.output.write_text(document(found), encoding="utf-8")


if __name__ == "__main__":
    main()
