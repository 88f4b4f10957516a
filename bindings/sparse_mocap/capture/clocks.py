# SPDX-License-Identifier: GPL-3.0-or-later
"""When samples were taken, on the machine's clock, from the device's clock and the arrivals.

A sample arrives after it was taken, by a delay that varies but has a least value. The device's
clock is laid under the arrivals: per stretch of time the least delay counts, and a line through
those has the device's drift. For devices without a clock the arrivals themselves are made even.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

LARGEST_DRIFT = 0.01
"""Quartz drifts by 1e-4 at most; beyond this a device's clock is not in real time."""
_BLOCK_S = 2.0
_FEWEST_BLOCKS = 5
_LEAST_STEP_S = 1e-6


def host_times(device_s: Floats, arrival_s: Floats) -> tuple[Floats, float]:
    """Returns when samples (N,) were taken, in s of the machine's clock, and the device's rate.

    The rate is seconds of the machine to one of the device. One that is not real (an emulator that
    plays faster) is returned, but the device's own seconds are kept.
    """
    if not np.isfinite(device_s).all():
        return evened(arrival_s), 1.0
    rate, offset = _line_under(device_s, arrival_s)
    if abs(rate - 1.0) > LARGEST_DRIFT:
        return _ascending(device_s + (arrival_s[0] - device_s[0])), rate
    return _ascending(rate * device_s + offset), rate


def evened(arrival_s: Floats) -> Floats:
    """Returns times that ascend: samples that arrived at once are spread over the time before."""
    if len(arrival_s) < 2:
        return arrival_s.copy()
    firsts = np.flatnonzero(np.diff(arrival_s, prepend=-np.inf) > 0)
    counts = np.diff(firsts, append=len(arrival_s))
    instants = arrival_s[firsts]
    step = float(np.median(np.diff(instants) / counts[1:])) if len(instants) > 1 else 0.01
    place = np.arange(len(arrival_s)) - np.repeat(firsts, counts)
    back = np.repeat(counts, counts) - 1 - place
    room = np.diff(instants, prepend=instants[0] - step * counts[0])
    return _ascending(arrival_s - back * np.repeat(np.minimum(step, room / counts), counts))


def _line_under(device_s: Floats, arrival_s: Floats) -> tuple[float, float]:
    """Rate and offset of the line under the arrivals."""
    delay = arrival_s - device_s
    block = ((device_s - device_s[0]) / _BLOCK_S).astype(np.int64)
    begins = np.flatnonzero(np.diff(block, prepend=-1))
    ends = np.append(begins[1:], len(block))
    least = np.array([b + int(np.argmin(delay[b:e])) for b, e in zip(begins, ends, strict=True)])
    coarse = _slope(device_s, arrival_s)
    if abs(coarse - 1.0) > LARGEST_DRIFT and device_s[-1] - device_s[0] > 0.5:
        return coarse, float(arrival_s[0] - coarse * device_s[0])
    if len(least) < _FEWEST_BLOCKS:
        return 1.0, float(delay.min())
    drift = _robust_slope(device_s[least], delay[least])
    rest = delay - drift * device_s
    return 1.0 + drift, float(np.median(rest[least]))


def _slope(x: Floats, y: Floats) -> float:
    span = float(x[-1] - x[0])
    return float(y[-1] - y[0]) / span if span > 0 else 1.0


def _robust_slope(x: Floats, y: Floats) -> float:
    """The median slope between points half of the way apart (Theil and Sen's, thinned)."""
    half = len(x) // 2
    return float(np.median((y[half:] - y[: len(y) - half]) / (x[half:] - x[: len(x) - half])))


def _ascending(times_s: Floats) -> Floats:
    steps = np.arange(len(times_s)) * _LEAST_STEP_S
    return np.asarray(np.maximum.accumulate(times_s - steps) + steps)
