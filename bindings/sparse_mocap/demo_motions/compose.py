# SPDX-License-Identifier: GPL-3.0-or-later
"""Joining exercises into one motion, and the small unrest that makes it alive."""

from __future__ import annotations

from math import radians

import numpy as np

from .controls import ARM, FACING, HEAD, PLACE, SPINE, TILT, WIDTH, displaced, neutral
from .curves import FRAME_RATE, Array, drift
from .style import Actor

__all__ = ["alive", "joined"]


def joined(actor: Actor, parts: list[Array], overlap: float = 0.5) -> Array:
    """One motion made of exercises that each start and end standing at ease.

    Every part begins where and as the one before ended.  Neighbours share ``overlap`` seconds, in
    which the departures of both from standing are added.
    """
    shared = round(overlap * FRAME_RATE)
    start = neutral(actor)[None]
    motion = start
    for part in parts:
        end = motion[-1]
        heading = end[FACING]
        onset = displaced(start, heading, end[0], end[2])
        moved = displaced(part, heading, end[0], end[2]) - onset
        common = min(shared, len(motion) - 1, len(part) - 1)
        result = np.repeat(end[None], len(motion) + len(part) - 1 - common, axis=0)
        result[: len(motion)] = motion
        result[len(motion) - 1 - common :] += moved
        motion = result
    return motion


def alive(actor: Actor, motion: Array, rng: np.random.Generator, amount: float = 1.0) -> Array:
    """The motion with breathing, swaying and other slow unrest of the upper body added."""
    time = np.arange(len(motion)) / FRAME_RATE
    scale = np.zeros(WIDTH)
    scale[PLACE] = [0.35, 0.0, 0.35]
    scale[TILT] = radians(0.5)
    scale[SPINE] = radians(0.9)
    scale[HEAD] = [radians(1.5), radians(2.5), radians(1.0)]
    for block in ARM.values():
        scale[block] = [radians(1.6), radians(0.8), radians(2.0), radians(2.0), radians(2.5)]
    result = motion + amount * actor.style.unrest * scale * drift(time, rng, WIDTH)
    breath = np.sin(2.0 * np.pi * (0.27 * time + rng.uniform()))
    result[:, SPINE.start] -= radians(0.5) * breath
    for block in ARM.values():
        result[:, block.start + 1] += radians(0.4) * breath
    return result
