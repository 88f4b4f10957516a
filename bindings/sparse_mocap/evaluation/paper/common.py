# SPDX-License-Identifier: GPL-3.0-or-later
"""What the parts of the paper's evaluation share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..contender import Contender
from ..runner import Settings
from .runs import Found

__all__ = [
    "BEST",
    "EASED",
    "LIVE",
    "PAPER",
    "SCENARIO_NAMES",
    "by_actor",
    "cm",
    "difference",
    "mean_cm",
    "plain",
    "told_difference",
    "variant",
]

SCENARIO_NAMES = {
    1: "scenario 1 (performer and others)",
    2: "scenario 2 (performer alone)",
    3: "scenario 3 (others alone)",
}


def variant(label: str, **options: Any) -> Contender:
    """Returns the paper's method as published, with some options."""
    return Contender(label, "tautges2011", None, {"follow_s": 0, **options})


PAPER = variant("`tautges2011`, as published")
EASED = Contender("`tautges2011`, eased (its default)", "tautges2011")
LIVE = Contender("`path_regression`, live", "path_regression")
BEST = Contender("`path_regression`, best", "path_regression", best_quality=True)


def plain(scenario: int, *contenders: Contender, **settings: Any) -> Settings:
    """Returns settings of an evaluation without baselines."""
    return Settings(scenario, contenders, with_baselines=False, **settings)


def mean_cm(found: Found, label: str, frame: str = "root_frame") -> float:
    """Returns a method's error in the root frame, in which the paper measures, or the heading's."""
    told = found["methods"][label]
    return float(told["root_frame"]["mean_cm"] if frame == "root_frame" else told["mean_cm"])


def cm(value: float, digits: int = 1) -> str:
    """Returns a figure as tables have it."""
    return "-" if np.isnan(value) else f"{value:.{digits}f}"


def difference(found: Found, label: str, other: str) -> tuple[float, float]:
    """Returns how much farther off a method is than another, and half of its 95 % interval.

    Both in cm in the root frame, paired over the clips.
    """
    pairs = [
        (test["root_frame_cm"][label], test["root_frame_cm"][other]) for test in found["tests"]
    ]
    off = np.array([one - two for one, two in pairs])
    if len(off) < 2:
        return float(off.mean()), float("nan")
    return float(off.mean()), float(1.96 * off.std(ddof=1) / np.sqrt(len(off)))


def told_difference(found: Found, label: str, other: str) -> str:
    """Returns that difference as tables have it."""
    off, half = difference(found, label, other)
    return f"{off:+.2f}" if np.isnan(half) else f"{off:+.2f} ± {half:.2f}"


def by_actor(found: Found, label: str, actors: Sequence[str]) -> list[float]:
    """Returns the mean error in the root frame for each performer; NaN where none is tested."""
    means = []
    for actor in actors:
        own = [t["root_frame_cm"][label] for t in found["tests"] if t["actor"] == actor]
        means.append(float(np.mean(own)) if own else float("nan"))
    return means
