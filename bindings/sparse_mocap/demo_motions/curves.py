# SPDX-License-Identifier: GPL-3.0-or-later
"""Smooth curves of time (seconds), twice differentiable: accelerations have no kinks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

__all__ = [
    "Knot",
    "cruise",
    "drift",
    "pulse",
    "pulses",
    "ramp",
    "running_integral",
    "smooth_cover",
    "through",
    "timeline",
]

Array = npt.NDArray[np.float64]

FRAME_RATE = 60.0
"""Frames per second of everything this package makes."""


def timeline(duration: float) -> Array:
    """Times (s) of the frames of a motion lasting ``duration`` seconds, first frame at zero."""
    return np.arange(round(duration * FRAME_RATE) + 1) / FRAME_RATE


def ramp(time: Array | float, start: float, end: float) -> Array:
    """Minimum-jerk rise from 0 before ``start`` to 1 after ``end``."""
    x = np.clip((np.asarray(time, dtype=float) - start) / (end - start), 0.0, 1.0)
    return np.asarray(x**3 * (10.0 - 15.0 * x + 6.0 * x**2))


def pulse(time: Array | float, start: float, rise: float, hold: float, fall: float) -> Array:
    """Rise from 0 to 1 from ``start`` on, stay, fall back to 0: durations in seconds."""
    top = start + rise
    return ramp(time, start, top) - ramp(time, top + hold, top + hold + fall)


def pulses(time: Array, starts: Sequence[float], rise: float, hold: float, fall: float) -> Array:
    """Equal pulses, one from each of ``starts`` on, added up."""
    return np.asarray(np.sum([pulse(time, s, rise, hold, fall) for s in starts], axis=0))


def cruise(time: Array, start: float, end: float, ease: float) -> Array:
    """Travel from 0 to 1 at a constant rate, speeding up and slowing down within ``ease`` s."""
    return running_integral(pulse(time, start, ease, end - start - 2.0 * ease, ease)) / (
        end - start - ease
    )


def running_integral(rate: Array) -> Array:
    """Integral over time of samples taken at the frame rate, zero at the first frame."""
    steps = 0.5 * (rate[1:] + rate[:-1]) / FRAME_RATE
    return np.concatenate([np.zeros_like(rate[:1]), np.cumsum(steps, axis=0)])


def smooth_cover(curve: Array, margin: float) -> Array:
    """A smooth curve nowhere below ``curve`` (n,), following it within ``margin`` seconds."""
    reach = round(margin * FRAME_RATE)
    padded = np.pad(curve, 2 * reach, mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1)
    kernel = np.cos(np.linspace(-0.5, 0.5, 2 * reach + 3)[1:-1] * np.pi) ** 4
    return np.convolve(windows.max(axis=1), kernel / kernel.sum(), mode="valid")


def drift(time: Array, rng: np.random.Generator, columns: int) -> Array:
    """Slow aimless wander of about unit size: independent curves, shape (n, columns)."""
    rates = rng.uniform([[0.12], [0.3], [0.6]], [[0.25], [0.5], [0.95]], (3, columns))
    phases = rng.uniform(0.0, 2.0 * np.pi, (3, columns))
    waves = np.sin(2.0 * np.pi * rates * time[:, None, None] + phases)
    return np.asarray(np.einsum("nkc,k->nc", waves, np.array([0.7, 0.4, 0.2])))


@dataclass(frozen=True)
class Knot:
    """State of a curve at one time: value and its first two rates, each of shape (d,) or scalar."""

    time: float
    value: Array | float
    speed: Array | float = 0.0
    bend: Array | float = 0.0


def through(time: Array, knots: list[Knot]) -> tuple[Array, Array, Array]:
    """Quintic curve through ``knots``, constant outside them: value, first and second derivative.

    Each result has shape (n, d).  Value, speed and bend are continuous everywhere inside.
    """
    at = np.array([k.time for k in knots])
    size = np.atleast_1d(knots[0].value).size
    state = np.array(
        [[np.broadcast_to(x, size) for x in (k.value, k.speed, k.bend)] for k in knots]
    )
    left = np.clip(np.searchsorted(at, time, side="right") - 1, 0, len(knots) - 2)
    span = (at[left + 1] - at[left])[:, None]
    x = np.clip((time[:, None] - at[left][:, None]) / span, 0.0, 1.0)
    a, b = state[left], state[left + 1]
    c = [a[:, 0], a[:, 1] * span, 0.5 * a[:, 2] * span**2]
    gap = b[:, 0] - c[0] - c[1] - c[2]
    slope = b[:, 1] * span - c[1] - 2.0 * c[2]
    curve = b[:, 2] * span**2 - 2.0 * c[2]
    c += [
        10 * gap - 4 * slope + curve / 2,
        -15 * gap + 7 * slope - curve,
        6 * gap - 3 * slope + curve / 2,
    ]
    value = sum(c[i] * x**i for i in range(6))
    speed = sum(i * c[i] * x ** (i - 1) for i in range(1, 6)) / span
    bend = sum(i * (i - 1) * c[i] * x ** (i - 2) for i in range(2, 6)) / span**2
    return value, speed, bend
