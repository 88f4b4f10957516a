# SPDX-License-Identifier: GPL-3.0-or-later
"""Motions on characters, as keys of their controls. No Blender here."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from .character import Character, Floats
from .controls import Controls, channels

_CHUNK = 500  # frames, between which a job can be cancelled


@dataclass(frozen=True)
class Target:
    """A character's armature, by name, and how its controls move it."""

    armature: str
    character: Character
    controls: Controls
    held: list[str]
    """Bones that a constraint, a driver or a lock keeps from following."""


@dataclass(frozen=True)
class RigTake:
    """What a character's controls do in a take. T frames, n controls."""

    target: Target
    times_s: Floats  # (T,)
    quaternions: Floats  # (T, n, 4) w x y z, each control's own, without jumps of sign
    location: Floats  # (T, 3) of the control that moves the character


def on_scene_frames(motion: Any, rate_hz: float) -> Any:
    """The motion (sparse_mocap.Motion) with one pose for each frame of the scene."""
    if motion.num_frames < 2 or abs(motion.frame_time_s * rate_hz - 1.0) < 1e-9:
        return motion
    return motion.resampled(rate_hz)


def rig_take_steps(target: Target, motion: Any) -> Iterator[tuple[int, RigTake | None]]:
    """The number of frames done and, at the end, the take on the character."""
    parts, lowest = [], []
    for begin in range(0, motion.num_frames, _CHUNK):
        end = min(begin + _CHUNK, motion.num_frames)
        moved = target.character.motion(motion.trimmed(begin, end))
        lowest.append(moved.above_floor_m)
        parts.append(moved)
        yield end, None
    lift = target.character.lift_m(np.concatenate(lowest)) if lowest else 0.0
    found = [channels(target.controls, part.lifted(lift)) for part in parts]
    quaternions = without_jumps(
        quaternions_of(np.concatenate([part.rotations for part in found])) if found else _NOTHING
    )
    location = np.concatenate([part.location for part in found]) if found else np.empty((0, 3))
    times_s = np.arange(motion.num_frames) * motion.frame_time_s
    yield motion.num_frames, RigTake(target, times_s, quaternions, location)


_NOTHING: Floats = np.empty((0, 0, 3, 3))


def rig_take(target: Target, motion: Any) -> RigTake:
    """As rig_take_steps, without steps."""
    for _, take in rig_take_steps(target, motion):
        if take is not None:
            return take
    raise AssertionError("the steps end with a take")


def quaternions_of(matrices: Floats) -> Floats:
    """(..., 4) w x y z of rotations (..., 3, 3) (Shepperd 1978: from the largest of the four)."""
    m = np.asarray(matrices, dtype=np.float64)
    trace = np.trace(m, axis1=-2, axis2=-1)
    diagonal = np.diagonal(m, axis1=-2, axis2=-1)
    squares = np.concatenate(
        [(1.0 + trace)[..., None], 1.0 + 2.0 * diagonal - trace[..., None]], axis=-1
    )
    products = np.empty((*m.shape[:-2], 4, 4))
    for i in range(4):
        products[..., i, i] = squares[..., i]
    for i, (j, k) in enumerate(((1, 2), (2, 0), (0, 1))):
        difference, total = m[..., k, j] - m[..., j, k], m[..., j, k] + m[..., k, j]
        products[..., 0, i + 1] = products[..., i + 1, 0] = difference
        products[..., j + 1, k + 1] = products[..., k + 1, j + 1] = total
    largest = np.argmax(squares, axis=-1)
    rows = np.take_along_axis(products, largest[..., None, None], axis=-2)[..., 0, :]
    return np.asarray(rows / np.linalg.norm(rows, axis=-1, keepdims=True))


def without_jumps(quaternions: Floats) -> Floats:
    """(T, n, 4) the same rotations; signs never jump, and the first w is not negative."""
    if len(quaternions) == 0:
        return quaternions
    products = np.einsum("tni,tni->tn", quaternions[1:], quaternions[:-1])
    jumps = np.where(products < 0.0, -1.0, 1.0)
    first = np.where(quaternions[:1, :, 0] < 0.0, -1.0, 1.0)
    return quaternions * np.cumprod(np.concatenate([first, jumps]), axis=0)[..., None]
