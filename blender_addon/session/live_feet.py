# SPDX-License-Identifier: GPL-3.0-or-later
"""Feet that stay where they stand in a live preview, pose by pose. No Blender here.

All vectors are in the core's axes and metres, in the character's own space.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from .character import Character, Floats, FootLock, RigMotion

_LETS_GO_S = 0.12  # time constant with which a foot returns to where the pose has it
_FARTHEST_M = 0.25  # a foot that is pulled farther is let go: the pose has jumped
_STRAIGHTEST = 0.999  # of the leg's length, that it may reach
_LONGEST_PAUSE_S = 0.5


@dataclass
class _Foot:
    """What is known of a foot from the poses before."""

    place: Floats | None = None  # (3,) where the last pose had the ankle
    anchor: Floats | None = None  # (3,) where it is kept while it stands
    offset: Floats = field(default_factory=lambda: np.zeros(3))  # from the pose to what is shown


class LiveFootLock:
    """Keeps feet where they stand in poses that come one after the other."""

    def __init__(self, character: Character) -> None:
        self._character = character
        self._feet = (_Foot(), _Foot())
        self._time_s = float("nan")

    def shown(
        self,
        moved: RigMotion,
        legs: Floats,
        contacts: Sequence[float],
        time_s: float,
        lock: FootLock,
        floor_m: float,
    ) -> RigMotion:
        """The pose (a motion of one frame) with feet that stay where they stand.

        legs (2, 3, 3): where hip, knee and ankle of the left and the right leg are. contacts: how
        certain it is that each foot stands. floor_m: how high ankles of standing feet are.
        """
        elapsed_s, self._time_s = time_s - self._time_s, time_s
        if not 0.0 < elapsed_s < _LONGEST_PAUSE_S or len(contacts) < 2:
            self._feet = (_Foot(legs[0, 2]), _Foot(legs[1, 2]))
            return moved
        rotations = moved.rotations[0].copy()
        for side, foot in enumerate(self._feet):
            stands = self._stands(foot, legs[side, 2], contacts[side], elapsed_s, lock, floor_m)
            _follow(foot, legs[side, 2], elapsed_s, stands=stands)
            offset = lock.strength * foot.offset
            if np.linalg.norm(offset) > 1e-6:
                hip, knee, ankle = legs[side]
                turns = leg_turns(hip, knee, ankle, ankle + offset)
                for bones, turn in zip(self._character.leg_bones[side], turns, strict=True):
                    rotations[bones] = turn @ rotations[bones]
        return replace(moved, rotations=rotations[None])

    @staticmethod
    def _stands(
        foot: _Foot,
        ankle: Floats,
        contact: float,
        elapsed_s: float,
        lock: FootLock,
        floor_m: float,
    ) -> bool:
        if foot.place is None:
            return False
        speed_mps = float(np.linalg.norm(ankle - foot.place)) / elapsed_s
        return (
            contact >= lock.least_certainty
            and speed_mps <= lock.fastest_mps
            and float(ankle[1]) - floor_m <= lock.highest_m
        )


def _follow(foot: _Foot, ankle: Floats, elapsed_s: float, *, stands: bool) -> None:
    """Keep a foot that stands at its place; let another return to the pose without a jump."""
    foot.place = ankle
    if stands and foot.anchor is None:
        foot.anchor = ankle + foot.offset
    if stands and foot.anchor is not None:
        foot.offset = foot.anchor - ankle
        if np.linalg.norm(foot.offset) <= _FARTHEST_M:
            return
    foot.anchor = None
    foot.offset = foot.offset * np.exp(-elapsed_s / _LETS_GO_S)


def leg_turns(hip: Floats, knee: Floats, ankle: Floats, wanted: Floats) -> tuple[Floats, Floats]:
    """(3, 3) twice: how thigh and shank turn in the world, so that the ankle is where it is wanted.

    The knee bends in the leg's own plane; that of a straight leg is to the front.
    """
    upper, lower = knee - hip, ankle - knee
    lengths = float(np.linalg.norm(upper)), float(np.linalg.norm(lower))
    shortest, longest = abs(lengths[0] - lengths[1]) + 1e-6, _STRAIGHTEST * sum(lengths)
    reach = float(np.clip(np.linalg.norm(wanted - hip), shortest, longest))
    cosine = (lengths[0] ** 2 + lengths[1] ** 2 - reach**2) / (2.0 * lengths[0] * lengths[1])
    across = _cross(-upper, lower)
    size = float(np.linalg.norm(across))
    before = np.arctan2(size, float(np.dot(-upper, lower)))
    axis = across / size if size > 1e-6 else np.array([-1.0, 0.0, 0.0])
    bend = _about(axis, float(np.arccos(np.clip(cosine, -1.0, 1.0))) - before)
    aim = _aim(upper + bend @ lower, wanted - hip)
    return aim, aim @ bend


def _cross(a: Floats, b: Floats) -> Floats:
    """(3,) as np.cross, which takes ten times as long for a single pair."""
    (ax, ay, az), (bx, by, bz) = a, b
    return np.array([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])


def _about(axis: Floats, angle: float) -> Floats:
    """(3, 3) the rotation about a unit axis (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross)


def _aim(vector: Floats, wanted: Floats) -> Floats:
    """(3, 3) the shortest rotation from one direction to another."""
    a, b = vector / np.linalg.norm(vector), wanted / np.linalg.norm(wanted)
    axis = _cross(a, b)
    sine = float(np.linalg.norm(axis))
    if sine < 1e-9:
        return np.eye(3)
    return _about(axis / sine, float(np.arctan2(sine, float(a @ b))))
