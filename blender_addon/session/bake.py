# SPDX-License-Identifier: GPL-3.0-or-later
"""A reconstructed take on the scene's frames and on characters, ready for keys. No Blender here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .character import Floats
from .job import Cancelled, Progress
from .reconstruct import Performance
from .retarget import RigTake, Target, on_scene_frames, rig_take_steps

PLACING = "Placing on the character"


@dataclass(frozen=True)
class Placement:
    """Where a take is put."""

    start_frame: float
    scene_rate_hz: float
    is_on_frames: bool
    """Whether keys are on whole frames of the scene; otherwise at the take's own times."""
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
    motion = performance.motion
    if placement.is_on_frames:
        motion = on_scene_frames(motion, placement.scene_rate_hz)
    takes = []
    for target in placement.targets:
        for done, take in rig_take_steps(target, motion):
            if not progress(done, motion.num_frames, PLACING):
                raise Cancelled("Cancelled")
            if take is not None:
                takes.append(take)
    return PlacedTake(performance, placement, motion, tuple(takes))
