# SPDX-License-Identifier: GPL-3.0-or-later
"""A reconstructed take on the scene's frames and on characters, ready for keys. No Blender here."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .character import Floats, FootLock
from .job import Cancelled, Progress
from .reconstruct import Performance
from .retarget import RigTake, Target, on_scene_frames, rig_take

PLACING = "Placing on"


@dataclass(frozen=True)
class Placement:
    """Where a take is put."""

    start_frame: float
    scene_rate_hz: float
    is_on_frames: bool
    """Whether keys are on whole frames of the scene; otherwise at the take's own times."""
    lock: FootLock = field(default_factory=FootLock)
    targets: tuple[Target, ...] = ()
    """The characters; none: the add-on's own figure."""

    def frames(self, times_s: Floats) -> Floats:
        """(T,) the scene's frames at these times."""
        frames = self.start_frame + times_s * self.scene_rate_hz
        return np.round(frames) if self.is_on_frames else frames


@dataclass(frozen=True)
class PlacedTake:
    """A reconstructed take, ready for keys."""

    performance: Performance
    placement: Placement
    motion: Any  # sparse_mocap.Motion, with the poses that get keys
    rig_takes: tuple[RigTake, ...]

    @property
    def frames(self) -> Floats:
        """(T,) the scene's frames that get keys."""
        times_s = np.arange(self.motion.num_frames) * self.motion.frame_time_s
        return self.placement.frames(times_s)


def placed(performance: Performance, placement: Placement, progress: Progress) -> PlacedTake:
    """The take on the characters of the placement. Raises Cancelled."""
    motion, contacts = performance.motion, performance.contacts
    if placement.is_on_frames:
        motion, contacts = on_scene_frames(motion, contacts, placement.scene_rate_hz)
    takes = []
    for number, target in enumerate(placement.targets):
        if not progress(number, len(placement.targets), f"{PLACING} {target.armature}"):
            raise Cancelled("Cancelled")
        takes.append(rig_take(target, motion, contacts, placement.lock))
    if not progress(1, 1, ""):
        raise Cancelled("Cancelled")
    return PlacedTake(performance, placement, motion, tuple(takes))
