# SPDX-License-Identifier: GPL-3.0-or-later
"""How good a reconstruction is: held-out clips, simulated sensors, known truth."""

from .contender import Contender, contenders, variants
from .metrics import (
    frame_errors,
    interpolated,
    joint_angle_errors_deg,
    joint_errors,
    mean_jerk,
)
from .movement import Movement
from .performance import Performance, performed
from .protocol import SCENARIOS, choose_tests, excluded_clips, motion_files, source_path
from .result import ClipResult, Evaluation, TestClip
from .runner import BASELINES, Settings, evaluate

__all__ = [
    "BASELINES",
    "SCENARIOS",
    "ClipResult",
    "Contender",
    "Evaluation",
    "Movement",
    "Performance",
    "Settings",
    "TestClip",
    "choose_tests",
    "contenders",
    "evaluate",
    "excluded_clips",
    "frame_errors",
    "interpolated",
    "joint_angle_errors_deg",
    "joint_errors",
    "mean_jerk",
    "motion_files",
    "performed",
    "source_path",
    "variants",
]
