# SPDX-License-Identifier: GPL-3.0-or-later
"""What a result says of itself: seconds, advice, and a sensor that does not fit."""

from __future__ import annotations

import numpy as np
import pytest
import sparse_mocap
from sparse_mocap.demo_motions import generate_library

from blender_addon.session.match import advice_for, match_of, odd_sensor, poor_parts

SITES = ["left_wrist", "right_wrist", "left_ankle", "right_ankle"]


def test_poor_seconds_are_put_together():
    assert poor_parts(["good", "poor", "poor", "fair", "poor"]) == [(1, 3), (4, 5)]
    assert poor_parts(["poor"] * 3) == [(0, 3)]
    assert poor_parts([]) == poor_parts(["good", "fair"]) == []


def test_advice_is_given_for_what_is_not_good():
    assert advice_for("good") == advice_for("") == ""
    assert "calibrate" in advice_for("poor")
    assert advice_for("poor") != advice_for("fair")


def test_a_sensor_is_odd_only_among_others_and_far_off():
    misfits = np.tile([2.0, 1.5, 9.0, 1.8], (10, 1))
    misfits[3] = np.nan
    assert odd_sensor(SITES, misfits) == "left_ankle"
    assert odd_sensor(SITES, misfits / 4.0) == ""  # near enough
    assert odd_sensor(SITES, np.full((10, 4), 9.0)) == ""  # all are
    assert odd_sensor(SITES[:2], misfits[:, 1:3]) == ""  # which of two?
    assert odd_sensor(SITES, np.full((10, 4), np.nan)) == ""


@pytest.fixture(scope="module")
def known(tmp_path_factory: pytest.TempPathFactory):
    """A database of generated motions, and a take of one of them."""
    folder = tmp_path_factory.mktemp("known")
    files = generate_library(folder / "motions")
    sparse_mocap.build_database(files[::10], folder / "known.smdb")
    motion, _ = sparse_mocap.standard_motion(sparse_mocap.read_motion(files[0])[0])
    database = sparse_mocap.MotionDatabase(folder / "known.smdb")
    return database, sparse_mocap.simulated(motion, SITES, 100.0)


def test_a_take_of_the_database_is_good_in_all_its_seconds(known):
    database, take = known
    match = match_of(sparse_mocap.reconstruct(take, database, best_quality=True), database)
    assert (match.label, match.advice, match.odd_sensor) == ("good", "", "")
    assert set(match.seconds) <= {"good", "fair"}
    assert len(match.seconds) == pytest.approx(take.end_s - take.begin_s, abs=1.0)


def test_a_sensor_whose_axes_are_exchanged_is_named(known):
    database, take = known
    sensors = dict(take.sensors)
    worn = sensors["right_wrist"]
    turned = worn.specific_force[:, [1, 2, 0]]
    sensors["right_wrist"] = sparse_mocap.SensorRecord(worn.times_s, turned)
    solved = sparse_mocap.reconstruct(sparse_mocap.Take(sensors), database, best_quality=True)
    assert match_of(solved, database).odd_sensor == "right_wrist"
