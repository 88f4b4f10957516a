# SPDX-License-Identifier: GPL-3.0-or-later
"""What an evaluation found on one clip."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .metrics import CM, LOWER_BODY, UPPER_BODY, frame_errors
from .movement import Movement

__all__ = ["ClipResult", "TestClip", "clip_result"]

Floats = NDArray[np.float64]


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
    movement: Movement | None = None
    """None where only positions are known."""
    match: str | None = None
    """What the reconstruction says of itself; None of baselines."""
    euler_errors_deg: Floats | None = None
    """(T,) mean over the joints' Euler angles; None where only positions are known."""
    upper_body_cm: float = float("nan")
    """Mean over the frames of the RMS over the joints above the hips."""
    lower_body_cm: float = float("nan")
    """The same of hips and legs."""
    root_frame_errors_cm: Floats | None = None
    """(T,) RMS over the joints in the full root frame, as Tautges et al. 2011 measure."""
    centred_cm: float = float("nan")
    """Mean over the frames of the RMS over the joints, without each joint's mean error."""
    limb_angles_deg: Floats | None = None
    """(L,) of LIMBS, mean over the frames."""
    work: Mapping[str, float] = field(default_factory=dict)
    """What the method says of its own work, means over the frames."""

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
    movement: Movement
    """Of the truth."""
    results: dict[str, ClipResult] = field(default_factory=dict)


def clip_result(
    errors_m: Floats,
    centred_m: Floats,
    root_frame_m: Floats,
    limbs_deg: Floats,
    jerk_kmps3: float,
    *,
    angle_errors_deg: Floats | None = None,
    movement: Movement | None = None,
    match: str | None = None,
    euler_errors_deg: Floats | None = None,
    work: Mapping[str, float] | None = None,
) -> ClipResult:
    """Returns the result with errors in cm.

    errors_m, centred_m and root_frame_m (T, J) are distances in the heading frame, without each
    joint's mean error, and in the root frame; limbs_deg is (T, L).
    """
    means = [
        CM * float(frame_errors(errors).mean())
        for errors in (errors_m[:, UPPER_BODY], errors_m[:, LOWER_BODY], centred_m)
    ]
    return ClipResult(
        CM * frame_errors(errors_m),
        CM * errors_m.mean(axis=0),
        jerk_kmps3,
        None if angle_errors_deg is None else angle_errors_deg.mean(axis=0),
        movement,
        match,
        euler_errors_deg,
        means[0],
        means[1],
        CM * frame_errors(root_frame_m),
        means[2],
        limbs_deg.mean(axis=0),
        work or {},
    )
