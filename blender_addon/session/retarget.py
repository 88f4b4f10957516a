# SPDX-License-Identifier: GPL-3.0-or-later
"""Motions on characters, as keys of their controls. No Blender here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .character import Character, Floats, FootLock, RigMotion
from .controls import Controls, channels


@dataclass(frozen=True)
class Target:
    """A character's armature, by name, and how its controls move it."""

    armature: str
    character: Character
    controls: Controls
    held: list[str]
    """Bones that a constraint, a driver or a lock keeps from following."""
    others: tuple[str, ...] = ()
    """Bones and data paths of properties that another choice of limbs keys."""
    floor_m: float = 0.0
    """How high the floor is above the character's origin."""

    @property
    def bones(self) -> list[str]:
        """The bones that get keys."""
        keyed = [control.name for control in self.controls.controls if control.is_keyed]
        for limb in self.controls.limbs:
            keyed += [placed.name for placed in (limb.target, limb.pole) if placed is not None]
        return keyed


@dataclass(frozen=True)
class Track:
    """What one bone of a character is keyed with. T frames."""

    bone: str
    quaternions: Floats | None  # (T, 4) w x y z, without jumps of sign
    location: Floats | None  # (T, 3)


@dataclass(frozen=True)
class RigTake:
    """What a character's controls do in a take. T frames."""

    target: Target
    times_s: Floats  # (T,)
    tracks: tuple[Track, ...]
    stands: NDArray[np.bool_]  # (T, 2) when the left and the right foot stand


def on_scene_frames(motion: Any, contacts: Floats, rate_hz: float) -> tuple[Any, Floats]:
    """The motion (sparse_mocap.Motion) and its contacts (T, 2), one pose for each frame."""
    if motion.num_frames < 2 or abs(motion.frame_time_s * rate_hz - 1.0) < 1e-9:
        return motion, contacts
    placed = motion.resampled(rate_hz)
    times_s = np.arange(placed.num_frames) / rate_hz
    known_s = np.arange(motion.num_frames) * motion.frame_time_s
    columns = [np.interp(times_s, known_s, contacts[:, side]) for side in range(2)]
    return placed, np.column_stack(columns)


def rig_take(target: Target, motion: Any, contacts: Floats, lock: FootLock) -> RigTake:
    """A motion on the standard skeleton (sparse_mocap.Motion) as keys of the character.

    contacts (T, 2): how certain it is that the left and the right foot stand.
    """
    character = target.character
    moved = character.standing(character.on_rig(motion))
    moved, stands = character.with_locked_feet(moved, contacts, lock)
    tracks = tracks_of(target.controls, character.world(moved).lifted(target.floor_m))
    times_s = np.arange(motion.num_frames) * motion.frame_time_s
    return RigTake(target, times_s, tuple(tracks), stands)


def tracks_of(controls: Controls, motion: RigMotion) -> list[Track]:
    """What the controls' bones are keyed with."""
    found = channels(controls, motion)
    turns = iter(_quaternions([one.rotations for one in found if one.rotations is not None]))
    return [
        Track(one.name, None if one.rotations is None else next(turns), one.location)
        for one in found
    ]


def _quaternions(rotations: list[Floats]) -> list[Floats]:
    """(T, 4) of each bone's rotations (T, 3, 3), without jumps of sign.

    A live pose takes them all at once, which saves time, and a take one bone after the other, which
    saves memory.
    """
    if rotations and len(rotations[0]) == 1:
        quaternions = quaternions_of(np.stack(rotations))
        return list(np.where(quaternions[..., :1] < 0.0, -quaternions, quaternions))
    return [without_jumps(quaternions_of(one)) for one in rotations]


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
    """(T, 4) the same rotations; signs never jump, and the first w is not negative."""
    if len(quaternions) == 0:
        return quaternions
    products = np.einsum("ti,ti->t", quaternions[1:], quaternions[:-1])
    first = -1.0 if quaternions[0, 0] < 0.0 else 1.0
    signs = first * np.cumprod(np.concatenate([[1.0], np.where(products < 0.0, -1.0, 1.0)]))
    return quaternions * signs[:, None]
