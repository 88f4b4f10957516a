# SPDX-License-Identifier: GPL-3.0-or-later
"""From where a character's bones have to be to the channels of its controls. No Blender here.

Matrices are in the armature's space and units.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .character import RigMotion

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Control:
    """A bone that is keyed. Its pose is T_armature_frame @ basis, its own channels.

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


@dataclass(frozen=True)
class Mover:
    """The control whose location moves the character."""

    control: int
    R_armature_location: Floats  # (3, 3) how the bone moves with its location's three numbers
    thighs: tuple[int, int]
    """The controls of both thighs."""


@dataclass(frozen=True)
class Controls:
    """All controls of a character, and how its own space lies in the armature's."""

    controls: list[Control]
    mover: Mover
    R_armature_own: Floats  # (3, 3)
    units_per_metre: float
    properties: dict[str, float] = field(default_factory=dict)
    """Custom properties (data paths from the object) that these controls need, and their values."""


@dataclass(frozen=True)
class Channels:
    """The channels of all controls. T frames."""

    rotations: Floats  # (T, n, 3, 3) each control's own, relative to its frame
    location: Floats  # (T, 3) of the mover


def channels(rig: Controls, motion: RigMotion) -> Channels:
    """The channels with which the controls follow the motion."""
    to_armature = rig.R_armature_own
    wanted = to_armature @ motion.rotations @ to_armature.T
    poses: list[Floats] = []
    places: list[Floats] = []
    rotations = np.empty((motion.num_frames, len(rig.controls), 3, 3))
    for number, control in enumerate(rig.controls):
        pose = np.broadcast_to(control.rest, (motion.num_frames, 3, 3))
        if control.turned >= 0:
            pose = wanted[:, control.turned] @ control.rest
        offset = control.T_followed_frame[:3, 3]
        turn = control.T_followed_frame[:3, :3]
        if control.follows < 0:
            frame, place = turn, np.broadcast_to(offset, (motion.num_frames, 3))
        else:
            followed = poses[control.follows]
            frame = followed @ turn
            place = places[control.follows] + followed @ offset
        rotations[:, number] = np.swapaxes(frame, -1, -2) @ pose
        poses.append(pose)
        places.append(place)
    reached = 0.5 * (places[rig.mover.thighs[0]] + places[rig.mover.thighs[1]])
    hips = rig.units_per_metre * motion.hips @ to_armature.T
    inverse = np.linalg.inv(rig.mover.R_armature_location)
    return Channels(rotations, (hips - reached) @ inverse.T)
