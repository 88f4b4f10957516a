# SPDX-License-Identifier: GPL-3.0-or-later
"""Readings of takes: accelerometers, and which way is up where there are gyroscopes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp
from sparse_mocap import (
    CHANNEL_NAMES,
    GRAVITY_MPS2,
    MotionDatabase,
    Readings,
    SensorRecord,
    Take,
    gravity_directions,
    read_take,
    reconstruct,
)
from sparse_mocap.calibration import sensor_inputs
from sparse_mocap.readings import all_readings, channels_in


def readings_of(take: Take, rate_hz: float, average: str = "causal") -> Readings:
    """All channels of a take."""
    channels = [channels_in(record) for record in take.sensors.values()]
    inputs = sensor_inputs(None, take.sites, channels)
    return all_readings(take, inputs, rate_hz, gravity_average=average)


class Oracle:
    """What readings are by definition, in NumPy."""

    LONGEST_GAP_S = 0.1
    SIGMA_S = 0.0115

    def __init__(self, times_s: np.ndarray, values: np.ndarray) -> None:
        known = np.isfinite(values).all(axis=1)
        self.times_s, self.values = times_s[known], values[known]

    def at(self, wanted_s: np.ndarray) -> np.ndarray:
        if not len(self.times_s):
            return np.full((len(wanted_s), 3), np.nan)
        z = (self.times_s - wanted_s[:, None]) / self.SIGMA_S
        weights = np.where(np.abs(z) <= 3.0, np.exp(-0.5 * z**2), 0.0)
        beside = [np.interp(wanted_s, self.times_s, column) for column in self.values.T]
        is_alone = (weights > 0).sum(axis=1) < 2
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = weights @ self.values / weights.sum(axis=1)[:, None]
        read = np.where(is_alone[:, None], np.stack(beside, axis=1), mean)
        return np.where(self.is_silent(wanted_s)[:, None], np.nan, read)

    def is_silent(self, wanted_s: np.ndarray) -> np.ndarray:
        ends = np.concatenate([[-np.inf], self.times_s, [np.inf]])
        after = np.searchsorted(self.times_s, wanted_s) + 1
        before_s, after_s = wanted_s - ends[after - 1], ends[after] - wanted_s
        gap_s = np.where(
            np.isinf(before_s) | np.isinf(after_s),
            np.minimum(before_s, after_s),
            before_s + after_s,
        )
        is_between = (before_s > 1e-6) & (after_s > 1e-6)
        return is_between & (gap_s > self.LONGEST_GAP_S + 1e-6)


def directions_both_ways(record: SensorRecord) -> np.ndarray:
    """Gravity averaged over the samples around each, in the frame that the gyroscope carries."""
    times_s, forces, rates = record.times_s, record.specific_force, record.angular_velocity
    assert rates is not None
    found = np.full((len(times_s), 3), np.nan)
    known = np.flatnonzero(np.isfinite(np.hstack([forces, rates])).all(axis=1))
    for part in np.split(known, np.flatnonzero(np.diff(times_s[known]) > 0.25) + 1):
        steps = np.diff(times_s[part])[:, None] * (rates[part][1:] + rates[part][:-1]) / 2
        turns = [Rotation.identity()]
        for step in steps:
            turns.append(turns[-1] * Rotation.from_rotvec(step))
        held = Rotation.concatenate(turns)
        weights = np.exp(-np.abs(times_s[part][:, None] - times_s[part]) / 3.0)
        up = held.inv().apply(weights @ held.apply(forces[part]))
        found[part] = up / np.linalg.norm(up, axis=1, keepdims=True)
    return found


def broken_record(seed: int, begin_s: float, length_s: float) -> SensorRecord:
    """Irregular samples with a gap, some of which are not finite, so the first and the last."""
    source = np.random.default_rng(seed)
    times_s = begin_s + np.cumsum(source.uniform(0.004, 0.016, int(length_s * 100)))
    times_s = np.delete(times_s, slice(150, 190))
    forces = np.array([0.0, 9.81, 0.0]) + source.normal(size=(len(times_s), 3))
    rates = source.normal(size=(len(times_s), 3))
    for values in (forces, rates):
        values[source.random(len(times_s)) < 0.03, 1] = np.nan
    forces[:12] = forces[-30:] = np.nan
    return SensorRecord(times_s, forces, rates)


def test_readings_are_those_of_the_definition() -> None:
    take = Take({"head": broken_record(1, 5.0, 6.0), "chest": broken_record(2, 6.5, 3.0)})
    for rate_hz in (25.0, 40.0):
        readings = readings_of(take, rate_hz, "whole_take")
        num_times = int((take.end_s - take.begin_s) * rate_hz + 1e-6) + 1
        assert np.array_equal(readings.times_s, take.begin_s + np.arange(num_times) / rate_hz)
        for index, record in enumerate(take.sensors.values()):
            for found, values in (
                (readings.specific_force, record.specific_force),
                (readings.gravity_direction, directions_both_ways(record)),
            ):
                wanted = Oracle(record.times_s, values).at(readings.times_s)
                assert np.isnan(wanted).any()
                np.testing.assert_allclose(found[:, index], wanted, atol=1e-9)


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
        found = gravity_directions(
            record.times_s,
            record.specific_force,
            record.angular_velocity,
            average="whole_take" if offline else "causal",
        )
        known = np.isfinite(found).all(axis=1)
        assert known[record.times_s >= record.times_s[0] + 0.51].all()
        off = np.degrees(np.arccos(np.clip((found * true_up(take, site)).sum(axis=1), -1, 1)))
        assert np.nanmean(off) < largest_deg, site
        level = record.specific_force / np.linalg.norm(record.specific_force, axis=1)[:, None]
        naive = np.degrees(np.arccos(np.clip((level * true_up(take, site)).sum(axis=1), -1, 1)))
        assert np.nanmean(off) < naive.mean(), site


def test_every_channel_of_a_take_is_read(take: Take) -> None:
    site, record = next(iter(take.sensors.items()))
    way = np.stack([record.times_s, 2 * record.times_s, np.ones(len(record.times_s))], axis=1)
    tracked = Take({site: replace(record, position=way), "head": record})
    channels = [channels_in(each) for each in tracked.sensors.values()]
    assert channels[0] == list(CHANNEL_NAMES)
    assert channels[1] == [name for name in CHANNEL_NAMES if name != "position"]
    sensors = sensor_inputs(None, tracked.sites, channels)
    read = all_readings(tracked, sensors, 20.0, tracker_yaw_rad=np.pi, tracker_origin_m=[0, 0, 3])
    assert (read.sites, read.positions_along_bone) == ([site, "head"], [1.0, 1.0])
    assert read.channels == channels
    inner = slice(2, -2)
    times_s = read.times_s[inner]
    turned = np.stack([-times_s, 2 * times_s, np.full(len(times_s), 2.0)], axis=1)
    np.testing.assert_allclose(read.position[inner, 0], turned, atol=1e-6)
    assert np.isnan(read.position[:, 1]).all()
    samples = Rotation.from_quat(np.roll(record.orientation, -1, axis=1))
    wanted = Rotation.from_euler("y", np.pi) * Slerp(record.times_s, samples)(times_s)
    found = Rotation.from_quat(np.roll(read.orientation[inner, 0], -1, axis=1))
    assert (wanted.inv() * found).magnitude().max() < 1e-6
    part = read[3:6]
    assert len(part) == 3
    assert np.array_equal(part.angular_velocity, read.angular_velocity[3:6])
    assert np.array_equal(read[-1].times_s, read.times_s[-1:])


def test_gyroscopes_that_are_absent_or_never_turn_change_nothing(
    take: Take, database: MotionDatabase
) -> None:
    plain = reconstruct(take, database, use_gyroscopes=False)
    assert plain.readings.channels == [["specific_force"]] * len(take.sensors)
    take = Take({site: replace(r, orientation=None) for site, r in take.sensors.items()})
    zeros = {
        site: replace(r, angular_velocity=np.zeros_like(r.specific_force))
        for site, r in take.sensors.items()
    }
    for given in (without_gyroscopes(take), Take(zeros)):
        solved = reconstruct(given, database)
        assert solved.readings.channels == plain.readings.channels
        assert np.array_equal(solved.readings.specific_force, plain.readings.specific_force)
        assert np.array_equal(solved.motion.rotations, plain.motion.rotations)


def test_gravity_directions_are_unit_vectors_where_there_is_a_gyroscope(take: Take) -> None:
    half = Take({**take.sensors, "left_wrist": without_gyroscopes(take).sensors["left_wrist"]})
    readings = readings_of(half, 25.0, "whole_take")
    up, force = readings.gravity_direction, readings.specific_force
    at_rest = np.abs(np.linalg.norm(force, axis=2) - GRAVITY_MPS2) < 0.05
    for index, site in enumerate(half.sites):
        if site == "left_wrist":
            assert np.isnan(up[:, index]).all()
            continue
        assert np.linalg.norm(up[:, index], axis=1) == pytest.approx(1.0, abs=0.1)
        quiet = at_rest[:, index]
        assert quiet.any()
        level = force[quiet, index] / GRAVITY_MPS2
        assert np.median(np.linalg.norm(level - up[quiet, index], axis=1)) < 0.35


def test_directions_bring_the_limbs_nearer(take: Take, database: MotionDatabase) -> None:
    """How far the forearms and shanks rise, in the poses and as the sensors say."""
    names = database.skeleton.names
    joints = [names.index(name) for name in ("lradius", "rradius", "ltibia", "rtibia")]
    parents = [database.skeleton.parents[joint] for joint in joints]
    off = {}
    for uses in (False, True):
        solved = reconstruct(take, database, best_quality=True, use_gyroscopes=uses)
        assert solved.diagnostics["sensor_misfit_mps2"].shape[1] == len(take.sensors)
        positions = solved.motion.joint_positions("heading")
        bones = positions[:, joints] - positions[:, parents]
        rises = bones[:, :, 1] / np.linalg.norm(bones, axis=2)
        index = np.round((solved.readings.times_s - take.begin_s) * 100).astype(int)
        wanted = np.stack([true_up(take, site)[index, 0] for site in take.sites], axis=1)
        off[uses] = float(np.abs(rises - wanted).mean())
    assert off[True] < off[False]
