# SPDX-License-Identifier: GPL-3.0-or-later
"""When samples were taken, on the machine's clock, from the device's clock and the arrivals.

A sample arrives after it was taken, by a delay that varies but has a least value: the device's
clock is laid under the arrivals. For devices without a clock the arrivals themselves are made even.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .. import ClockModel

Floats = NDArray[np.float64]

LARGEST_DRIFT = 0.01
"""Quartz drifts by 1e-4 at most; beyond this a device's clock is not in real time."""
_LEAST_STEP_S = 1e-6


def host_times(device_s: Floats, arrival_s: Floats) -> tuple[Floats, float]:
    """Returns when samples (N,) were taken, in s of the machine's clock, and the device's rate.

    The rate is seconds of the machine to one of the device. One that is not real (an emulator that
    plays faster) is returned, but the device's own seconds are kept.
    """
    if not np.isfinite(device_s).all():
        return evened(arrival_s), 1.0
    coarse = _slope(device_s, arrival_s)
    if abs(coarse - 1.0) > LARGEST_DRIFT and device_s[-1] - device_s[0] > 0.5:
        return _ascending(device_s + (arrival_s[0] - device_s[0])), coarse
    clock = ClockModel(window_s=math.inf)
    for device, arrival in zip(device_s, arrival_s, strict=True):
        clock.observe(float(device), float(arrival))
    rate = 1.0 + 1e-6 * clock.drift_ppm
    return _ascending(rate * device_s + clock.offset_s), rate


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


def _slope(x: Floats, y: Floats) -> float:
    span = float(x[-1] - x[0])
    return float(y[-1] - y[0]) / span if span > 0 else 1.0


def _ascending(times_s: Floats) -> Floats:
    steps = np.arange(len(times_s)) * _LEAST_STEP_S
    return np.asarray(np.maximum.accumulate(times_s - steps) + steps)
