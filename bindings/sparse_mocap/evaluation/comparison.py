# SPDX-License-Identifier: GPL-3.0-or-later
"""A test's truth, and how estimates are compared with it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .. import Clip, Motion, MotionDatabase
from ..table_errors import TableError
from .clip_result import ClipResult, clip_result
from .metrics import (
    CM,
    centred_errors,
    euler_errors_deg,
    interpolated,
    joint_angle_errors_deg,
    joint_errors,
    limb_angles_deg,
    mean_jerk,
    nearest,
)
from .movement import (
    Movement,
    World,
    drifts,
    floor_offset_m,
    headings_rad,
    largest_step_cm,
    share_of_fast_turns,
    share_under_floor,
    standing_speed_cmps,
    turns_deg,
)
from .performance import heading_rotations

__all__ = ["Estimate", "Truth", "world_of"]

Floats = NDArray[np.float64]

_HEIGHT = 3  # column of the database's root motion


@dataclass(frozen=True)
class Estimate:
    """Where a method or baseline puts the joints."""

    label: str
    times_s: Floats
    positions: Floats
    """(T, J, 3) m, heading frame."""
    root_positions: Floats
    """(T, J, 3) m, root frame."""
    rotations: Floats | None = None
    """(T, J, 4), root without heading; None for baselines that only know positions."""
    world: World | None = None
    """None like rotations."""
    angles_rad: Floats | None = None
    """(T, A) instead of rotations, for baselines that show frames of the database."""
    match: str | None = None
    """How well the reconstruction says that it matches."""
    work: Mapping[str, float] = field(default_factory=dict)
    """What the method says of its own work, means over the frames."""


def world_of(motion: Motion, floor_m: float = 0.0) -> World:
    """Returns what the measures of feet and root look at; floor_m is the floor's height."""
    names = list(motion.skeleton.names)
    ends = np.array(motion.joint_positions("world"))
    ankles = ends[:, [names.index("ltibia"), names.index("rtibia")]]
    ankles[..., 1] -= floor_m
    headings = headings_rad(ends[:, names.index("lhipjoint")], ends[:, names.index("rhipjoint")])
    return World(ankles, ends[:, names.index("root")][:, [0, 2]], headings)


class Truth:
    """What was performed: a clip as the database has it, and its motion."""

    def __init__(
        self, database: MotionDatabase, clip: Clip, motion: Motion, clip_times_s: Floats
    ) -> None:
        """Takes the clip's motion as performed, on the database's skeleton, at its rate.

        clip_times_s (T,): when in the clip each of the motion's frames is; they differ where it is
        performed at another tempo.
        """
        self.rate_hz = database.rate_hz
        self.skeleton = database.skeleton
        rows = np.rint(clip_times_s * self.rate_hz).astype(int)
        rows = clip.begin + rows[rows < clip.end - clip.begin]
        count = len(rows)
        self.positions = np.asarray(motion.joint_positions("heading"))[:count]
        self.root_positions = np.asarray(motion.joint_positions("root"))[:count]
        self.times_s = np.arange(count) / self.rate_hz
        self.rotations = heading_rotations(motion)[:count]
        root_height = float(database.array("root_motion")[rows[0], _HEIGHT])
        whole = world_of(motion, float(motion.joint_positions("world")[0, 0, 1] - root_height))
        self.world = World(whole.ankles[:count], whole.root[:count], whole.heading_rad[:count])
        self.stands = np.asarray(database.array("contacts")[rows]) > 0.5
        self.lowest_ankle_m = float(self.world.ankles[..., 1].min())
        self.jerk_kmps3 = mean_jerk(self.positions, self.rate_hz)
        self._problem = TableError(database.path, 0, "the performance is too short to compare")

    def movement(self) -> Movement:
        """Returns how the truth itself moves."""
        return self._movement(
            self.positions, self.rotations, self.world, np.full(len(self.positions), True)
        )

    def compared(self, estimate: Estimate) -> ClipResult:
        """Compares where both are known; the estimate is taken at the truth's times."""
        times, label = estimate.times_s, estimate.match
        is_known = (self.times_s >= times[0] - 1e-6) & (self.times_s <= times[-1] + 1e-6)
        if not is_known.any():
            raise self._problem
        wanted = self.times_s[is_known]
        placed = self._placed(is_known, estimate, wanted)
        jerk = mean_jerk(estimate.positions, self.rate_hz)
        if estimate.rotations is None or estimate.world is None:
            eulers = self._euler_errors_deg(is_known, estimate)
            return clip_result(*placed, jerk, euler_errors_deg=eulers)
        rotations = nearest(times, estimate.rotations, wanted)
        angles = joint_angle_errors_deg(self.rotations[is_known], rotations)
        true_angles = self.skeleton.angles(self.rotations[is_known])
        eulers = euler_errors_deg(true_angles, self.skeleton.angles(rotations, true_angles))
        world = World(
            interpolated(times, estimate.world.ankles, wanted),
            interpolated(times, estimate.world.root, wanted),
            interpolated(times, estimate.world.heading_rad, wanted),
        )
        moved = self._movement(estimate.positions, estimate.rotations, world, is_known)
        return clip_result(
            *placed,
            jerk,
            angle_errors_deg=angles,
            movement=moved,
            match=label,
            euler_errors_deg=eulers,
            work=estimate.work,
        )

    def _placed(
        self, is_known: NDArray[np.bool_], estimate: Estimate, wanted_s: Floats
    ) -> tuple[Floats, Floats, Floats, Floats]:
        """Returns how far off joints and limbs are, as clip_result() takes it."""
        times, true = estimate.times_s, self.positions[is_known]
        found = interpolated(times, estimate.positions, wanted_s)
        in_root = interpolated(times, estimate.root_positions, wanted_s)
        return (
            joint_errors(true, found),
            centred_errors(true, found),
            joint_errors(self.root_positions[is_known], in_root),
            limb_angles_deg(true, found, self.skeleton.names),
        )

    def _euler_errors_deg(self, is_known: NDArray[np.bool_], estimate: Estimate) -> Floats | None:
        if estimate.angles_rad is None:
            return None
        found = nearest(estimate.times_s, estimate.angles_rad, self.times_s[is_known])
        return euler_errors_deg(self.skeleton.angles(self.rotations[is_known], found), found)

    def _movement(
        self, positions: Floats, rotations: Floats, world: World, is_known: NDArray[np.bool_]
    ) -> Movement:
        """Returns the figures; the world is given where is_known."""
        true = World(
            self.world.ankles[is_known],
            self.world.root[is_known],
            self.world.heading_rad[is_known],
        )
        root_drift, heading_drift = drifts(true, world, self.rate_hz)
        stands = self.stands[is_known]
        offset_m = floor_offset_m(world.ankles, true.ankles, stands)
        return Movement(
            turns_deg(rotations).mean(axis=0),
            share_of_fast_turns(rotations),
            largest_step_cm(positions),
            standing_speed_cmps(world.ankles, stands, self.rate_hz),
            CM * offset_m,
            share_under_floor(world.ankles, self.lowest_ankle_m + offset_m),
            root_drift,
            heading_drift,
        )
