# SPDX-License-Identifier: GPL-3.0-or-later
"""When samples were taken: the truth is known here, for the clocks are made up."""

from __future__ import annotations

import numpy as np
import pytest
from sparse_mocap import host_times, spread_evenly


def arrivals(taken_s: np.ndarray, seed: int, burst: int = 1) -> np.ndarray:
    """Each arrives 0.2 ms after it was taken at the soonest, and with the last of its burst."""
    source = np.random.default_rng(seed)
    late = taken_s + 0.0002 + source.exponential(0.002, len(taken_s))
    late += 0.05 * (source.random(len(taken_s)) < 0.01)  # now and then the machine was busy
    for begin in range(0, len(late), burst):
        late[begin : begin + burst] = late[begin : begin + burst].max()
    return np.maximum.accumulate(late)


@pytest.mark.parametrize("drift", [0.0, 100e-6, -100e-6])
@pytest.mark.parametrize("rate_hz", [30.0, 200.0, 2000.0])
def test_the_devices_clock_is_laid_under_the_arrivals(drift: float, rate_hz: float) -> None:
    taken_s = 5000.0 + np.arange(int(300 * rate_hz)) / rate_hz
    device_s = 17.0 + (taken_s - taken_s[0]) * (1.0 + drift)
    times, rate = host_times(device_s, arrivals(taken_s, 3))
    assert abs(times - taken_s).max() < 1e-3
    assert rate == pytest.approx(1.0 / (1.0 + drift), abs=5e-6)
    assert (np.diff(times) > 0).all()


def test_bursts_do_not_matter_to_a_device_with_a_clock() -> None:
    taken_s = 100.0 + np.arange(20_000) / 200.0
    times, _ = host_times(taken_s - 100.0, arrivals(taken_s, 4, burst=20))
    assert abs(times - taken_s).max() < 2e-3


def test_a_clock_that_is_not_in_real_time_keeps_its_own_seconds() -> None:
    device_s = np.arange(1000) / 100.0
    times, rate = host_times(device_s, 50.0 + device_s / 8.0)
    assert np.diff(times) == pytest.approx(0.01)
    assert rate == pytest.approx(1.0 / 8.0)


def test_without_a_clock_what_arrived_at_once_is_spread() -> None:
    arrival_s = np.repeat([1.0, 1.04, 1.08, 1.12], 4)
    assert np.diff(spread_evenly(arrival_s)) == pytest.approx(0.01)
    assert spread_evenly(arrival_s)[-1] == pytest.approx(1.12)
    times, _ = host_times(np.full(16, np.nan), arrival_s)
    assert times == pytest.approx(spread_evenly(arrival_s))


def test_without_a_clock_a_pause_stays_a_pause() -> None:
    arrival_s = np.concatenate([np.arange(100) / 100.0, 5.0 + np.arange(100) / 100.0])
    assert spread_evenly(arrival_s) == pytest.approx(arrival_s)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_few_samples_have_times_too(count: int) -> None:
    times, _ = host_times(np.arange(count) / 100.0, 7.0 + np.arange(count) / 100.0)
    assert times == pytest.approx(7.0 + np.arange(count) / 100.0)
