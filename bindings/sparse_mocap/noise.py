# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of real sensors, added to ideal takes."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians

import numpy as np
from numpy.typing import NDArray

from . import GRAVITY_MPS2
from .rotations import about_axis, product
from .take import SensorRecord, Take

__all__ = ["NoiseModel", "noise_presets", "noisy"]

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class NoiseModel:
    """The errors of sensors; drawn separately for every sensor of a take."""

    accelerometer_density: float = 0.0
    """m/s^2 per square root of Hz, white."""
    accelerometer_bias: float = 0.0
    """m/s^2, standard deviation of each axis' constant error."""
    gyroscope_density: float = 0.0
    """rad/s per square root of Hz, white."""
    gyroscope_bias: float = 0.0
    """rad/s, standard deviation of each axis' constant error."""
    scale_error: float = 0.0
    """Standard deviation of each axis' relative error of scale, 0.01 is 1 %."""
    misalignment_rad: float = 0.0
    """Rotation of each sensor on the body, about a random axis."""
    latency_s: float = 0.0
    """Delay of the samples."""


_MILLI_G = 1e-3 * GRAVITY_MPS2

_PRESETS = {
    "none": NoiseModel(),
    "research": NoiseModel(
        accelerometer_density=0.2 * _MILLI_G,
        accelerometer_bias=3 * _MILLI_G,
        gyroscope_density=radians(0.01),
        gyroscope_bias=radians(0.2),
        scale_error=0.002,
        misalignment_rad=radians(1.0),
        latency_s=0.005,
    ),
    "consumer": NoiseModel(
        accelerometer_density=2 * _MILLI_G,
        accelerometer_bias=20 * _MILLI_G,
        gyroscope_density=radians(0.05),
        gyroscope_bias=radians(1.0),
        scale_error=0.01,
        misalignment_rad=radians(5.0),
        latency_s=0.020,
    ),
}


def noise_presets() -> dict[str, NoiseModel]:
    """Returns the named models: none, research (calibrated, strapped well) and consumer."""
    return dict(_PRESETS)


def noisy(take: Take, model: NoiseModel, seed: int = 0) -> Take:
    """Returns the take as such sensors would have recorded it; reproducible by the seed."""
    if model == NoiseModel():
        return take
    seeds = np.random.SeedSequence(seed).spawn(len(take.sensors))
    streams = [np.random.default_rng(own) for own in seeds]
    sensors = {
        site: _noisy_record(record, model, rng)
        for (site, record), rng in zip(take.sensors.items(), streams, strict=True)
    }
    return Take(sensors, take.comments)


def _noisy_record(
    record: SensorRecord, model: NoiseModel, rng: np.random.Generator
) -> SensorRecord:
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    R_true_sensor = _rotation(axis, model.misalignment_rad)
    rate_hz = 1.0 / float(np.median(np.diff(record.times_s))) if len(record.times_s) > 1 else 1.0
    white = np.sqrt(0.5 * rate_hz)  # standard deviation of a sample for a density of 1
    scale = 1.0 + model.scale_error * rng.normal(size=3)
    bias = model.accelerometer_bias * rng.normal(size=3)
    force = scale * (record.specific_force @ R_true_sensor) + bias
    force = force + model.accelerometer_density * white * rng.normal(size=force.shape)
    rates = record.angular_velocity
    if rates is not None:
        rates = rates @ R_true_sensor + model.gyroscope_bias * rng.normal(size=3)
        rates = rates + model.gyroscope_density * white * rng.normal(size=rates.shape)
    orientation = record.orientation
    if orientation is not None:
        orientation = product(orientation, about_axis(axis, model.misalignment_rad))
    times_s = record.times_s + model.latency_s
    return SensorRecord(times_s, force, rates, orientation, record.position)


def _rotation(axis: Floats, angle: float) -> Floats:
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross))
