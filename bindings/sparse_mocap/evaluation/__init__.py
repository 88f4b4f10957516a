# SPDX-License-Identifier: GPL-3.0-or-later
"""How good a reconstruction is: held-out clips, simulated sensors, known truth."""

from .clip_result import ClipResult, TestClip
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
from .protocol import (
    EVERYTHING,
    SCENARIOS,
    Content,
    choose_tests,
    excluded_clips,
    motion_files,
    source_path,
)
from .result import Evaluation
from .runner import BASELINES, Settings, evaluate

__all__ = [
    "BASELINES",
    "EVERYTHING",
    "SCENARIOS",
    "ClipResult",
    "Contender",
    "Content",
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
