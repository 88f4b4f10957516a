# SPDX-License-Identifier: GPL-3.0-or-later
"""Readings made as samples come are those made of the whole take at once."""

from __future__ import annotations

import numpy as np
import pytest
from capture_support import some_take
from sparse_mocap import (
    FILTER_REACH_S,
    ReadingStream,
    SensorInput,
    filtered_at,
    gravity_directions,
)
from sparse_mocap.capture.sample_log import SAMPLE
from sparse_mocap.readings import push_samples

START_S = 100.0
LONGEST_WAIT_S = 0.1


def streamed(silent_s: tuple[float, float] = (0.0, 0.0), has_clock: bool = True) -> np.ndarray:
    take = some_take(4.0, 2)
    parts = []
    for index, record in enumerate(take.sensors.values()):
        part = np.zeros(len(record.times_s), SAMPLE)
        part["sensor"] = index
        part["device_time_s"] = record.times_s + 7.0 * index if has_clock else np.nan
        part["arrival_ns"] = (START_S + record.times_s) * 1e9
        part["specific_force"] = record.specific_force
        part["angular_velocity"] = record.angular_velocity
        is_silent = (record.times_s >= silent_s[0]) & (record.times_s < silent_s[1])
        parts.append(part if index == 0 else part[~is_silent])
    samples = np.concatenate(parts)
    return samples[np.argsort(samples["arrival_ns"], kind="stable")]


def played(
    samples: np.ndarray, step_s: float, inputs: list[SensorInput] | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Returns times, specific forces, gravity directions, and how late the latest reading was."""
    sensors = inputs or [SensorInput("left_wrist"), SensorInput("right_wrist")]
    stream = ReadingStream(sensors, 25.0)
    times, forces, directions, late_s = [], [], [], 0.0
    for now_s in np.arange(START_S, START_S + 4.0, step_s):
        arrived = samples["arrival_ns"] * 1e-9
        push_samples(stream, [0, 1], samples[(arrived > now_s - step_s) & (arrived <= now_s)])
        ready = stream.ready(now_s)
        times += ready.times_s.tolist()
        forces += list(ready.specific_force)
        directions += list(ready.gravity_direction)
        late_s = max([late_s, *(now_s - ready.times_s).tolist()])
    return np.array(times), np.array(forces), np.array(directions), late_s


@pytest.mark.parametrize("step_s", [0.01, 0.07])
@pytest.mark.parametrize("has_clock", [True, False])
def test_they_are_what_the_whole_take_gives(step_s: float, has_clock: bool) -> None:
    times, forces, _, late_s = played(streamed(has_clock=has_clock), step_s)
    assert len(times) > 90
    assert np.diff(times) == pytest.approx(1 / 25)
    for index, record in enumerate(some_take(4.0, 2).sensors.values()):
        whole = filtered_at(START_S + record.times_s, record.specific_force, times)
        inner = times > START_S + FILTER_REACH_S
        assert forces[inner, index] == pytest.approx(whole[inner], abs=1e-3)
    assert late_s < FILTER_REACH_S + step_s + 0.05


def test_directions_are_those_of_the_whole_take() -> None:
    bias = np.array([[0.2, -0.1, 0.3], [0.0, 0.0, 0.0]])
    samples = streamed()
    first = samples["sensor"] == 0
    samples["angular_velocity"][first] += bias[0].astype(np.float32)
    inputs = [
        SensorInput("left_wrist", ["specific_force", "gravity_direction"], gyroscope_bias=bias[0]),
        SensorInput("right_wrist", ["specific_force"]),
    ]
    times, _, directions, _ = played(samples, 0.01, inputs)
    assert np.isnan(directions[:, 1]).all()
    record = some_take(4.0, 2).sensors["left_wrist"]
    assert record.angular_velocity is not None
    up = gravity_directions(record.times_s, record.specific_force, record.angular_velocity)
    is_sure = np.isfinite(up).all(axis=1)
    whole = filtered_at(START_S + record.times_s[is_sure], up[is_sure], times)
    known = np.isfinite(directions[:, 0]).all(axis=1)
    assert not known[times < START_S + 0.3].any()
    assert known[times > START_S + 1.0].all()
    assert directions[known, 0] == pytest.approx(whole[known], abs=2e-3)


def test_a_silent_sensor_is_waited_for_and_then_left_out() -> None:
    times, forces, _, late_s = played(streamed(silent_s=(1.5, 2.5)), 0.01)
    is_silent = np.isnan(forces[:, 1]).all(axis=1)
    silent_s = times[is_silent] - START_S
    assert 1.5 < silent_s.min() < 1.75
    assert 2.3 < silent_s.max() < 2.5
    assert not np.isnan(forces[:, 0]).any()
    assert late_s <= FILTER_REACH_S + LONGEST_WAIT_S + 0.02
    assert np.diff(times) == pytest.approx(1 / 25)
