# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a motion is from the truth."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "LIMBS",
    "centred_errors",
    "euler_errors_deg",
    "frame_errors",
    "interpolated",
    "joint_angle_errors_deg",
    "joint_errors",
    "limb_angles_deg",
    "mean_jerk",
    "nearest",
]

Floats = NDArray[np.float64]

CM = 100.0
LOWER_BODY = slice(1, 7)
"""Hips, knees and ankles among the joints of the standard skeleton, which begins at the root."""
UPPER_BODY = slice(7, 21)

LIMBS = {
    "trunk": ("root", "thorax"),
    "head": ("lowerneck", "head"),
    "left upper arm": ("lclavicle", "lhumerus"),
    "left forearm": ("lhumerus", "lradius"),
    "right upper arm": ("rclavicle", "rhumerus"),
    "right forearm": ("rhumerus", "rradius"),
    "left thigh": ("lhipjoint", "lfemur"),
    "left shank": ("lfemur", "ltibia"),
    "right thigh": ("rhipjoint", "rfemur"),
    "right shank": ("rfemur", "rtibia"),
}
"""The joints of the standard skeleton between whose ends a limb lies."""


def interpolated(times_s: Floats, values: Floats, wanted_s: Floats) -> Floats:
    """Returns values (T, ...) at the times wanted, linearly between the nearest two."""
    flat = values.reshape(len(times_s), -1)
    columns = [np.interp(wanted_s, times_s, flat[:, k]) for k in range(flat.shape[1])]
    return np.stack(columns, axis=1).reshape(len(wanted_s), *values.shape[1:])


def joint_errors(truth: Floats, estimate: Floats) -> Floats:
    """Returns the distances (T, J), in m, between positions (T, J, 3)."""
    return np.asarray(np.linalg.norm(estimate - truth, axis=-1))


def frame_errors(errors: Floats) -> Floats:
    """Returns for each frame the RMS over its joints (T, J)."""
    return np.asarray(np.sqrt(np.mean(errors**2, axis=1)))


def centred_errors(truth: Floats, estimate: Floats) -> Floats:
    """Returns the distances (T, J), in m, after each joint's mean error is taken off.

    What is left is how well the movement is met; the mean error is of the performer's style and of
    how the sensors sit.
    """
    off = estimate - truth
    return np.asarray(np.linalg.norm(off - off.mean(axis=0), axis=-1))


def limb_angles_deg(truth: Floats, estimate: Floats, names: Sequence[str]) -> Floats:
    """Returns the angles (T, L) between the directions of LIMBS, from positions (T, J, 3)."""
    at = {name: i for i, name in enumerate(names)}
    begins, ends = ([at[limb[k]] for limb in LIMBS.values()] for k in (0, 1))
    one, other = (positions[:, ends] - positions[:, begins] for positions in (truth, estimate))
    sine = np.linalg.norm(np.cross(one, other), axis=-1)
    return np.asarray(np.degrees(np.arctan2(sine, np.sum(one * other, axis=-1))))


def joint_angle_errors_deg(truth: Floats, estimate: Floats) -> Floats:
    """Returns the angles (T, J) between rotations (T, J, 4; unit quaternions)."""
    cosine = np.abs(np.sum(truth * estimate, axis=-1))
    return np.asarray(np.degrees(2.0 * np.arccos(np.minimum(cosine, 1.0))))


def euler_errors_deg(truth: Floats, estimate: Floats) -> Floats:
    """Returns for each frame the mean error over its angles (T, A), in rad, as Liu et al. 2011."""
    turns = np.remainder(estimate - truth + np.pi, 2.0 * np.pi) - np.pi
    return np.asarray(np.degrees(np.abs(turns).mean(axis=1)))


def nearest(times_s: Floats, values: Floats, wanted_s: Floats) -> Floats:
    """Returns the values (T, ...) whose times are nearest to those wanted."""
    after = np.clip(np.searchsorted(times_s, wanted_s), 1, max(len(times_s) - 1, 1))
    is_before = np.abs(times_s[after - 1] - wanted_s) <= np.abs(
        times_s[np.minimum(after, len(times_s) - 1)] - wanted_s
    )
    return values[np.where(is_before, after - 1, np.minimum(after, len(times_s) - 1))]


def mean_jerk(positions: Floats, rate_hz: float) -> float:
    """Returns the mean size of the joints' third derivative, in km/s^3; NaN under 4 frames."""
    if len(positions) < 4:
        return float("nan")
    third = np.diff(positions, 3, axis=0)
    return float(np.linalg.norm(third, axis=-1).mean()) * rate_hz**3 / 1000.0
