# SPDX-License-Identifier: GPL-3.0-or-later
"""Fewer keys with a bounded error, and smoother motion. No Blender here."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .core import core
from .steps import Steps, finished

Floats = NDArray[np.float64]

_TRIED_AT_ONCE = 100


def kept_key_steps(times: Floats, values: Floats, largest_error: float) -> Steps[NDArray[np.intp]]:
    """The indices of the keys to keep, so that lines between them miss no value by more.

    times (T,) ascend; values (T, n); the error is the Euclidean distance at the same time
    (Douglas and Peucker 1973, with the distance along time). Yields now and then.
    """
    num_keys = len(times)
    if num_keys < 3 or largest_error <= 0.0:
        return np.arange(num_keys)
    kept = np.zeros(num_keys, dtype=bool)
    kept[[0, -1]] = True
    stretches = [(0, num_keys - 1)]
    num_tried = 0
    while stretches:
        num_tried += 1
        if num_tried % _TRIED_AT_ONCE == 0:
            yield float(kept.mean())
        begin, end = stretches.pop()
        if end - begin < 2:
            continue
        share = (times[begin + 1 : end] - times[begin]) / (times[end] - times[begin])
        line = values[begin] + share[:, None] * (values[end] - values[begin])
        errors = np.linalg.norm(values[begin + 1 : end] - line, axis=1)
        worst = int(np.argmax(errors))
        if errors[worst] > largest_error:
            middle = begin + 1 + worst
            kept[middle] = True
            stretches += [(begin, middle), (middle, end)]
    return np.flatnonzero(kept)


def kept_keys(times: Floats, values: Floats, largest_error: float) -> NDArray[np.intp]:
    """As kept_key_steps, without steps."""
    return finished(kept_key_steps(times, values, largest_error))


def quaternion_distance(degrees: float) -> float:
    """The distance between two unit quaternions that many degrees apart."""
    return float(2.0 * np.sin(np.radians(degrees) / 4.0))


def smoothed(motion: Any, deviation_s: float) -> Any:
    """The motion (sparse_mocap.Motion) after a Gaussian filter of that standard deviation."""
    sigma = deviation_s / motion.frame_time_s
    if sigma <= 0.0 or motion.num_frames < 3:
        return motion
    reach = int(np.ceil(3.0 * sigma))
    weights = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    weights /= weights.sum()
    rotations = np.array(motion.rotations)
    products = np.einsum("tji,tji->tj", rotations[1:], rotations[:-1])
    signs = np.cumprod(np.where(products < 0.0, -1.0, 1.0), axis=0)
    rotations[1:] *= signs[..., None]
    filtered = _filtered(rotations.reshape(len(rotations), -1), weights).reshape(rotations.shape)
    return core().Motion(
        motion.skeleton,
        motion.frame_time_s,
        _filtered(np.array(motion.root_positions), weights),
        filtered / np.linalg.norm(filtered, axis=-1, keepdims=True),
    )


def _filtered(columns: Floats, weights: Floats) -> Floats:
    reach = len(weights) // 2
    padded = np.pad(columns, ((reach, reach), (0, 0)), mode="edge")
    return np.stack([np.convolve(column, weights, mode="valid") for column in padded.T], axis=1)
