# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of the live sensors is being shaken, to find out which device is which."""

from __future__ import annotations

from collections import deque

import numpy as np

from .sample_log import Samples

__all__ = ["ShakeFinder"]

WINDOW_S = 1.2
_CLEARLY = 2.0  # how much more the shaken sensor must move than any other
_LEAST_MPS2 = 4.0
_FEWEST_SAMPLES = 10


class ShakeFinder:
    """Watches all sensors until one of them was shaken while the others were not."""

    def __init__(self) -> None:
        self._parts: deque[Samples] = deque()

    def push(self, samples: Samples) -> int | None:
        """Takes new samples; returns the number of the sensor that is shaken, if one is."""
        if not len(samples):
            return None
        self._parts.append(samples)
        newest_ns = int(samples["arrival_ns"].max())
        while int(self._parts[0]["arrival_ns"].max()) < newest_ns - WINDOW_S * 1e9:
            self._parts.popleft()
        recent = np.concatenate(list(self._parts))
        moved = {
            int(sensor): _movement(recent["specific_force"][recent["sensor"] == sensor])
            for sensor in np.unique(recent["sensor"])
        }
        first, *others = sorted(moved, key=lambda sensor: -moved[sensor])
        is_clear = not others or moved[first] > _CLEARLY * moved[others[0]]
        return first if is_clear and moved[first] > _LEAST_MPS2 else None


def _movement(force: np.ndarray) -> float:
    """How far a sensor's specific forces (N, 3) spread, in m/s^2; 0 for too few samples."""
    if len(force) < _FEWEST_SAMPLES:
        return 0.0
    return float(np.sqrt(np.nanvar(force, axis=0).sum()))
