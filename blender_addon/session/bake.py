# SPDX-License-Identifier: GPL-3.0-or-later
"""A reconstructed take on the scene's frames and on characters, ready for keys. No Blender here."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from .character import Floats, FootLock
from .errors import InputError
from .job import Cancelled, Job, Progress
from .key_reduction import smoothed
from .reconstruct import Performance, keep
from .retarget import RigTake, Target, on_scene_frames, rig_take

PLACING, PLACING_AGAIN = "Placing on", "Updating the action"


@dataclass(frozen=True)
class Placement:
    """Where a take is put."""

    start_frame: float
    scene_rate_hz: float
    is_on_frames: bool
    """Whether keys are on whole frames of the scene; otherwise at the take's own times."""
    part_s: tuple[float, float] | None = None
    """Which part of the take, from and to; 0 as the second: to its end."""
    smooth_s: float = 0.0
    """Standard deviation of the filter."""
    largest_errors: tuple[float, float] | None = None
    """How far keys that are left out may put bones off: degrees, and cm; None: all keys stay."""
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
    alternatives: tuple[PlacedTake, ...] = ()
    """Other motions of the take, placed alike."""

    @property
    def frames(self) -> Floats:
        """(T,) the scene's frames that get keys."""
        times_s = np.arange(self.motion.num_frames) * self.motion.frame_time_s
        return self.placement.frames(times_s)


def placed(performance: Performance, placement: Placement, progress: Progress) -> PlacedTake:
    """The take on the characters of the placement, with its alternatives. Raises Cancelled."""
    motion, contacts = performance.motion, performance.contacts
    if placement.part_s is not None:
        begin, end = _frames_of(placement.part_s, motion)
        motion, contacts = motion.trimmed(begin, end), contacts[begin:end]
    motion = smoothed(motion, placement.smooth_s)
    if placement.is_on_frames:
        motion, contacts = on_scene_frames(motion, contacts, placement.scene_rate_hz)
    takes = []
    for number, target in enumerate(placement.targets):
        if not progress(number, len(placement.targets), f"{PLACING} {target.armature}"):
            raise Cancelled("Cancelled")
        takes.append(rig_take(target, motion, contacts, placement.lock))
    if not progress(1, 1, ""):
        raise Cancelled("Cancelled")
    others = tuple(placed(other, placement, progress) for other in performance.alternatives)
    keep(performance)
    return PlacedTake(performance, placement, motion, tuple(takes), others)


def place_job(performance: Performance, placement: Placement) -> Job:
    """The job that puts a result on the characters again; its result is a PlacedTake.

    Its alternatives are results of their own.
    """
    alone = replace(performance, alternatives=())
    return Job(PLACING_AGAIN, lambda progress: placed(alone, placement, progress))


def _frames_of(part_s: tuple[float, float], motion: Any) -> tuple[int, int]:
    """The frames [begin, end) of a part of the motion. Raises InputError when there are none."""
    begin = round(part_s[0] / motion.frame_time_s)
    end = round(part_s[1] / motion.frame_time_s) + 1 if part_s[1] > 0.0 else motion.num_frames
    end = min(end, motion.num_frames)
    if begin >= end:
        length_s = (motion.num_frames - 1) * motion.frame_time_s
        raise InputError(
            f"There is nothing from {part_s[0]:g} to {part_s[1]:g} s: "
            f"the take is {length_s:.1f} s long"
        )
    return begin, end
