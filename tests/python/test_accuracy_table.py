# SPDX-License-Identifier: GPL-3.0-or-later
"""ACCURACY.md says what the evaluations found, and the README says what it says."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from evaluation import accuracy_table
from readme_blocks import README

HEAD = "| | known performer | unknown performer |"
CLASSES = ("squat", "walk")
LATENCIES = {"path_regression": 75.4, "path_regression, best": None, "oracle": None}

MOVEMENT = {
    "turn_deg": {"lwrist": 2.0, "rwrist": 3.0, "head": 1.0},
    "fast_turns": 0.012,
    "largest_step_cm": 30.4,
    "standing_cmps": 11.06,
    "floor_offset_cm": 1.25,
    "under_floor": 0.0,
}
DRIFTS = {"root_after_2_s_cm": 25.6, "heading_after_2_s_deg": None}


def found(scenario: int, kind: str, mean_cm: float) -> dict[str, Any]:
    """As evaluate --json writes it; each method is a centimetre worse than the one before."""
    methods = {
        method: {
            "mean_cm": mean_cm + index,
            "median_cm": 2.0,
            "p90_cm": 3.456,
            "joint_angle_deg": None if method == "oracle" else 12.34,
            "jerk_kmps3": 0.1234,
            "latency_ms": late,
            "class_errors_cm": dict.fromkeys(CLASSES, mean_cm + index),
            "movement": {} if method == "oracle" else MOVEMENT | DRIFTS,
            "jerk_ratio": 1.24,
            "largest_jerk_ratio": 1.96,
            "jumps": {"over_50_cm": 0, "over_3_true_steps": 2},
            "warnings": {"precision": 0.5, "recall": None},
        }
        for index, (method, late) in enumerate(LATENCIES.items())
    }
    settings = {
        "source": "/somewhere/mocap", "with_gyroscopes": kind == "gyroscopes",
        "channels": ["specific_force"] + ["orientation"] * (kind == "orientations"),
        "sites": ["left_wrist", "right_wrist"], "noise": "none", "frames": 12345, "rate_hz": 25.0,
    }  # fmt: skip
    tests = [{"actor": "ada", "motion_class": name} for name in CLASSES]
    told = {"scenario": scenario, "settings": settings, "methods": methods, "tests": tests}
    return told | {"truth_movement": MOVEMENT}


ALL = [
    found(1, "accelerometers", 5.04),
    found(3, "accelerometers", 8.0),
    found(1, "gyroscopes", 4.0),
    found(3, "gyroscopes", 7.0),
    found(1, "orientations", 3.0),
    found(3, "orientations", 6.0),
]


def test_the_document_has_every_figure_and_no_path() -> None:
    text = accuracy_table.document(ALL)
    lines = text.splitlines()
    assert HEAD in lines
    assert "| `path_regression`, live quality | 5.0 | 8.0 |" in lines
    assert "| `path_regression`, best quality | 6.0 | 9.0 |" in lines
    assert "| oracle | 7.0 | 10.0 |" in lines
    assert "| `path_regression`, live quality, with gyroscopes | 4.0 | 7.0 |" in lines
    assert "| `path_regression`, live quality, with orientations | 3.0 | 6.0 |" in lines
    assert "| oracle, with gyroscopes" not in text
    assert "| `path_regression`, live quality | 5.04 | 2.00 | 3.46 | 12.3 | 0.123 | 75 |" in lines
    assert "| oracle | 9.00 | 2.00 | 3.46 | | 0.123 | |" in lines
    assert "| truth | 2.5 | 1.2 | 30 | 11.1 | 1.2 | 0.0 | 1.0 | 0 | | | |" in lines
    moved = "2.5 | 1.2 | 30 | 11.1 | 1.2 | 0.0 | 1.2 / 2.0 | 2 | 26 | - | 0.50 / -"
    assert f"| `path_regression`, best quality | {moved} |" in lines
    assert text.count("| walk | ") == 6
    assert "`mocap`; 2 clips performed" in text
    assert "12,345" in text
    assert "/somewhere" not in text


def test_the_order_of_the_evaluations_is_all_one() -> None:
    assert accuracy_table.document(ALL) == accuracy_table.document(ALL[::-1])


def test_a_missing_scenario_is_told() -> None:
    with pytest.raises(ValueError, match="no evaluation of scenario 3"):
        accuracy_table.document(ALL[:1])


def test_a_folder_becomes_a_table(library: Path, tmp_path: Path) -> None:
    source, folder, out = (tmp_path / name for name in ("few", "json", "ACCURACY.md"))
    source.mkdir()
    for path in library.glob("*_walk_*.bvh"):
        shutil.copy(path, source)
    accuracy_table.main([str(source), "-o", str(out), "--json-folder", str(folder)])
    written = out.read_bytes()
    told = {path.stem: json.loads(path.read_text()) for path in folder.glob("*.json")}
    assert len(told) == 6
    for method, figures in told["scenario_1_accelerometers"]["methods"].items():
        unknown = told["scenario_3_accelerometers"]["methods"][method]
        means = f"{figures['mean_cm']:.1f} | {unknown['mean_cm']:.1f}"
        assert f"| {accuracy_table.label(method)} | {means} |" in written.decode()
    accuracy_table.main([str(source), "-o", str(out), "--json-folder", str(folder)])
    assert out.read_bytes() == written


def test_the_readmes_figures_are_those_of_the_table() -> None:
    lines = README.read_text(encoding="utf-8").replace("**", "").splitlines()
    begin = lines.index(HEAD)
    rows = lines[begin + 2 : lines.index("", begin)]
    assert len(rows) >= 5
    table = accuracy_table.ACCURACY.read_text(encoding="utf-8").splitlines()
    assert [row for row in rows if row not in table] == []
    assert "tests/evaluation/ACCURACY.md" in README.read_text(encoding="utf-8")
