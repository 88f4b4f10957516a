# SPDX-License-Identifier: GPL-3.0-or-later
"""The measures of how a motion moves, against their closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from sparse_mocap.evaluation.movement import (
    World,
    drift_of_headings_deg,
    drift_of_paths_cm,
    floor_offset_m,
    headings_rad,
    largest_step_cm,
    share_of_fast_turns,
    share_under_floor,
    standing_speed_cmps,
    turns_deg,
)

Floats = NDArray[np.float64]

RATE_HZ = 25.0


def turning(degrees: Floats) -> Floats:
    """Two joints, (T, 2, 4) w x y z: one turns about y by these angles, the other rests."""
    xyzw = Rotation.from_rotvec(np.radians(degrees)[:, None] * [0.0, 1.0, 0.0]).as_quat()
    resting = np.tile([1.0, 0.0, 0.0, 0.0], (len(degrees), 1))
    return np.stack([xyzw[:, [3, 0, 1, 2]], resting], axis=1)


def test_a_turn_is_the_angle_from_frame_to_frame() -> None:
    turns = turns_deg(turning(np.array([0.0, 10.0, 40.0, 35.0])))
    assert turns[:, 0] == pytest.approx([10.0, 30.0, 5.0], abs=1e-5)
    assert turns[:, 1] == pytest.approx(0.0, abs=1e-5)


def test_fast_turns_are_counted_by_frames() -> None:
    assert share_of_fast_turns(turning(np.array([0.0, 59.0, 120.0, 0.0, 10.0]))) == 0.5
    assert share_of_fast_turns(turning(np.zeros(1))) == 0.0


def test_the_largest_step_is_that_of_the_fastest_joint() -> None:
    positions = np.zeros((4, 2, 3))
    positions[2, 1] = [0.3, 0.0, 0.4]
    assert largest_step_cm(positions) == pytest.approx(50.0)
    assert largest_step_cm(positions[:1]) == 0.0


def test_a_heading_is_continuous_and_kept_while_the_hips_stand_upright() -> None:
    yaw = np.radians(np.array([170.0, 180.0, 190.0, 200.0]))
    left = 0.1 * np.stack([np.cos(yaw), np.zeros(4), -np.sin(yaw)], axis=1)
    assert np.degrees(headings_rad(left, -left)) == pytest.approx([170, 180, 190, 200])
    left[2] = [0.0, 0.1, 0.0]
    assert np.degrees(headings_rad(left, -left)) == pytest.approx([170, 180, 180, 200])


def test_feet_are_measured_while_they_stand_in_truth() -> None:
    ankles = np.zeros((5, 2, 3))
    ankles[:, 0, 2] = np.arange(5) * 0.01  # 25 cm/s
    ankles[:, 1, 0] = np.arange(5) * 0.04
    stands = np.array([[True, False]] * 3 + [[False, False]] * 2)
    assert standing_speed_cmps(ankles, stands, RATE_HZ) == pytest.approx(25.0)
    stands[3:, 1] = True  # one further step, of 100 cm/s
    assert standing_speed_cmps(ankles, stands, RATE_HZ) == pytest.approx(50.0)
    assert np.isnan(standing_speed_cmps(ankles, np.zeros_like(stands), RATE_HZ))


def test_floors_differ_by_the_median_while_feet_stand() -> None:
    true = np.full((5, 2, 3), 0.1)
    ankles = true + np.array([0.0, -0.03, 0.0])
    ankles[4] = 0.5  # no foot stands
    ankles[0, 0, 1] = 0.02  # sunk
    stands = np.array([[True, True]] * 4 + [[False, False]])
    assert floor_offset_m(ankles, true, stands) == pytest.approx(-0.03)
    assert floor_offset_m(ankles, true, np.zeros_like(stands)) == 0.0
    assert share_under_floor(ankles, 0.1 - 0.03) == pytest.approx(1 / 10)


def test_an_ankle_is_under_the_floor_two_centimetres_below_the_lowest_true_one() -> None:
    ankles = np.full((10, 2, 3), 0.08)
    ankles[:3, 0, 1] = 0.055
    ankles[3:6, 0, 1] = 0.065
    assert share_under_floor(ankles, 0.08) == pytest.approx(3 / 20)


def world(path: Floats, yaw_rad: Floats) -> World:
    return World(np.zeros((len(path), 2, 3)), path, yaw_rad)


def test_drift_starts_at_the_same_place_with_the_same_heading() -> None:
    t = np.arange(101) / RATE_HZ
    forward = np.stack([np.zeros_like(t), 1.5 * t], axis=1)
    truth = world(forward, np.zeros_like(t))
    # The same walk somewhere else, and to the left.
    elsewhere = world(
        np.stack([1.5 * t + 3.0, np.zeros_like(t)], axis=1), np.full_like(t, np.pi / 2)
    )
    assert drift_of_paths_cm(truth, elsewhere, RATE_HZ, 2) == pytest.approx(0.0, abs=1e-9)
    assert drift_of_headings_deg(truth, elsewhere, RATE_HZ, 2) == pytest.approx(0.0)
    shorter = world(0.8 * forward, 0.1 * t)
    assert drift_of_headings_deg(truth, shorter, RATE_HZ, 2) == pytest.approx(np.degrees(0.2))
    shorter = world(0.8 * forward, np.zeros_like(t))
    assert drift_of_paths_cm(truth, shorter, RATE_HZ, 2) == pytest.approx(60.0)
    assert np.isnan(drift_of_paths_cm(truth, shorter, RATE_HZ, 5))


def test_a_path_to_the_side_is_seen_from_where_it_starts() -> None:
    t = np.arange(26) / RATE_HZ
    ahead = world(np.stack([np.zeros_like(t), t], axis=1), np.zeros_like(t))
    left = world(np.stack([t, np.zeros_like(t)], axis=1), np.zeros_like(t))
    assert drift_of_paths_cm(ahead, left, RATE_HZ, 1) == pytest.approx(100.0 * np.sqrt(2.0))
