# SPDX-License-Identifier: GPL-3.0-or-later
"""Sensors on one clock, by an event that all of them saw."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ._core import ConfigError, align_in_time
from .take import SensorRecord, Take

__all__ = ["AlignmentError", "aligned"]


class AlignmentError(ConfigError):
    """Sensors saw nothing in common; str() is one line."""


def aligned(
    take: Take, span: tuple[float, float] | None = None, largest_lag_s: float = 1.0
) -> tuple[Take, dict[str, float]]:
    """Returns the take on the clock of its first sensor, and by how much each sensor was late.

    The strongest event that both see (a clap, a jump; in the span if one is given) is found by
    itself. Raises AlignmentError for a sensor that saw nothing in common with the first, or for
    which several lags fit, as during steady walking.
    """
    (first_name, first), *others = take.sensors.items()
    lags, moved = {first_name: 0.0}, {first_name: first}
    for name, record in others:
        lags[name] = _lag(first_name, first, name, record, span, largest_lag_s)
        moved[name] = replace(record, times_s=record.times_s - lags[name])
    return Take(moved, take.comments), lags


def _lag(
    first_name: str,
    first: SensorRecord,
    name: str,
    record: SensorRecord,
    span: tuple[float, float] | None,
    largest_lag_s: float,
) -> float:
    try:
        found = align_in_time(
            *_magnitude(first, span), *_magnitude(record, span), largest_lag_s=largest_lag_s
        )
    except ValueError as error:
        raise AlignmentError(f"{name}: {error}") from None
    if not found["is_found"]:
        raise AlignmentError(
            f"{name} and {first_name} saw no common event (correlation "
            f"{found['correlation']:.2f}, at another lag {found['runner_up']:.2f}): clap or jump "
            "once while all sensors record"
        )
    return float(found["lag_s"])


def _magnitude(
    record: SensorRecord, span: tuple[float, float] | None
) -> tuple[np.ndarray, np.ndarray]:
    begin, end = (0, None) if span is None else np.searchsorted(record.times_s, span)
    return record.times_s[begin:end], np.linalg.norm(record.specific_force[begin:end], axis=1)
