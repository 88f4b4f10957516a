# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes PHONE.md: what one phone gives on walks, runs and jumps of CMU, by eom2014 and others.

phone_table.py FOLDER [-o PHONE.md] [--json FILE]

Runs the comparisons of eom2014's paper by `sparse-mocap evaluate` on FOLDER, CMU's trials as BVH.
With --json what they found is kept in that file, or read from it if it is there.
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

PHONE = Path(__file__).with_name("PHONE.md")
LEFT_OUT = ("playback", "window of 10")
"""Baselines of databases of many clips."""
NAMES = {
    "path": "`eom2014`",
    "path, live": "`eom2014`, live",
    "path_regression": "`path_regression` on the training clip",
    "path_regression, all clips": "`path_regression` on all clips",
    "oracle": "nearest pose of the training clip to the truth",
    "mean pose": "the test's own mean pose, held still",
}

COLUMNS = (
    "cm",
    "full body",
    "upper",
    "lower",
    "per axis",
    "jitter",
    "frames under 5 cm, %",
    "clips under 5 cm, %",
    "heading, °",
)

HEAD = """# One phone

How far reconstructed joints are off when one simulated phone (accelerometer and gyroscope) is all
there is. `tests/evaluation/phone_table.py FOLDER` writes this file; FOLDER holds CMU's trials.

- Each model knows one clip and is tested on others. Error: RMS over the joints in the heading
  frame, in cm, mean over each clip's frames, then over clips; per axis is the RMS over joints and
  axes.
- The stages of the paper (figure 8, table 1) from `linear` to `perceptron a phase` see one reading
  at a time; `windows` see eight before and after it as well.
- `all clips`: all of the folder but the test clip, and not the performer's other clips where the
  training clip is of somebody else.
- Jitter: jerk as a part of the truth's. Under 5 cm: the share of frames, and of clips of which
  every frame is. Heading: how far the body's turning is off after 2 s.
"""


def row(cells: Iterable[str]) -> str:
    """One line of a table."""
    return "|" + "".join(f" {cell} |" for cell in cells)


def tables(found: dict[str, Any]) -> list[str]:
    """One comparison: its figures, a line for each way."""
    title = found["title"].partition(": ")[2]
    lines = [f"## {title.rstrip('.')}", "", f"{len(found['tests'])} tests.", ""]
    lines += [row(COLUMNS), "|---" + "|---:" * (len(COLUMNS) - 1) + "|"]
    for label, figures in found["methods"].items():
        if label not in LEFT_OUT:
            lines.append(row([NAMES.get(label, label), *_cells(figures)]))
    return lines


def _cells(figures: dict[str, Any]) -> list[str]:
    parts = figures["part_errors_cm"]
    names = ("full body", "upper body", "lower body", "full body, per axis")
    turned = (figures["movement"] or {}).get("heading_after_2_s_deg")
    return [
        *(f"{parts[name]:.2f}" for name in names),
        f"{figures['jerk_ratio']:.2f}",
        f"{100.0 * figures['share_of_frames_under_5_cm']:.0f}",
        f"{100.0 * figures['share_of_clips_under_5_cm']:.0f}",
        "" if turned is None else f"{turned:.0f}",
    ]


def document(comparisons: Sequence[dict[str, Any]]) -> str:
    """PHONE.md."""
    lines = [HEAD]
    for found in comparisons:
        lines += [*tables(found), ""]
    return "\n".join(lines)


def evaluate(folder: Path, path: Path) -> None:
    """Run all comparisons."""
    command = [sys.executable, "-m", "sparse_mocap", "evaluate", "--database-source", str(folder)]
    command += ["--scenario", "1", "--method", "eom2014", "--paper", "--json", str(path)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def main(arguments: Sequence[str] | None = None) -> None:
    """Evaluate and write."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("folder", type=Path, help="CMU's trials as BVH")
    parser.add_argument("-o", "--output", type=Path, default=PHONE)
    parser.add_argument("--json", type=Path, help="keeps what the evaluation found")
    given = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="sparse_mocap_") as temporary:
        path = given.json or Path(temporary) / "phone.json"
        if not path.exists():
            evaluate(given.folder, path)
        comparisons = json.loads(path.read_text(encoding="utf-8"))
    given.output.write_text(document(comparisons), encoding="utf-8")


if __name__ == "__main__":
    main()
