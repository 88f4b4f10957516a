# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes ACCURACY.md: how far reconstructions are off on a folder of recorded motion.

accuracy_table.py FOLDER [-o ACCURACY.md] [--json-folder DIR]

Runs `sparse-mocap evaluate` on FOLDER for a known performer (scenario 1) and an unknown one
(scenario 3), with accelerometers, with gyroscopes and with trackers of orientation, live and in
best quality. What it writes depends on the data and the code alone: the same ones give the same
bytes. With --json-folder the JSON of each evaluation is kept there, and what is there already is
not run again.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

ACCURACY = Path(__file__).with_name("ACCURACY.md")
SCENARIOS = {1: "known performer", 3: "unknown performer"}
KINDS = {
    "accelerometers": (),
    "gyroscopes": ("--gyroscopes",),
    "orientations": ("--channels", "specific_force,orientation", "--noise", "inertial"),
}
TITLES = {
    "accelerometers": "accelerometers",
    "gyroscopes": "accelerometers and gyroscopes",
    "orientations": "accelerometers and orientations, worn 2° askew, whose headings drift",
}
BASELINES = {
    "oracle": "oracle",
    "playback": "playback of the best path in the database",
    "window of 10": "nearest window of ten readings",
    "mean pose": "the clip's own mean pose, held still",
}

MOVEMENTS = (
    "wrists, °",
    "fast turns, %",
    "step, cm",
    "feet, cm/s",
    "floor, cm",
    "sunk, %",
    "jerk ratio",
    "jumps",
    "root, cm",
    "heading, °",
    "warnings",
)
DRIFTS = (("root", "cm"), ("heading", "deg"))

Evaluation = dict[str, Any]
"""What `sparse-mocap evaluate --json` writes."""

HEAD = """# Accuracy

How far reconstructed joints are off. `./dev accuracy FOLDER` writes this file; the figures of the
README come from here. The tests of Tautges et al. 2011, with ours beside what the paper says, are
in [PAPER.md](PAPER.md).

- Error: RMS over the joints in the heading frame (root position and heading removed), mean over
  each clip's frames, then over clips.
- Known performer (scenario 1): the database holds other clips of the performer, never the test
  clip or a copy of it. Unknown performer (scenario 3): it holds none of the performer's clips.
- Live quality: each frame from what was measured until then and shortly after (latency). Best
  quality: each frame from the whole take.
- Oracle: the nearest pose in the database, chosen by looking at the truth.
- Movement: turn of a wrist from frame to frame, frames into which a joint turns over 60°, the
  largest step of a joint within a frame, speed of the feet while they stand in truth, how much
  higher or lower ankles are then than true ones (performers' ankles and recordings' floors differ,
  which no sensor tells), ankles more than 2 cm lower than they ever are in truth on the same floor,
  jerk as a part of the truth's (mean / largest of a clip), clips in which a joint steps three times
  as far as in truth, drift of root and heading after 2 s, and precision and recall of the warning
  that a reconstruction is no better than the clip's own mean pose. All are means over the clips but
  the largest step, the largest jerk ratio and the number of jumps.
- Orientations are those of trackers that are worn 2° askew (with a bias and noise of the
  accelerations as well) and whose headings drift by 0.1°/s.
"""


def evaluate(folder: Path, scenario: int, kind: str, kept: Path) -> Evaluation:
    """Run one evaluation, unless its JSON is kept."""
    path = kept / f"scenario_{scenario}_{kind}.json"
    if not path.exists():
        command = [sys.executable, "-m", "sparse_mocap", "evaluate", "--offline"]
        command += ["--database-source", str(folder), "--scenario", str(scenario)]
        command += ["--json", str(path), "--cache", str(kept), *KINDS[kind]]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    found: Evaluation = json.loads(path.read_text(encoding="utf-8"))
    return found


def kind_of(found: Evaluation) -> str:
    """What the sensors of an evaluation were, of KINDS."""
    if "orientation" in found["settings"]["channels"]:
        return "orientations"
    return "gyroscopes" if found["settings"]["with_gyroscopes"] else "accelerometers"


def label(method: str) -> str:
    """The method's name in a table: `path_regression`, live quality."""
    if method in BASELINES:
        return BASELINES[method]
    name, _, how = method.partition(", ")
    return f"`{name}`, {how or 'live'} quality"


def row(cells: Iterable[str]) -> str:
    """One line of a table."""
    return "|" + "".join(f" {cell} |".replace("  ", " ") for cell in cells)


def head(cells: Sequence[str]) -> list[str]:
    """The head of a table; all columns but the first hold figures."""
    return [row(cells), "|---" + "|---:" * (len(cells) - 1) + "|"]


def summary(evaluations: dict[int, Evaluation], suffix: str, skip: Sequence[str]) -> list[str]:
    """The mean errors in cm, a column a scenario."""
    methods = next(iter(evaluations.values()))["methods"]
    lines = []
    for method in methods:
        if method not in skip:
            means = [found["methods"][method]["mean_cm"] for found in evaluations.values()]
            lines.append(row([label(method) + suffix, *(f"{mean:.1f}" for mean in means)]))
    return lines


