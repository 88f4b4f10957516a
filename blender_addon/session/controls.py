# SPDX-License-Identifier: GPL-3.0-or-later
"""From where a character's bones have to be to the channels of its controls. No Blender here.

Matrices are in the armature's space and units.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .character import RigMotion

Floats = NDArray[np.float64]

_CLEAR_BEND = (0.015, 0.06)  # sine of a limb's bend, from where its own plane counts


@dataclass(frozen=True)
class Control:
    """A bone that turns. Its pose is T_armature_frame @ basis, its own channels.

    The frame moves with another control, or not at all: T_armature_frame = T_armature_followed @
    T_followed_frame.
    """

    name: str
    turned: int
    """Which of the character's turned bones it turns with; -1: it keeps its rest."""
    rest: Floats  # (3, 3) its orientation at rest
    follows: int
    """Index of the control that its frame moves with, smaller than its own; -1: the armature."""
    T_followed_frame: Floats  # (4, 4)
    is_keyed: bool = True
    """False where an IK control is keyed instead."""


@dataclass(frozen=True)
class Mover:
    """The control whose location moves the character."""

    control: int
    R_armature_location: Floats  # (3, 3) how the bone moves with its location's three numbers
    thighs: tuple[int, int]
    """The controls of both thighs."""

    @cached_property
    def to_location(self) -> Floats:
        """(3, 3) from rows in the armature's space to rows of the location's three numbers."""
        return np.asarray(np.linalg.inv(self.R_armature_location).T)


@dataclass(frozen=True)
class Placed:
    """An IK control, which is placed in space. It may follow another control as Control does."""

    name: str
    follows: int
    T_armature_rest: Floats  # (4, 4)
    T_followed_frame: Floats  # (4, 4)
    R_followed_location: Floats  # (3, 3) how it moves with its location's three numbers

    @cached_property
    def to_location(self) -> Floats:
        """(3, 3) from rows in the followed control's space to rows of those three numbers."""
        return np.asarray(np.linalg.inv(self.R_followed_location).T)


@dataclass(frozen=True)
class Limb:
    """An arm or a leg that IK controls move; by the controls of its three bones."""

    begin: int
    middle: int
    end: int
    target: Placed
    pole: Placed | None
    pole_angle_rad: float
    """How far the rig turns the limb's plane from the pole, about the line to the limb's end."""
    rest: Floats  # (3, 3) where the three bones begin at rest


@dataclass(frozen=True)
class Controls:
    """All controls of a character, and how its own space lies in the armature's."""

    controls: list[Control]
    mover: Mover
    R_armature_own: Floats  # (3, 3)
    units_per_metre: float
    properties: dict[str, float] = field(default_factory=dict)
    """Custom properties (data paths from the object) that these controls need, and their values."""
    limbs: tuple[Limb, ...] = ()


@dataclass(frozen=True)
class Channels:
    """What one bone is keyed with. T frames."""

    name: str
    rotations: Floats | None  # (T, 3, 3) relative to its frame
    location: Floats | None  # (T, 3)


@dataclass(frozen=True)
class _Poses:
    """Where the controls are: T frames each."""

    rotations: list[Floats]  # (T, 3, 3)
    places: list[Floats]  # (T, 3)


def channels(rig: Controls, motion: RigMotion) -> list[Channels]:
    """The channels with which the controls follow the motion."""
    to_armature = rig.R_armature_own
    wanted = to_armature @ motion.rotations @ to_armature.T
    poses, turns = _fk(rig, wanted, motion.num_frames)
    first, second = rig.mover.thighs
    hips = rig.units_per_metre * motion.hips @ to_armature.T
    moved = hips - 0.5 * (poses.places[first] + poses.places[second])
    location = moved @ rig.mover.to_location
    found = []
    for number, control in enumerate(rig.controls):
        is_mover = number == rig.mover.control
        if not (control.is_keyed or is_mover):
            continue
        is_turned = control.turned >= 0 and control.is_keyed
        found.append(
            Channels(
                control.name,
                turns[number] if is_turned else None,
                location if is_mover else None,
            )
        )
    poses = _Poses(poses.rotations, [place + moved for place in poses.places])
    for limb in rig.limbs:
        found += _limb_channels(limb, rig, poses)
    return found


