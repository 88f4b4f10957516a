# SPDX-License-Identifier: GPL-3.0-or-later
"""Readings of takes: accelerometers, and which way is up where there are gyroscopes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from sparse_mocap import (
    GRAVITY_MPS2,
    InclinationFilter,
    MotionDatabase,
    Reconstructor,
    Take,
    inclinations,
    read_take,
    readings_of,
    resampled,
)


@pytest.fixture
def take(take_path: Path) -> Take:
    return read_take(take_path)


def without_gyroscopes(take: Take) -> Take:
    records = {site: replace(r, angular_velocity=None) for site, r in take.sensors.items()}
    return Take(records)


def true_up(take: Take, site: str) -> np.ndarray:
    return (
        Rotation.from_quat(np.roll(take.sensors[site].orientation, -1, axis=1))
        .inv()
        .apply([0.0, 1.0, 0.0])
    )


@pytest.mark.parametrize(("offline", "largest_deg"), [(False, 12.0), (True, 5.0)])
def test_directions_are_those_that_the_take_was_simulated_with(
    take: Take, offline: bool, largest_deg: float
) -> None:
    for site, record in take.sensors.items():
        found = inclinations(
            record.times_s, record.specific_force, record.angular_velocity, offline=offline
        )
        known = np.isfinite(found).all(axis=1)
        assert known[record.times_s >= record.times_s[0] + 0.51].all()
        off = np.degrees(np.arccos(np.clip((found * true_up(take, site)).sum(axis=1), -1, 1)))
        assert np.nanmean(off) < largest_deg, site
        level = record.specific_force / np.linalg.norm(record.specific_force, axis=1)[:, None]
        naive = np.degrees(np.arccos(np.clip((level * true_up(take, site)).sum(axis=1), -1, 1)))
        assert np.nanmean(off) < naive.mean(), site


def test_the_filter_answers_as_the_recording_does(take: Take) -> None:
    record = take.sensors["left_wrist"]
    assert record.angular_velocity is not None
    one_by_one = InclinationFilter()
    answers = [
        one_by_one.update(t, f, w)
        for t, f, w in zip(
            record.times_s, record.specific_force, record.angular_velocity, strict=True
        )
    ]
    whole = inclinations(record.times_s, record.specific_force, record.angular_velocity)
    assert np.array_equal(answers, whole, equal_nan=True)


def test_without_gyroscopes_all_is_as_it_was(take: Take, database: MotionDatabase) -> None:
    times, forces = resampled(take, database.rate_hz)
    zeros = {
        site: replace(r, angular_velocity=np.zeros_like(r.specific_force))
        for site, r in take.sensors.items()
    }
    for given in (without_gyroscopes(take), Take(zeros)):
        readings = readings_of(given, database.rate_hz)
        assert readings.channels.has_up == [False] * len(take.sensors)
        assert np.array_equal(readings.values, forces)
        assert np.array_equal(readings.times_s, times)
    plain = Reconstructor(database, take.sites).solve(forces)
    solved = readings.channels.reconstructor(database).solve(readings.values)
    assert np.array_equal(solved.angles, plain.angles)


def test_forces_come_first_and_directions_are_unit_vectors(
    take: Take, database: MotionDatabase
) -> None:
    half = Take({**take.sensors, "left_wrist": without_gyroscopes(take).sensors["left_wrist"]})
    readings = readings_of(half, database.rate_hz, offline=True)
    assert readings.values.shape[1] == 2 * len(take.sensors) - 1
    assert np.array_equal(readings.specific_force, resampled(half, database.rate_hz)[1])
    up = readings.values[:, len(take.sensors) :]
    assert np.linalg.norm(up, axis=2) == pytest.approx(1.0, abs=0.1)
    at_rest = np.abs(np.linalg.norm(readings.specific_force, axis=2) - GRAVITY_MPS2) < 0.05
    for index, channel in enumerate(range(1, len(take.sensors))):
        quiet = at_rest[:, channel]
        assert quiet.any()
        level = readings.specific_force[quiet, channel] / GRAVITY_MPS2
        assert np.median(np.linalg.norm(level - up[quiet, index], axis=1)) < 0.35


def test_directions_bring_the_limbs_nearer(take: Take, database: MotionDatabase) -> None:
    """How far the forearms and shanks rise, in the poses and as the sensors say."""
    names = database.skeleton.names
    joints = [names.index(name) for name in ("lradius", "rradius", "ltibia", "rtibia")]
    parents = [database.skeleton.parents[joint] for joint in joints]
    off = {}
    for uses in (False, True):
        readings = readings_of(take, database.rate_hz, offline=True, uses_gyroscopes=uses)
        solved = readings.channels.reconstructor(database).solve(readings.values, offline=True)
        assert solved.sensor_misfit_mps2.shape[1] == len(take.sensors)
        positions = solved.motion.joint_positions("heading")
        bones = positions[:, joints] - positions[:, parents]
        rises = bones[:, :, 1] / np.linalg.norm(bones, axis=2)
        index = np.round((readings.times_s - take.begin_s) * 100).astype(int)
        wanted = np.stack([true_up(take, site)[index, 0] for site in take.sites], axis=1)
        off[uses] = float(np.abs(rises - wanted).mean())
    assert off[True] < off[False]


def test_quantities_are_checked(database: MotionDatabase) -> None:
    for wrong, words in ((["up"], "one entry a site"), (["up", "down"], "not 'down'")):
        with pytest.raises(ValueError, match=words):
            Reconstructor(database, ["left_wrist", "head"], quantities=wrong)
