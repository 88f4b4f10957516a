# SPDX-License-Identifier: GPL-3.0-or-later
"""Sensors on one clock, and live on a database's time line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from sparse_mocap import (
    ReadingStream,
    SensorInput,
    SensorRecord,
    Take,
    read_motion,
    write_take,
)
from sparse_mocap.alignment import AlignmentError, aligned
from sparse_mocap.readings import all_readings


def record(rate_hz: float, start_s: float, seed: int, jump_s: float | None = 4.0) -> SensorRecord:
    rng = np.random.default_rng(seed)
    times = (
        start_s + np.arange(int(10 * rate_hz)) / rate_hz + rng.uniform(0, 2e-3, int(10 * rate_hz))
    )
    force = np.tile([0.0, 0.0, 9.81], (len(times), 1)) + rng.normal(size=(len(times), 3)) * 0.2
    if jump_s is not None:
        force[:, 2] += 20 * np.exp(-0.5 * ((times - jump_s) / 0.05) ** 2)
        force[:, 2] += 30 * np.exp(-0.5 * ((times - jump_s - 0.6) / 0.04) ** 2)
    return SensorRecord(times, force)


def test_live_and_recorded_readings_are_the_same() -> None:
    sensors = {"left_wrist": record(100.0, 0.0, 1), "head": record(60.0, 0.013, 2)}
    sensors["head"] = SensorRecord(
        *(part[(sensors["head"].times_s < 5) | (sensors["head"].times_s > 5.7)]
          for part in (sensors["head"].times_s, sensors["head"].specific_force))
    )  # fmt: skip
    inputs = [SensorInput(site) for site in sensors]
    whole = all_readings(Take(sensors), inputs, 25.0)
    times, readings = whole.times_s, whole.specific_force
    live = ReadingStream(inputs, 25.0)
    samples = sorted(
        (time, index, tuple(force))
        for index, sensor in enumerate(sensors.values())
        for time, force in zip(sensor.times_s, sensor.specific_force, strict=True)
    )
    frames = []
    for time, index, force in samples:
        assert live.push(index, [time], [force]) == 1
        frames += [(each.times_s[0], each.specific_force[0], time) for each in live.ready(time)]
    frames += [(each.times_s[0], each.specific_force[0], np.inf) for each in live.flush()]
    assert len(frames) == len(times)
    np.testing.assert_allclose([at for at, _, _ in frames], times, atol=1e-9)
    np.testing.assert_array_equal(np.array([rows for _, rows, _ in frames]), readings)
    waits = np.array([now - at for at, _, now in frames if np.isfinite(now) and not 4.8 < at < 5.8])
    assert waits.min() >= live.delay_s - 1e-9
    assert waits.max() < live.delay_s + 0.02
    assert np.isnan(readings[:, 1]).any()


def test_a_jump_brings_sensors_onto_one_clock() -> None:
    true = {"left_wrist": 0.0, "head": 0.3217, "chest": -0.2548}
    sensors = {}
    for seed, (site, lag_s) in enumerate(true.items()):
        sensor = record(100.0 if seed else 60.0, 0.0, seed)
        sensors[site] = replace(sensor, times_s=sensor.times_s + lag_s)
    moved, lags = aligned(Take(sensors))
    for site, lag_s in true.items():
        assert lags[site] == pytest.approx(lag_s, abs=3e-3)
        np.testing.assert_allclose(
            moved.sensors[site].times_s, sensors[site].times_s - lags[site], atol=1e-12
        )


def test_sensors_without_a_common_event_are_refused_by_name() -> None:
    take = Take({"head": record(100.0, 0.0, 1), "chest": record(100.0, 0.0, 2, jump_s=None)})
    with pytest.raises(AlignmentError, match="chest and head saw no common event"):
        aligned(take)
    with pytest.raises(AlignmentError, match="overlap by too little"):
        aligned(take, (3.0, 4.0))


def test_reconstruct_brings_sensors_onto_one_clock_by_a_clap(
    cli: Callable[..., Result], database_path: Path, tmp_path: Path
) -> None:
    paths = []
    for name, lag_s in (("own", 0.2), ("common", 0.0)):
        sensors = {"left_wrist": record(100.0, 0.0, 1), "right_wrist": record(100.0, 0.0, 1)}
        late = sensors["right_wrist"]
        sensors["right_wrist"] = replace(late, times_s=late.times_s + lag_s)
        write_take(tmp_path / f"{name}.csv", Take(sensors))
        result = cli("reconstruct", "--database", database_path, tmp_path / f"{name}.csv",
                     "-o", tmp_path / f"{name}.bvh", "--clap", "1:9")  # fmt: skip
        assert result.exit_code == 0, result.output
        paths.append(tmp_path / f"{name}.bvh")
    own, common = (read_motion(path)[0].joint_positions("world") for path in paths)
    assert own.shape == common.shape
    assert np.linalg.norm(own - common, axis=2).mean() < 0.02