def _fk(rig: Controls, wanted: Floats, num_frames: int) -> tuple[_Poses, list[Floats]]:
    """Where the controls are without the mover's location, and their own rotations."""
    poses = _Poses([], [])
    turns = []
    for control in rig.controls:
        if control.turned >= 0:
            pose = wanted[:, control.turned] @ control.rest
        else:
            pose = np.repeat(control.rest[None], num_frames, axis=0)
        frame, place = _frame(control.follows, control.T_followed_frame, poses, num_frames)
        turns.append(frame.transpose(0, 2, 1) @ pose)
        poses.rotations.append(pose)
        poses.places.append(place)
    return poses, turns


def _frame(
    follows: int, T_followed_frame: Floats, poses: _Poses, num_frames: int
) -> tuple[Floats, Floats]:
    """(T, 3, 3) and (T, 3) of a frame that moves with a control."""
    turn, offset = T_followed_frame[:3, :3], T_followed_frame[:3, 3]
    if follows < 0:
        return np.repeat(turn[None], num_frames, axis=0), np.repeat(
            offset[None], num_frames, axis=0
        )
    followed = poses.rotations[follows]
    return followed @ turn, poses.places[follows] + followed @ offset


def _limb_channels(limb: Limb, rig: Controls, poses: _Poses) -> list[Channels]:
    """The target at the limb's end, turned as that is, and the pole in front of its middle."""
    begin, middle, end = (poses.places[number] for number in (limb.begin, limb.middle, limb.end))
    turned = poses.rotations[limb.end] @ rig.controls[limb.end].rest.T
    rest = limb.target.T_armature_rest
    place = end + turned @ (rest[:3, 3] - limb.rest[2])
    rotations = turned @ rest[:3, :3]
    frame, _ = _frame(limb.target.follows, limb.target.T_followed_frame, poses, len(place))
    found = [
        Channels(
            limb.target.name,
            np.swapaxes(frame, -1, -2) @ rotations,
            _location(limb.target, place, poses),
        )
    ]
    if limb.pole is not None:
        upper = poses.rotations[limb.begin] @ rig.controls[limb.begin].rest.T
        pole = _pole_places(limb, limb.pole, np.stack([begin, middle, end], axis=1), upper)
        found.append(Channels(limb.pole.name, None, _location(limb.pole, pole, poses)))
    return found


def _location(placed: Placed, places: Floats, poses: _Poses) -> Floats:
    """(T, 3) the location channel with which the control is there."""
    _, origin = _frame(placed.follows, placed.T_followed_frame, poses, len(places))
    moved = places - origin
    if placed.follows >= 0:
        moved = np.einsum("tji,tj->ti", poses.rotations[placed.follows], moved)
    return np.asarray(moved @ placed.to_location)


def _pole_places(limb: Limb, pole: Placed, points: Floats, upper: Floats) -> Floats:
    """(T, 3) in the limb's plane, as far from its middle as at rest.

    A straight limb has no plane: there the pole turns with its upper bone.
    """
    begin, middle, end = limb.rest
    at_rest = _across(pole.T_armature_rest[:3, 3] - middle, end - begin)
    distance = _lengths(pole.T_armature_rest[:3, 3] - middle)
    along = points[:, 2] - points[:, 0]
    turned = _unit(_across(upper @ at_rest, along))
    bent = _across(points[:, 1] - points[:, 0], along)
    sine = _lengths(bent) / _lengths(middle - begin)
    share = np.clip((sine - _CLEAR_BEND[0]) / (_CLEAR_BEND[1] - _CLEAR_BEND[0]), 0.0, 1.0)
    share = share * share * (3.0 - 2.0 * share)
    out = _unit(share[:, None] * _unit(bent) + (1.0 - share)[:, None] * turned)
    aside = _cross(_unit(along), out)
    out = np.cos(limb.pole_angle_rad) * out - np.sin(limb.pole_angle_rad) * aside
    return np.asarray(points[:, 1] + distance * out)


def _across(vectors: Floats, along: Floats) -> Floats:
    """The part of vectors (..., 3) that is at right angles to a direction."""
    unit = _unit(along)
    return np.asarray(vectors - unit * np.sum(vectors * unit, axis=-1, keepdims=True))


def _unit(vectors: Floats) -> Floats:
    return np.asarray(vectors / np.maximum(_lengths(vectors), 1e-12)[..., None])


def _lengths(vectors: Floats) -> Floats:
    """Of vectors (..., 3); much quicker than NumPy's norm for the few of a live pose."""
    return np.asarray(np.sqrt(np.einsum("...i,...i", vectors, vectors)))


def _cross(a: Floats, b: Floats) -> Floats:
    """As NumPy's, for (..., 3); as much quicker."""
    return np.asarray(a[..., [1, 2, 0]] * b[..., [2, 0, 1]] - a[..., [2, 0, 1]] * b[..., [1, 2, 0]])
