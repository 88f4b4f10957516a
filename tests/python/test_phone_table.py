# SPDX-License-Identifier: GPL-3.0-or-later
"""PHONE.md says what the evaluation found."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from evaluation import phone_table


def found(title: str, mean_cm: float) -> dict[str, Any]:
    """As evaluate --json writes it."""
    parts = {"full body": mean_cm, "upper body": 1.0, "lower body": 3.0}
    figures = {
        "part_errors_cm": parts | {"full body, per axis": mean_cm / 3**0.5},
        "jerk_ratio": 0.512,
        "share_of_frames_under_5_cm": 0.98,
        "share_of_clips_under_5_cm": 0.5,
        "movement": {"heading_after_2_s_deg": 4.4},
    }
    methods = {"path": figures, "oracle": figures | {"movement": {}}, "playback": figures}
    return {"title": f"eom2014: {title}.", "tests": [{}, {}], "methods": methods}


def test_each_comparison_has_its_table(tmp_path: Path) -> None:
    kept, output = tmp_path / "kept.json", tmp_path / "PHONE.md"
    kept.write_text(json.dumps([found("Walks", 2.348), found("Runs", 3.6)]))
    phone_table.main(["nowhere", "--json", str(kept), "-o", str(output)])
    lines = output.read_text().splitlines()
    assert "## Walks" in lines
    assert "2 tests." in lines
    assert "| `eom2014` | 2.35 | 1.00 | 3.00 | 1.36 | 0.51 | 98 | 50 | 4 |" in lines
    nearest = "| nearest pose of the training clip to the truth | 3.60 | 1.00 | 3.00 | 2.08"
    assert any(line.startswith(nearest) for line in lines[lines.index("## Runs") :])
    assert not any("playback" in line for line in lines)
