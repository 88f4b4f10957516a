# SPDX-License-Identifier: GPL-3.0-or-later
"""Sensors on one clock, by an event that all of them saw."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ._core import ConfigError, align_in_time
from .take import SensorRecord, Take, devices_of
from .take_file import device_comment

__all__ = ["AlignmentError", "aligned", "merged"]


_EVENT_S = 1.0  # around a clap or jump
_FINE_LAG_S = 0.2
_LEAST_CORRELATION = 0.7


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


def merged(
    takes: Sequence[tuple[str, Take]],
    spans: Sequence[tuple[float, float]] | None = None,
    largest_lag_s: float = 60.0,
    sites: Mapping[str, str] | None = None,
) -> tuple[Take, list[float]]:
    """Returns named takes as one on the clock of the first, and by how much the others were late.

    All of a take's sensors share its clock. spans: when each take has the clap or jump that all
    have, in its own seconds; None: the strongest common event counts. Sensors are renamed by sites;
    one whose name is in another take too gets its take's name. Raises AlignmentError.
    """
    (first_name, first), *others = takes
    lags_s = []
    for index, (name, take) in enumerate(others, 1):
        own = spans[index] if spans else None
        reference = spans[0] if spans else None
        lags_s.append(_take_lag((first_name, first), (name, take), reference, own, largest_lag_s))
    sensors: dict[str, SensorRecord] = {}
    devices = []
    counts = Counter(sensor for _, take in takes for sensor in take.sensors)
    for (name, take), lag_s in zip(takes, [0.0, *lags_s], strict=True):
        for sensor, record in take.sensors.items():
            unique = sensor if counts[sensor] == 1 else f"{name} {sensor}"
            unique = name if counts[sensor] > 1 and len(take.sensors) == 1 else unique
            site = (sites or {}).get(unique, unique)
            if site in sensors:
                raise AlignmentError(
                    f"two sensors are called {site!r}; give one of them another --site"
                )
            sensors[site] = replace(record, times_s=record.times_s - lag_s)
            if identity := devices_of(take).get(sensor):
                devices.append(device_comment(site, identity))
    begin_s = min(float(record.times_s[0]) for record in sensors.values())
    moved = {n: replace(r, times_s=r.times_s - begin_s) for n, r in sensors.items()}
    origin = f"merged from {', '.join(name for name, _ in takes)}"
    return Take(moved, (origin, *devices)), lags_s


def _take_lag(
    first: tuple[str, Take],
    other: tuple[str, Take],
    reference: tuple[float, float] | None,
    own: tuple[float, float] | None,
    largest_lag_s: float,
) -> float:
    """How late the other take's clock is; the pair of sensors that agree best says it."""
    best_lag_s, best = 0.0, 0.0
    for one in first[1].sensors.values():
        for two in other[1].sensors.values():
            shift_s = _event_s(two, own) - _event_s(one, reference)
            try:
                found = align_in_time(
                    *_around_event(one, reference), *_around_event(two, own, shift_s),
                    largest_lag_s=_FINE_LAG_S, window_s=_EVENT_S,
                )  # fmt: skip
            except ValueError:  # too near an end
                continue
            lag_s = float(found["lag_s"]) + shift_s
            if found["correlation"] > max(best, _LEAST_CORRELATION) and abs(lag_s) < largest_lag_s:
                best_lag_s, best = lag_s, float(found["correlation"])
    if not best:
        raise AlignmentError(
            f"{other[0]} and {first[0]} have no common event: clap or jump once while both record, "
            "and say when with --clap"
        )
    return best_lag_s


def _event_s(record: SensorRecord, span: tuple[float, float] | None) -> float:
    """When the sensor was struck hardest."""
    times_s, size = _magnitude(record, span)
    if not len(times_s):
        raise AlignmentError(
            f"there are no samples from {span[0]:g} to {span[1]:g} s" if span else "a take is empty"
        )
    return float(times_s[np.argmax(np.abs(size - np.median(size)))])


def _around_event(
    record: SensorRecord, span: tuple[float, float] | None, shift_s: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    at_s = _event_s(record, span)
    times_s, size = _magnitude(record, (at_s - _EVENT_S, at_s + _EVENT_S))
    return times_s - shift_s, size
