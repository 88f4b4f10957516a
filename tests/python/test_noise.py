# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulated sensors' errors have the sizes that they are said to have."""

from __future__ import annotations

import numpy as np
import pytest
from sparse_mocap import NoiseModel, SensorRecord, Take, noise_presets, noisy

G = 9.80665


def take_of(num_samples: int = 20_000, sites: tuple[str, ...] = ("head", "pelvis")) -> Take:
    times = np.arange(num_samples) / 100
    forces = np.tile([0.0, 0.0, G], (num_samples, 1))
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (num_samples, 1))
    return Take({site: SensorRecord(times, forces, forces * 0.1, turns) for site in sites})


def test_no_noise_changes_nothing() -> None:
    take = take_of(10)
    assert noisy(take, noise_presets()["none"], 3) is take


@pytest.mark.parametrize("preset", ["research", "consumer"])
def test_a_seed_decides_everything(preset: str) -> None:
    model = noise_presets()[preset]
    one, same, other = (noisy(take_of(50), model, seed) for seed in (1, 1, 2))
    for site in one.sites:
        force = one.sensors[site].specific_force
        np.testing.assert_array_equal(force, same.sensors[site].specific_force)
        assert not np.allclose(force, other.sensors[site].specific_force)
    heads = [one.sensors[site].specific_force for site in one.sites]
    assert not np.allclose(*heads)


def test_consumer_is_as_noisy_turned_and_late_as_agreed() -> None:
    model = noise_presets()["consumer"]
    record = noisy(take_of(), model, 0).sensors["head"]
    density = record.specific_force.std(axis=0) / np.sqrt(100 / 2)
    np.testing.assert_allclose(density, 2e-3 * G, rtol=0.03)
    assert record.times_s[0] == pytest.approx(0.020)
    assert record.orientation is not None
    angle = 2 * np.degrees(np.arccos(record.orientation[0, 0]))
    assert angle == pytest.approx(5.0)


def tracked(num_samples: int = 20_000) -> SensorRecord:
    times = np.arange(num_samples) / 40
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (num_samples, 1))
    places = np.tile([1.0, 2.0, 3.0], (num_samples, 1))
    return SensorRecord(times, np.zeros((num_samples, 3)), None, turns, places)


def test_trackers_are_as_noisy_as_agreed() -> None:
    take = Take({"head": tracked()})
    optical = noisy(take, noise_presets()["optical"], 1).sensors["head"]
    assert optical.position is not None
    assert optical.orientation is not None
    np.testing.assert_allclose(optical.position.std(axis=0), 0.002, rtol=0.03)
    np.testing.assert_allclose(optical.position.mean(axis=0), [1, 2, 3], atol=1e-4)
    turns = 2 * np.degrees(optical.orientation[:, 1:]).std(axis=0)
    np.testing.assert_allclose(turns, 0.3, rtol=0.03)
    ultrasonic = noisy(take, noise_presets()["ultrasonic"], 1).sensors["head"]
    assert ultrasonic.position is not None
    away = np.linalg.norm(ultrasonic.position - [1, 2, 3], axis=1)
    assert np.median(away) == pytest.approx(0.0154, rel=0.05)  # of three axes with 1 cm each
    assert np.mean(away > 0.1) == pytest.approx(0.018, abs=0.004)  # most wrong ones


def test_headings_drift_evenly_about_up() -> None:
    record = noisy(Take({"head": tracked(401)}), NoiseModel(heading_drift_radps=0.01), 2).sensors[
        "head"
    ]
    assert record.orientation is not None
    yaw = 2 * np.arcsin(record.orientation[:, 2])
    assert abs(yaw[-1]) > 1e-3
    np.testing.assert_allclose(yaw, yaw[-1] * np.linspace(0, 1, 401), atol=1e-12)
    np.testing.assert_allclose(record.orientation[:, [1, 3]], 0.0, atol=1e-12)


def test_a_turned_sensor_reads_the_same_vector_in_its_own_axes() -> None:
    record = noisy(take_of(5), NoiseModel(misalignment_rad=0.3), 4).sensors["head"]
    assert record.orientation is not None
    w, *v = record.orientation[0]
    cross = np.cross(np.eye(3), v)  # the matrix of v x ...
    R_world_sensor = np.eye(3) + 2 * w * cross + 2 * cross @ cross
    np.testing.assert_allclose(R_world_sensor @ record.specific_force[0], [0, 0, G], atol=1e-9)
    assert record.angular_velocity is not None
    np.testing.assert_allclose(
        R_world_sensor @ record.angular_velocity[0], [0, 0, G / 10], atol=1e-9
    )


def test_bias_and_scale_are_constant() -> None:
    model = NoiseModel(accelerometer_bias=0.2, scale_error=0.01, gyroscope_bias=0.1)
    record = noisy(take_of(100), model, 5).sensors["head"]
    assert np.ptp(record.specific_force, axis=0).max() < 1e-12
    assert 1e-3 < abs(record.specific_force[0] - [0, 0, G]).max() < 1.0
