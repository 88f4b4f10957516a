# SPDX-License-Identifier: GPL-3.0-or-later
"""What a reconstruction says of itself over time."""

import numpy as np
import pytest
import sparse_mocap
from sparse_mocap.demo_motions import generate_performance

from blender_addon.session.certainty import (
    Certainty,
    SensorCurves,
    certainty_of,
    sensor_curves,
    spread_of,
)

SITES = ["left_wrist", "right_ankle"]


class _Solved:
    """As sparse_mocap.Reconstruction, with readings of one's own."""

    def __init__(self, motion, readings) -> None:
        self.motion, self.readings, self.diagnostics = motion, readings, {}
        self.rate_hz = 1.0 / motion.frame_time_s


@pytest.fixture(scope="module")
def standing(tmp_path_factory):
    """Someone who stands still for two seconds."""
    path = generate_performance(tmp_path_factory.mktemp("one") / "one.bvh")
    motion, _ = sparse_mocap.standard_motion(sparse_mocap.read_motion(path)[0])
    rotations = np.repeat(np.asarray(motion.rotations)[:1], 50, axis=0)
    places = np.repeat(np.asarray(motion.root_positions)[:1], 50, axis=0)
    return sparse_mocap.Motion(motion.skeleton, 0.04, places, rotations)


def test_certainty_has_three_steps():
    assert certainty_of(0.02) is Certainty.SURE
    assert certainty_of(0.08) is Certainty.UNSURE
    assert certainty_of(0.3) is Certainty.GUESSED
    assert certainty_of(float("nan")) is Certainty.SURE


def test_a_sensor_that_stands_still_should_read_gravity(standing):
    num_frames = standing.num_frames
    measured = np.zeros((num_frames, 2, 3))
    measured[..., 0] = 3.0
    times_s = np.arange(num_frames) * standing.frame_time_s
    readings = sparse_mocap.Readings(SITES, times_s, specific_force=measured)
    solved = _Solved(standing, readings)
    curves = sensor_curves(solved)
    assert curves.sites == SITES
    assert np.allclose(curves.measured, 3.0)
    assert np.abs(curves.expected - 9.81).max() < 0.05
    assert spread_of(solved).shape == (num_frames, 0)


def test_the_part_around_a_time():
    times_s = np.arange(100) / 10.0
    curves = SensorCurves(SITES, times_s, np.tile(times_s[:, None], 2), np.zeros((100, 2)))
    part = curves.around(5.0, 1.0)
    assert np.allclose(part.times_s, np.arange(-10, 11) / 10.0)
    assert np.allclose(part.measured[:, 0], part.times_s + 5.0)
    assert part.largest == 6.0
    assert len(curves.around(50.0, 1.0).times_s) == 0
    assert curves.around(50.0, 1.0).largest == 0.0
