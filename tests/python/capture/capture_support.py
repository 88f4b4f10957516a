# SPDX-License-Identifier: GPL-3.0-or-later
"""What the capture's tests share."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np
from sparse_mocap import SensorRecord, Take
from sparse_mocap.capture import CaptureClient, CaptureError, Emulator
from sparse_mocap.capture.session import sessions

SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle", "head", "pelvis")
DRIVER = "xsens_mt"
"""Has counters, and many sensors on a port."""
OPTIONS = {"output": "mtdata"}


def some_take(seconds: float, num_sensors: int = 3, rate_hz: float = 100.0) -> Take:
    """Smooth readings, different for every sensor, well within every device's range."""
    times_s = np.arange(round(seconds * rate_hz)) / rate_hz
    sensors = {}
    for index, site in enumerate(SITES[:num_sensors]):
        phase = times_s[:, None] * [3.0, 2.0, 1.0] + index
        turn = 0.5 * times_s + index
        zero = np.zeros_like(turn)
        sensors[site] = SensorRecord(
            times_s,
            np.sin(phase) + np.array([0.0, 0.0, 9.8]),
            0.5 * np.cos(phase),
            np.column_stack([np.cos(turn / 2), zero, np.sin(turn / 2), zero]),
        )
    return Take(sensors)


def until(is_so: Callable[[], Any], timeout_s: float = 20.0) -> None:
    end = time.perf_counter() + timeout_s
    while not is_so():
        assert time.perf_counter() < end, "it never happened"
        time.sleep(0.01)


def stop_captures() -> None:
    """Ends whatever a test left running."""
    with suppress(CaptureError):  # a test may name a folder that is refused
        for session in sessions():
            with suppress(CaptureError):
                CaptureClient(session).stop()


Play = Callable[..., Emulator]
