# SPDX-License-Identifier: GPL-3.0-or-later
"""What an evaluation found."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .clip_result import TestClip
from .metrics import LIMBS
from .movement import DRIFT_AFTER_S, Movement

__all__ = ["HISTOGRAM_BIN_CM", "Evaluation"]

Floats = NDArray[np.float64]

HISTOGRAM_BIN_CM = 0.5
JUMP_CM = 50.0
CLOSE_CM = 5.0
FORMAT_VERSION = 1
"""Of the evaluation's JSON."""


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

    def root_frame_cm(self, method: str) -> dict[str, Any]:
        """Returns the errors in the full root frame, in which Tautges et al. 2011 measure."""
        known = [test.results[method].root_frame_errors_cm for test in self.tests]
        errors = [own for own in known if own is not None]
        if not errors:
            return {}
        means = np.array([own.mean() for own in errors])
        return _spread(means) | {"histogram": _histogram(np.concatenate(errors))}

    def limb_angles_deg(self, method: str) -> dict[str, float]:
        """Returns how far each limb's direction is off, a mean over the tests."""
        known = [test.results[method].limb_angles_deg for test in self.tests]
        found = [own for own in known if own is not None]
        means = np.mean(found, axis=0).tolist() if found else []
        return dict(zip(LIMBS, means, strict=False))

    def work(self, method: str) -> dict[str, float]:
        """Returns what a method says of its own work, means over the tests."""
        told = [test.results[method].work for test in self.tests]
        return {name: float(np.mean([own[name] for own in told])) for name in told[0]}

    def centred_cm(self, method: str) -> float:
        """Returns the error without each clip's own mean error, a mean over the tests."""
        return float(np.mean([test.results[method].centred_cm for test in self.tests]))

    def joint_errors_cm(self, method: str) -> dict[str, float]:
        """Returns each joint's error, a mean over the tests."""
        stacked = np.array([test.results[method].joint_errors_cm for test in self.tests])
        return dict(zip(self.joint_names, stacked.mean(axis=0).tolist(), strict=True))

    def part_errors_cm(self, method: str) -> dict[str, float]:
        """Returns the errors of parts of the body, means over the tests.

        Per axis is the RMS over joints and axes, in place of distances in space.
        """
        results = [test.results[method] for test in self.tests]
        full = float(np.mean([result.mean_cm for result in results]))
        return {
            "full body": full,
            "upper body": float(np.mean([result.upper_body_cm for result in results])),
            "lower body": float(np.mean([result.lower_body_cm for result in results])),
            "full body, per axis": full / float(np.sqrt(3.0)),
        }

    def share_of_close_frames(self, method: str) -> float:
        """Returns the share of all tests' frames with an error of less than 5 cm."""
        return float(np.mean(self.frame_errors_cm(method) < CLOSE_CM))

    def share_of_close_clips(self, method: str) -> float:
        """Returns the share of tests of which every frame has an error of less than 5 cm."""
        return float(
            np.mean([test.results[method].frame_errors_cm.max() < CLOSE_CM for test in self.tests])
        )

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

    def euler_errors_deg(self, method: str) -> Floats | None:
        """Returns the Euler angle errors of all frames of all tests; None for positions alone."""
        known = [test.results[method].euler_errors_deg for test in self.tests]
        found = [errors for errors in known if errors is not None]
        return np.concatenate(found) if found else None

    def movement(self, method: str | None) -> dict[str, Any]:
        """Returns the means over the tests of how a method, or with None the truth, moves."""
        movements = [self._movement(test, method) for test in self.tests]
        known = [movement for movement in movements if movement is not None]
        if not known:
            return {}
        turns = np.mean([movement.turn_deg for movement in known], axis=0)
        figures: dict[str, Any] = {
            "turn_deg": dict(zip(self.joint_names, turns.tolist(), strict=True)),
            "fast_turns": _mean([m.fast_turns for m in known]),
            "largest_step_cm": max(m.largest_step_cm for m in known),
            "standing_cmps": _mean([m.standing_cmps for m in known]),
            "floor_offset_cm": _mean([abs(m.floor_offset_cm) for m in known]),
            "under_floor": _mean([m.under_floor for m in known]),
        }
        if method is not None:
            for after_s in DRIFT_AFTER_S:
                figures[f"root_after_{after_s}_s_cm"] = _mean(
                    [m.root_drift_cm[after_s] for m in known]
                )
                figures[f"heading_after_{after_s}_s_deg"] = _mean(
                    [m.heading_drift_deg[after_s] for m in known]
                )
        return figures

    @staticmethod
    def _movement(test: TestClip, method: str | None) -> Movement | None:
        return test.movement if method is None else test.results[method].movement

    def jumps(self, method: str) -> dict[str, int]:
        """Returns in how many tests a joint jumps.

        Over 50 cm in one frame, and over three times the largest step of the truth.
        """
        steps = [
            (test.results[method].movement, test.movement.largest_step_cm) for test in self.tests
        ]
        known = [(moved.largest_step_cm, true) for moved, true in steps if moved is not None]
        return {
            "over_50_cm": sum(step > JUMP_CM for step, _ in known),
            "over_3_true_steps": sum(step > 3.0 * true for step, true in known),
        }

    def jerk_ratios(self, method: str) -> Floats:
        """Returns each test's jerk as a part of the truth's."""
        return np.array([t.results[method].jerk_kmps3 / t.jerk_kmps3 for t in self.tests])

    def warnings(self, method: str) -> dict[str, float | None]:
        """Returns how right the warning of a poor match is.

        It should come for the tests that are worse than the clip's own mean pose held still.
        precision: how many of the warnings are right; recall: how many such tests are warned of.
        None where there are none.
        """
        told = [test.results[method].match for test in self.tests]
        if None in told or any("mean pose" not in test.results for test in self.tests):
            return {"precision": None, "recall": None}
        is_worse = self.clip_means_cm(method) > self.clip_means_cm("mean pose")
        is_warned = np.array([match == "poor" for match in told])
        right = int((is_worse & is_warned).sum())
        return {
            "precision": right / int(is_warned.sum()) if is_warned.any() else None,
            "recall": right / int(is_worse.sum()) if is_worse.any() else None,
        }

    @property
    def classes(self) -> list[str]:
        """The kinds of movement of the tests, sorted."""
        return sorted({test.motion_class for test in self.tests})

    def of_class(self, name: str) -> Evaluation:
        """Returns the part that is about one kind of movement."""
        return replace(self, tests=[test for test in self.tests if test.motion_class == name])

    def moving(self, method: str) -> dict[str, Any]:
        """Returns how a method moves, beside the truth, and how right its warnings are."""
        ratios = self.jerk_ratios(method)
        return {
            "tests": len(self.tests),
            "jerk_ratio": float(np.mean(ratios)),
            "largest_jerk_ratio": float(np.max(ratios)),
            "movement": self.movement(method),
            "truth_movement": self.movement(None),
            "jumps": self.jumps(method),
            "warnings": self.warnings(method),
        }

    def summary(self, method: str) -> dict[str, Any]:
        """Returns the figures of one method as JSON has them."""
        eulers = self.euler_errors_deg(method)
        return {
            **_spread(self.clip_means_cm(method)),
            "root_frame": self.root_frame_cm(method),
            "centred_cm": self.centred_cm(method),
            "limb_angles_deg": self.limb_angles_deg(method),
            "work": self.work(method),
            "joint_angle_deg": self.angle_error_deg(method),
            "euler_angle_deg": None if eulers is None else float(eulers.mean()),
            "euler_angle_deviation_deg": None if eulers is None else float(eulers.std()),
            "jerk_kmps3": self.jerk_kmps3(method),
            "jerk_ratio": float(np.mean(self.jerk_ratios(method))),
            "largest_jerk_ratio": float(np.max(self.jerk_ratios(method))),
            "latency_ms": self.latencies_ms[method],
            "movement": self.movement(method),
            "jumps": self.jumps(method),
            "warnings": self.warnings(method),
            "part_errors_cm": self.part_errors_cm(method),
            "share_of_frames_under_5_cm": self.share_of_close_frames(method),
            "share_of_clips_under_5_cm": self.share_of_close_clips(method),
            "class_errors_cm": self.class_errors_cm(method),
            "classes": {name: self.of_class(name).moving(method) for name in self.classes},
            "joint_errors_cm": self.joint_errors_cm(method),
            "histogram": _histogram(self.frame_errors_cm(method)),
        }

    def as_dict(self) -> dict[str, Any]:
        """Returns everything as JSON has it."""
        return {
            "format": "sparse_mocap_evaluation",
            "format_version": FORMAT_VERSION,
            "scenario": self.scenario,
            "settings": self.settings,
            "truth_movement": self.movement(None),
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
                    "root_frame_cm": {
                        method: float(r.root_frame_errors_cm.mean())
                        for method, r in test.results.items()
                        if r.root_frame_errors_cm is not None
                    },
                    "euler_angle_deg": {
                        method: _list(r.euler_errors_deg) for method, r in test.results.items()
                    },
                    "match": {method: r.match for method, r in test.results.items()},
                    "movement": {
                        method: _figures(self._movement(test, name))
                        for method, name in [("truth", None), *((m, m) for m in test.results)]
                    },
                    "jerk_kmps3": {"truth": test.jerk_kmps3}
                    | {method: r.jerk_kmps3 for method, r in test.results.items()},
                }
                for test in self.tests
            ],
            "left_out": self.left_out,
        }


