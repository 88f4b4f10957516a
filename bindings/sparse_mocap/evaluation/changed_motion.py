# SPDX-License-Identifier: GPL-3.0-or-later
"""A recorded motion as a taller or a faster performer would do it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .. import Motion, Skeleton

__all__ = ["at_tempos", "scaled"]

Floats = NDArray[np.float64]


def scaled(motion: Motion, factor: float) -> Motion:
    """Returns the same movement of a body that is so many times as large."""
    if factor == 1.0:
        return motion
    skeleton = motion.skeleton
    pivots: list[Floats] = []
    ends: list[Floats] = []
    for parent, offset, bone in zip(
        skeleton.parents, skeleton.offsets, skeleton.bones, strict=True
    ):
        pivots.append(factor * offset + (ends[parent] if parent >= 0 else 0.0))
        ends.append(pivots[-1] + factor * bone)
    body = Skeleton(list(skeleton.names), list(skeleton.parents), np.array(pivots), np.array(ends))
    return Motion(body, motion.frame_time_s, factor * motion.root_positions, motion.rotations)


def at_tempos(motion: Motion, tempos: Sequence[float]) -> tuple[Motion, tuple[Floats, Floats]]:
    """Returns the movement done at these tempos, from its beginning to its end, linear between.

    And its times (s) with those of the motion then; 2.0 is twice as fast. Raises ValueError for
    tempos that are not positive.
    """
    if not tempos or min(tempos) <= 0.0:
        raise ValueError("tempos must be positive")
    step_s = motion.frame_time_s
    clip_s: Floats = np.arange(motion.num_frames, dtype=float) * step_s
    knots_s = np.linspace(0.0, clip_s[-1], len(tempos))
    slowness = 1.0 / np.interp(clip_s, knots_s, tempos)
    done_s: Floats = np.concatenate(
        [[0.0], np.cumsum(0.5 * (slowness[1:] + slowness[:-1]) * step_s)]
    )
    if len(tempos) == 1:
        faster = Motion(
            motion.skeleton, step_s / tempos[0], motion.root_positions, motion.rotations
        )
        return (motion if tempos[0] == 1.0 else faster), (done_s, clip_s)
    wanted_s = np.arange(int(done_s[-1] / step_s) + 1) * step_s
    frames = np.interp(wanted_s, done_s, clip_s) / step_s
    rotations = _between(_continuous(motion.rotations), frames)
    rotations /= np.linalg.norm(rotations, axis=-1, keepdims=True)
    roots = _between(motion.root_positions, frames)
    return Motion(motion.skeleton, step_s, roots, rotations), (done_s, clip_s)


def _continuous(rotations: Floats) -> Floats:
    """Returns unit quaternions (T, J, 4) with the signs that change least from frame to frame."""
    turns = np.sum(rotations[1:] * rotations[:-1], axis=-1) < 0.0
    flips = np.cumsum(turns, axis=0) % 2 == 1
    signs = np.concatenate([np.ones((1, rotations.shape[1])), np.where(flips, -1.0, 1.0)])
    return np.asarray(rotations * signs[..., None])


def _between(values: Floats, frames: Floats) -> Floats:
    """Returns values (T, ...) at frames that need not be whole, by cubic Hermite curves."""
    last = len(values) - 1
    before = np.clip(frames.astype(int), 0, max(last - 1, 0))
    after = np.minimum(before + 1, last)
    slopes = np.gradient(values, axis=0) if last > 0 else np.zeros_like(values)
    x = (frames - before).reshape(-1, *([1] * (values.ndim - 1)))
    y = 1.0 - x
    return np.asarray(
        y * y * ((1.0 + 2.0 * x) * values[before] + x * slopes[before])
        + x * x * ((1.0 + 2.0 * y) * values[after] - y * slopes[after])
    )
