# SPDX-License-Identifier: GPL-3.0-or-later
"""How a motion moves: turns, steps, feet on the floor, and the way of the root.

Positions are in metres, y up, (T, 21, 3) for the joints of the standard skeleton; rotations are
unit quaternions relative to the parent, (T, 21, 4).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .metrics import CM, joint_angle_errors_deg

__all__ = [
    "DRIFT_AFTER_S",
    "Movement",
    "World",
    "drift_of_headings_deg",
    "drift_of_paths_cm",
    "drifts",
    "floor_offset_m",
    "headings_rad",
    "largest_step_cm",
    "share_of_fast_turns",
    "share_under_floor",
    "standing_speed_cmps",
    "turns_deg",
]

Floats = NDArray[np.float64]

FAST_TURN_DEG = 60.0
UNDER_FLOOR_M = 0.02
DRIFT_AFTER_S = (2, 5, 10)
_UPRIGHT_AXIS = 0.2  # horizontal share of the hips' axis below which it gives no heading


@dataclass(frozen=True)
class World:
    """A motion in the world: what the measures of feet and root look at."""

    ankles: Floats
    """(T, 2, 3) m, left and right, above the floor."""
    root: Floats
    """(T, 2) m, on the floor: x and z."""
    heading_rad: Floats
    """(T,) continuous."""


@dataclass(frozen=True)
class Movement:
    """The figures of one motion, or of the truth."""

    turn_deg: Floats
    """(J,) see turns_deg()."""
    fast_turns: float
    """See share_of_fast_turns()."""
    largest_step_cm: float
    standing_cmps: float
    floor_offset_cm: float
    """See floor_offset_m()."""
    under_floor: float
    root_drift_cm: dict[int, float]
    """After DRIFT_AFTER_S; NaN where the motion is shorter."""
    heading_drift_deg: dict[int, float]


def turns_deg(rotations: Floats) -> Floats:
    """Returns how far each joint turns from each frame to the next, (T - 1, J)."""
    return joint_angle_errors_deg(rotations[1:], rotations[:-1])


def share_of_fast_turns(rotations: Floats) -> float:
    """Returns the share of frames into which a joint turns by more than 60 degrees."""
    turns = turns_deg(rotations)
    return float((turns > FAST_TURN_DEG).any(axis=1).mean()) if len(turns) else 0.0


def largest_step_cm(positions: Floats) -> float:
    """Returns how far a joint moves within one frame at most, in the frame of the positions."""
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=-1)
    return CM * float(steps.max()) if steps.size else 0.0


def headings_rad(left: Floats, right: Floats) -> Floats:
    """Returns the headings, continuous, (T,), from the ends of both hip joints, (T, 3).

    The heading is the hips' axis projected on the floor; where that stands upright, the heading
    before is kept.
    """
    axis = left - right
    is_known = np.hypot(axis[:, 0], axis[:, 2]) >= _UPRIGHT_AXIS * np.linalg.norm(axis, axis=1)
    yaw = np.where(is_known, np.arctan2(-axis[:, 2], axis[:, 0]), np.nan)
    last = 0.0
    for t in range(len(yaw)):
        last = yaw[t] = last if np.isnan(yaw[t]) else yaw[t]
    return np.asarray(np.unwrap(yaw))


def standing_speed_cmps(ankles: Floats, stands: NDArray[np.bool_], rate_hz: float) -> float:
    """Returns the mean speed of the feet while they stand in truth, by ankles (T, 2, 3).

    A foot counts between two frames when it stands in both, by ``stands`` (T, 2). NaN where none
    ever does.
    """
    speeds = np.linalg.norm(np.diff(ankles, axis=0), axis=-1) * rate_hz
    both = stands[1:] & stands[:-1]
    return CM * float(speeds[both].mean()) if both.any() else float("nan")


def floor_offset_m(ankles: Floats, true_ankles: Floats, stands: NDArray[np.bool_]) -> float:
    """Returns how much higher ankles (T, 2, 3) are than true ones while the feet stand, (T, 2).

    The median; 0 where none ever stands. Recordings differ by several centimetres in where their
    floor is, and performers in how high their ankles are above it, which no sensor tells.
    """
    higher = (ankles[..., 1] - true_ankles[..., 1])[stands]
    return float(np.median(higher)) if higher.size else 0.0


def share_under_floor(ankles: Floats, lowest_m: float) -> float:
    """Returns the share of ankles (T, 2, 3) more than 2 cm lower than true ankles ever are.

    Both stand on the same floor: lowest_m is that of true ankles plus floor_offset_m().
    """
    return float((ankles[..., 1] < lowest_m - UNDER_FLOOR_M).mean())


def drift_of_paths_cm(truth: World, estimate: World, rate_hz: float, after_s: float) -> float:
    """Returns how far the root is off after a time, where both began alike: place and heading.

    The mean over all beginnings in the motion; NaN where it is shorter.
    """
    frames = round(after_s * rate_hz)
    if len(truth.root) <= frames:
        return float("nan")
    moved = [_displacements(world, frames) for world in (truth, estimate)]
    return CM * float(np.linalg.norm(moved[1] - moved[0], axis=1).mean())


def drift_of_headings_deg(truth: World, estimate: World, rate_hz: float, after_s: float) -> float:
    """Returns how far the heading is off after a time, where both began alike.

    The mean over all beginnings in the motion; NaN where it is shorter.
    """
    frames = round(after_s * rate_hz)
    if len(truth.root) <= frames:
        return float("nan")
    turned = [w.heading_rad[frames:] - w.heading_rad[:-frames] for w in (truth, estimate)]
    return float(np.degrees(np.abs(turned[1] - turned[0])).mean())


def drifts(
    truth: World, estimate: World, rate_hz: float, after_s: Sequence[int] = DRIFT_AFTER_S
) -> tuple[dict[int, float], dict[int, float]]:
    """Returns the drifts of root (cm) and heading (degrees) after each of the times."""
    return (
        {s: drift_of_paths_cm(truth, estimate, rate_hz, s) for s in after_s},
        {s: drift_of_headings_deg(truth, estimate, rate_hz, s) for s in after_s},
    )


def _displacements(world: World, frames: int) -> Floats:
    """Returns how far the root comes in so many frames, seen from where it starts, (N, 2)."""
    moved = world.root[frames:] - world.root[:-frames]
    yaw = world.heading_rad[:-frames]
    left = np.cos(yaw) * moved[:, 0] - np.sin(yaw) * moved[:, 1]
    forward = np.sin(yaw) * moved[:, 0] + np.cos(yaw) * moved[:, 1]
    return np.stack([left, forward], axis=1)