def _figures(movement: Movement | None) -> dict[str, Any] | None:
    """Returns the figures of one test as JSON has them; None for NaN."""
    if movement is None:
        return None
    figures = asdict(movement)
    del figures["turn_deg"]
    drifts = {f"{name}_drift_{unit}" for name, unit in (("root", "cm"), ("heading", "deg"))}
    return {
        name: {str(s): _known(v) for s, v in value.items()} if name in drifts else _known(value)
        for name, value in figures.items()
    }


def _spread(means_cm: Floats) -> dict[str, float]:
    """Returns mean, median and 90th percentile of the clips' means."""
    return {
        "mean_cm": float(means_cm.mean()),
        "median_cm": float(np.median(means_cm)),
        "p90_cm": float(np.percentile(means_cm, 90)),
    }


def _histogram(errors_cm: Floats) -> dict[str, Any]:
    """Returns how many frames lie in each bin of HISTOGRAM_BIN_CM."""
    num_bins = int(errors_cm.max() / HISTOGRAM_BIN_CM) + 1
    counts = np.histogram(errors_cm, num_bins, (0.0, num_bins * HISTOGRAM_BIN_CM))[0]
    return {"bin_cm": HISTOGRAM_BIN_CM, "frames": counts.tolist()}


def _list(values: Floats | None) -> list[float] | None:
    """Returns the values of every frame, rounded as JSON has them."""
    return None if values is None else [round(float(value), 3) for value in values]


def _known(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _mean(values: list[float]) -> float | None:
    """Returns the mean of those that are known; None when none is."""
    known = [value for value in values if np.isfinite(value)]
    return float(np.mean(known)) if known else None