def details(found: Evaluation) -> list[str]:
    """All figures of one evaluation, and the errors of each class of movement."""
    lines = head(["cm", "mean", "median", "90 %", "angle °", "jerk km/s³", "latency ms"])
    for method, figures in found["methods"].items():
        errors = (f"{figures[key]:.2f}" for key in ("mean_cm", "median_cm", "p90_cm"))
        late, angle = figures["latency_ms"], figures["joint_angle_deg"]
        late_ms = "" if late is None else f"{late:.0f}"
        angle_deg = "" if angle is None else f"{angle:.1f}"
        jerk = f"{figures['jerk_kmps3']:.3f}"
        lines.append(row([label(method), *errors, angle_deg, jerk, late_ms]))
    lines += ["", *movements(found)]
    lines += ["", *head(["mean, cm", *map(label, found["methods"])])]
    for name in next(iter(found["methods"].values()))["class_errors_cm"]:
        errors = (f"{m['class_errors_cm'][name]:.1f}" for m in found["methods"].values())
        lines.append(row([name, *errors]))
    return lines


def movements(found: Evaluation) -> list[str]:
    """How methods move, beside the truth."""
    lines = head(["", *MOVEMENTS])
    lines.append(row(["truth", *_movement_cells(found["truth_movement"], None)]))
    for method, figures in found["methods"].items():
        if figures["movement"]:
            lines.append(row([label(method), *_movement_cells(figures["movement"], figures)]))
    return lines


def _movement_cells(moved: dict[str, Any], figures: dict[str, Any] | None) -> list[str]:
    wrists = 0.5 * (moved["turn_deg"]["lwrist"] + moved["turn_deg"]["rwrist"])
    cells = [
        f"{wrists:.1f}",
        f"{100.0 * moved['fast_turns']:.1f}",
        f"{moved['largest_step_cm']:.0f}",
    ]
    cells += [_told(moved["standing_cmps"], ".1f"), f"{moved['floor_offset_cm']:.1f}"]
    cells += [f"{100.0 * moved['under_floor']:.1f}"]
    if figures is None:
        return [*cells, "1.0", "0", "", "", ""]
    jerk = f"{figures['jerk_ratio']:.1f} / {figures['largest_jerk_ratio']:.1f}"
    cells += [jerk, str(figures["jumps"]["over_3_true_steps"])]
    cells += [_told(moved[f"{name}_after_2_s_{unit}"], ".0f") for name, unit in DRIFTS]
    warned = figures["warnings"].values()
    return [*cells, " / ".join(_told(share, ".2f") for share in warned)]


def _told(value: float | None, spec: str) -> str:
    return "-" if value is None else format(value, spec)


def setting(found: Evaluation) -> str:
    """What was performed, and by whom; what was worn."""
    settings, tests = found["settings"], found["tests"]
    actors = {test["actor"] for test in tests}
    classes = {test["motion_class"] for test in tests}
    worn = ", ".join(site.replace("_", " ") for site in settings["sites"])
    return (
        f"Data: `{Path(settings['source']).name}`; {len(tests)} clips performed, of "
        f"{len(actors)} performers and {len(classes)} kinds of movement;\n"
        f"a database of {settings['frames']:,} frames at {settings['rate_hz']:g} Hz.\n"
        f"Simulated sensors, noise {settings['noise']}: {worn}."
    )


def document(evaluations: Iterable[Evaluation]) -> str:
    """ACCURACY.md. Raises ValueError if a scenario is missing."""
    found = {(kind_of(e), e["scenario"]): e for e in evaluations}
    for scenario in SCENARIOS:
        if ("accelerometers", scenario) not in found:
            raise ValueError(f"there is no evaluation of scenario {scenario} without gyroscopes")
    kinds = [kind for kind in KINDS if all((kind, scenario) in found for scenario in SCENARIOS)]
    plain = found["accelerometers", next(iter(SCENARIOS))]
    lines = [HEAD, setting(plain), "", "Mean error in cm:", "", *head(["", *SCENARIOS.values()])]
    for kind in kinds:
        suffix, skip = ("", ()) if kind == "accelerometers" else (f", with {kind}", (*BASELINES,))
        lines += summary({n: found[kind, n] for n in SCENARIOS}, suffix, skip)
    for kind in kinds:
        for scenario in SCENARIOS:
            lines += ["", f"## {SCENARIOS[scenario].capitalize()}, {TITLES[kind]}", ""]
            lines += details(found[kind, scenario])
    return "\n".join(lines) + "\n"


def main(arguments: Sequence[str] | None = None) -> None:
    """Evaluate and write."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("folder", type=Path, help="recorded motion, HDM05 for the file kept here")
    parser.add_argument("-o", "--output", type=Path, default=ACCURACY)
    parser.add_argument("--json-folder", type=Path, help="keeps what each evaluation found")
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="sparse_mocap_") as temporary:
        kept = given.json_folder or Path(temporary)
        kept.mkdir(parents=True, exist_ok=True)
        evaluations = [
            evaluate(given.folder, scenario, kind, kept) for kind in KINDS for scenario in SCENARIOS
        ]
        given.output.write_text(document(evaluations), encoding="utf-8")


if __name__ == "__main__":
    main()
