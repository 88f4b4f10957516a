# SPDX-License-Identifier: GPL-3.0-or-later
"""How good a reconstruction is: held-out clips, simulated sensors, known truth."""

from .metrics import frame_errors, interpolated, joint_errors, mean_jerk
from .performance import Performance, performed, reconstructed_positions
from .protocol import SCENARIOS, choose_tests, excluded_clips, motion_files, source_path
from .result import ClipResult, Evaluation, TestClip
from .runner import BASELINES, Settings, evaluate

__all__ = [
    "BASELINES",
    "SCENARIOS",
    "ClipResult",
    "Evaluation",
    "Performance",
    "Settings",
    "TestClip",
    "choose_tests",
    "evaluate",
    "excluded_clips",
    "frame_errors",
    "interpolated",
    "joint_errors",
    "mean_jerk",
    "motion_files",
    "performed",
    "reconstructed_positions",
    "source_path",
]
