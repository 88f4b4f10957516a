# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 2, the take: a recorded performance."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .core import core
from .file_cache import FileCache

SUFFIX = ".csv"


@dataclass(frozen=True)
class LoadedTake:
    """A take and what the panel shows of it."""

    name: str
    take: Any  # sparse_mocap.take.Take
    sensors: list[str]
    duration_s: float
    rate_hz: float
    """Samples per second of the slowest sensor; 0 with fewer than two samples."""


def read_take(path: str) -> LoadedTake:
    """The take in the file. Raises TakeError and OSError."""
    take = core().take.read_take(path)
    return LoadedTake(
        name=Path(path).stem,
        take=take,
        sensors=take.sites,
        duration_s=take.end_s - take.begin_s,
        rate_hz=min(_rate_hz(record.times_s) for record in take.sensors.values()),
    )


def _rate_hz(times_s: np.ndarray) -> float:
    return 1.0 / float(np.median(np.diff(times_s))) if len(times_s) > 1 else 0.0


takes: FileCache[LoadedTake] = FileCache("take", read_take)
