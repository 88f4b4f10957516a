# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of real sensors, added to ideal takes."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians

import numpy as np
from numpy.typing import NDArray

from . import GRAVITY_MPS2
from .rotations import about_axis, from_rotation_vectors, product
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
    position_m: float = 0.0
    """Standard deviation of each axis of a position, white."""
    position_outliers: float = 0.0
    """Share of the positions that are wrong."""
    outlier_m: float = 0.0
    """Standard deviation of each axis of a wrong position's error."""
    orientation_rad: float = 0.0
    """Standard deviation of an orientation about each axis, white."""
    heading_drift_radps: float = 0.0
    """rad/s, standard deviation of the constant rate at which each orientation turns about up."""


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
    "optical": NoiseModel(position_m=0.002, orientation_rad=radians(0.3)),
    "ultrasonic": NoiseModel(
        position_m=0.01,
        position_outliers=0.02,
        outlier_m=0.2,
        orientation_rad=radians(0.5),
    ),
    "inertial": NoiseModel(
        accelerometer_density=0.2 * _MILLI_G,
        accelerometer_bias=10 * _MILLI_G,
        gyroscope_density=radians(0.01),
        gyroscope_bias=radians(0.2),
        scale_error=0.005,
        misalignment_rad=radians(2.0),
        orientation_rad=radians(0.5),
        heading_drift_radps=radians(0.1),
    ),
}


def noise_presets() -> dict[str, NoiseModel]:
    """Returns the named models.

    For accelerometers and gyroscopes: none, research (calibrated, strapped well) and consumer. For
    trackers: optical, ultrasonic (as Liu et al. 2011 use: noisier, with wrong positions among the
    right ones) and inertial (orientations whose heading drifts, and no use for positions).
    """
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
        orientation = _noisy_orientation(orientation, record.times_s, model, rng)
    position = record.position
    if position is not None:
        is_wrong = rng.random((len(position), 1)) < model.position_outliers
        deviation = np.where(is_wrong, model.outlier_m, model.position_m)
        position = position + deviation * rng.normal(size=position.shape)
    times_s = record.times_s + model.latency_s
    return SensorRecord(times_s, force, rates, orientation, position)


def _noisy_orientation(
    orientation: Floats, times_s: Floats, model: NoiseModel, rng: np.random.Generator
) -> Floats:
    """Returns orientations whose heading drifts from the first one's on."""
    turned = np.zeros((len(times_s), 3))
    turned[:, 1] = model.heading_drift_radps * rng.normal() * (times_s - times_s[0])
    drifted = product(from_rotation_vectors(turned), orientation)
    wobble = model.orientation_rad * rng.normal(size=turned.shape)
    return product(drifted, from_rotation_vectors(wobble))


def _rotation(axis: Floats, angle: float) -> Floats:
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross))
