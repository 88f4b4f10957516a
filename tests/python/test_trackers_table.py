# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of six trackers: its parts of a clip, and what it writes."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest
from sparse_mocap import read_motion

TOOL = Path(__file__).resolve().parents[1] / "evaluation" / "trackers_table.py"


@pytest.fixture(scope="module")
def tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("trackers_table", TOOL)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["trackers_table"] = module
    spec.loader.exec_module(module)
    return module


def test_parts_of_the_punching_clip_leave_its_borders_out(
    tool: ModuleType, library: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tool, "PUNCHING", "ada_walk_01")
    whole = read_motion(library / "ada_walk_01.bvh")[0]
    pairs = tool.punching_parts(library, tmp_path)
    assert len(pairs) == tool.FOLDS
    left_out = round(tool.LEFT_OUT_S / whole.frame_time_s)

    def frames(name: str) -> int:
        path = tmp_path / name
        return int(read_motion(path)[0].num_frames) if path.exists() else 0

    for fold in range(tool.FOLDS):
        tested = frames(f"test{fold}.bvh")
        known = frames(f"train{fold}_before.bvh") + frames(f"train{fold}_after.bvh")
        borders = 1 if fold in (0, tool.FOLDS - 1) else 2
        assert abs(tested + known + borders * left_out - whole.num_frames) <= 1


def test_the_document_has_every_figure(tool: ModuleType) -> None:
    one = {"mean_cm": 1.234, "euler_angle_deg": 2.5, "euler_angle_deviation_deg": 0.75,
           "joint_angle_deg": 3.0}  # fmt: skip
    nearest = {"mean_cm": 5.0, "euler_angle_deg": 4.0, "euler_angle_deviation_deg": 1.0,
               "joint_angle_deg": None}  # fmt: skip
    other = one | {"mean_cm": 3.234, "euler_angle_deg": 4.0}
    names = (*tool.COMPARED, tool.COMBINED)

    def part(figures: dict[str, float]) -> dict[str, object]:
        labelled = {f"{name}/ours": figures for name in names}
        return {"clips": 7, "figures": labelled | {"nearest pose": nearest}, "curves": {}}

    actions = {"walk": part(one), "run": part(other), "jump": part(one)}
    apart = {"HDM05, known performer": {"clips": 5, "figures": {"liu2011, live": one}}}
    found = {"none": actions, "optical": actions, "ultrasonic": actions}
    found |= {f"without_positions_{noise}": apart for noise in ("none", "inertial")}
    text = tool.document(found, {"Walk (35_01)": "trackers_walk.png"})
    assert "| | walk | run | jump | mean |" in text
    assert "| ours | 2.50 ± 0.75 | 4.00 ± 0.75 | 2.50 ± 0.75 | 3.00 ± 0.75 |" in text
    assert "| ours | 3.00 / 1.23 | 3.00 / 3.23 | 3.00 / 1.23 | 3.00 / 1.90 |" in text
    assert "| nearest pose | – / 5.00 | – / 5.00 | – / 5.00 | – / 5.00 |" in text
    assert "| liu2011, live | 3.00 / 1.23 |" in text
    assert "Clips tested: walk 7, run 7, jump 7." in text
    assert "![Walk (35_01)](trackers_walk.png)" in text
    assert all(title in text for title in tool.NOISES.values())
