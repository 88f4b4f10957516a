# SPDX-License-Identifier: GPL-3.0-or-later
"""What an evaluation found."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .metrics import CM

__all__ = ["ClipResult", "Evaluation", "TestClip", "clip_result"]

Floats = NDArray[np.float64]

HISTOGRAM_BIN_CM = 0.5
FORMAT_VERSION = 1
"""Of the evaluation's JSON."""


@dataclass(frozen=True)
class ClipResult:
    """One method on one test clip."""

    frame_errors_cm: Floats
    """(T,) RMS over the joints."""
    joint_errors_cm: Floats
    """(J,) mean over the frames."""
    jerk_kmps3: float
    joint_angle_errors_deg: Floats | None = None
    """(J,) mean over the frames; None where only positions are known."""

    @property
    def mean_angle_deg(self) -> float | None:
        """The mean over frames and joints."""
        angles = self.joint_angle_errors_deg
        return None if angles is None else float(angles.mean())

    @property
    def mean_cm(self) -> float:
        """The mean over the frames."""
        return float(self.frame_errors_cm.mean())


@dataclass
class TestClip:
    """One test: the clip and how each method did on it."""

    __test__ = False  # no test case of pytest

    name: str
    actor: str
    motion_class: str
    num_frames: int
    num_excluded: int
    jerk_kmps3: float
    results: dict[str, ClipResult] = field(default_factory=dict)


@dataclass
class Evaluation:
    """All tests of one scenario."""

    scenario: int
    settings: dict[str, Any]
    joint_names: list[str]
    latencies_ms: dict[str, float | None]
    """By method; None where the whole performance is looked at, or the truth."""
    tests: list[TestClip] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    """Clips that could not be tested, and why."""

    @property
    def methods(self) -> list[str]:
        """The methods, in the order of tables."""
        return list(self.latencies_ms)

    def clip_means_cm(self, method: str) -> Floats:
        """Returns each test's mean error."""
        return np.array([test.results[method].mean_cm for test in self.tests])

    def frame_errors_cm(self, method: str) -> Floats:
        """Returns the errors of all frames of all tests."""
        return np.concatenate([test.results[method].frame_errors_cm for test in self.tests])

    def joint_errors_cm(self, method: str) -> dict[str, float]:
        """Returns each joint's error, a mean over the tests."""
        stacked = np.array([test.results[method].joint_errors_cm for test in self.tests])
        return dict(zip(self.joint_names, stacked.mean(axis=0).tolist(), strict=True))

    def class_errors_cm(self, method: str) -> dict[str, float]:
        """Returns the error in each class, a mean over its tests."""
        classes: dict[str, list[float]] = {}
        for test in self.tests:
            classes.setdefault(test.motion_class, []).append(test.results[method].mean_cm)
        return {name: float(np.mean(means)) for name, means in sorted(classes.items())}

    def jerk_kmps3(self, method: str) -> float:
        """Returns the mean joint jerk, a mean over the tests."""
        return float(np.mean([test.results[method].jerk_kmps3 for test in self.tests]))

    def angle_error_deg(self, method: str) -> float | None:
        """Returns the mean joint angle error, a mean over the tests; None for positions alone."""
        means = [test.results[method].mean_angle_deg for test in self.tests]
        known = [mean for mean in means if mean is not None]
        return float(np.mean(known)) if known else None

    def summary(self, method: str) -> dict[str, Any]:
        """Returns the figures of one method as JSON has them."""
        means, frames = self.clip_means_cm(method), self.frame_errors_cm(method)
        num_bins = int(frames.max() / HISTOGRAM_BIN_CM) + 1
        counts = np.histogram(frames, num_bins, (0.0, num_bins * HISTOGRAM_BIN_CM))[0]
        return {
            "mean_cm": float(means.mean()),
            "median_cm": float(np.median(means)),
            "p90_cm": float(np.percentile(means, 90)),
            "joint_angle_deg": self.angle_error_deg(method),
            "jerk_kmps3": self.jerk_kmps3(method),
            "latency_ms": self.latencies_ms[method],
            "class_errors_cm": self.class_errors_cm(method),
            "joint_errors_cm": self.joint_errors_cm(method),
            "histogram": {"bin_cm": HISTOGRAM_BIN_CM, "frames": counts.tolist()},
        }

    def as_dict(self) -> dict[str, Any]:
        """Returns everything as JSON has it."""
        return {
            "format": "sparse_mocap_evaluation",
            "format_version": FORMAT_VERSION,
            "scenario": self.scenario,
            "settings": self.settings,
            "truth_jerk_kmps3": float(np.mean([test.jerk_kmps3 for test in self.tests])),
            "methods": {method: self.summary(method) for method in self.methods},
            "tests": [
                {
                    "name": test.name,
                    "actor": test.actor,
                    "motion_class": test.motion_class,
                    "frames": test.num_frames,
                    "excluded_clips": test.num_excluded,
                    "error_cm": {method: r.mean_cm for method, r in test.results.items()},
                }
                for test in self.tests
            ],
            "left_out": self.left_out,
        }


def clip_result(
    errors_m: Floats,
    frame_errors_m: Floats,
    jerk_kmps3: float,
    angle_errors_deg: Floats | None = None,
) -> ClipResult:
    """Returns the result with errors in cm: of the joints (T, J) and of the frames (T,)."""
    angles = None if angle_errors_deg is None else angle_errors_deg.mean(axis=0)
    return ClipResult(CM * frame_errors_m, CM * errors_m.mean(axis=0), jerk_kmps3, angles)
