# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion files as they are, on their own skeletons or on the standard one."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .core import core
from .errors import InputError
from .job import Cancelled, Job, Progress
from .mapping import Mapped, last_mapped, mapped
from .opened import Shelf

IMPORTING = "Importing"
BVH, ACCLAIM = (".bvh",), (".asf", ".amc")
USUAL_SIZES_M = (0.5, 3.0)

_BVH_UNIT_M = 0.01  # what is taken when a .bvh is read without saying


@dataclass(frozen=True)
class Reading:
    """How a motion file is to be read."""

    unit_m: float | None = None
    """Metres a unit of the file; None: what the file says, and centimetres for .bvh."""
    up: str = "y"
    amc_rate_hz: float = 120.0
    is_standard: bool = False
    """Whether the motion is put onto the standard skeleton."""


@dataclass(frozen=True)
class LoadedMotion:
    """A motion file that was read. T frames (none: a skeleton alone), J joints."""

    name: str
    skeleton: Any  # sparse_mocap.Skeleton
    frame_time_s: float
    root_positions: NDArray[np.float64]  # (T, 3) m
    rotations: NDArray[np.float64]  # (T, J, 4) w x y z
    offset_tracks: list[tuple[int, NDArray[np.float64]]]  # joint and (T, 3) m
    warnings: list[str]
    is_standard: bool
    """Whether it is on the standard skeleton."""
    mapped: Mapped
    """The file's skeleton, and where its body was found."""

    @property
    def num_frames(self) -> int:
        """How many frames there are."""
        return len(self.root_positions)


@dataclass(frozen=True)
class Glance:
    """What is seen of a motion file before it is imported."""

    num_joints: int
    num_frames: int
    rate_hz: float
    size_m: float
    """The longest side of the box around the figure as the file says."""
    size_units: float
    """The same in the file's own unit."""

    def size_with(self, unit_m: float | None) -> float:
        """The figure's size (m) when the file's unit is that long."""
        return self.size_m if unit_m is None else self.size_units * unit_m


def import_job(paths: list[str], endings: tuple[str, ...], reading: Reading) -> Job:
    """The job that reads motion files; its result is a list of LoadedMotion.

    Among .amc files an .asf is not read alone; one that is chosen with them is their skeleton.
    Raises InputError, or what a file is at fault for.
    """
    core()
    chosen = _checked(paths, endings)
    skeletons = [path for path in chosen if _ending(path) == ".asf"]
    motions = [path for path in chosen if path not in skeletons] or skeletons
    asf = skeletons[0] if len(skeletons) == 1 and motions != skeletons else None

    def work(progress: Progress) -> list[LoadedMotion]:
        loaded = []
        for index, path in enumerate(motions):
            if not progress(index, len(motions), Path(path).name):
                raise Cancelled("Cancelled")
            loaded.append(load_motion(path, reading, asf))
        if not progress(len(motions), len(motions), ""):
            raise Cancelled("Cancelled")
        return loaded

    return Job(IMPORTING, work)


def load_motion(path: str, reading: Reading, asf: str | None = None) -> LoadedMotion:
    """The motion in the file. Raises FormatError, MappingError and OSError."""
    sparse_mocap = core()
    motion, warnings = sparse_mocap.read_motion(
        path,
        amc_rate_hz=reading.amc_rate_hz,
        unit_m=reading.unit_m,
        up=reading.up,
        asf=asf,
        allow_no_frames=True,
    )
    name = Path(path).stem
    found = mapped(name, motion)
    is_standard = reading.is_standard and motion.num_frames > 0
    if is_standard:
        if found.problem:
            last_mapped[:] = [found]  # to be mended in its panel
        motion, more = sparse_mocap.to_standard(motion)
        warnings = warnings + more
    return LoadedMotion(
        name=name,
        skeleton=motion.skeleton,
        frame_time_s=motion.frame_time_s,
        root_positions=motion.root_positions,
        rotations=motion.rotations,
        offset_tracks=motion.offset_tracks,
        warnings=warnings,
        is_standard=is_standard,
        mapped=found,
    )


def glance_at(path: str) -> Glance:
    """What is in the file. Raises FormatError and OSError."""
    read = core().read_motion
    motion, _ = read(path, allow_no_frames=True)
    size_m = _size_m(motion)
    if _ending(path) in ACCLAIM:
        size_units = _size_m(read(path, unit_m=1.0, allow_no_frames=True)[0])
    else:
        size_units = size_m / _BVH_UNIT_M
    return Glance(
        num_joints=len(motion.skeleton.parents),
        num_frames=motion.num_frames,
        rate_hz=1.0 / motion.frame_time_s,
        size_m=size_m,
        size_units=size_units,
    )


glances: Shelf[Glance] = Shelf("motion file", glance_at)


def _size_m(motion: Any) -> float:
    """The longest side of the box around the figure in the first frame, else in rest pose."""
    if motion.num_frames > 0:
        points = motion.trimmed(0, 1).joint_positions("world")[0]
    else:
        skeleton = motion.skeleton
        offsets, bones = skeleton.offsets, skeleton.bones
        points = np.zeros_like(offsets)
        for joint, parent in enumerate(skeleton.parents):
            pivot = points[parent] + offsets[joint] if parent >= 0 else points[joint]
            points[joint] = pivot + bones[joint]
    return float(np.ptp(points, axis=0).max())


def _ending(path: str) -> str:
    return os.path.splitext(path)[1].lower()


def _checked(paths: list[str], endings: tuple[str, ...]) -> list[str]:
    """The paths, if there are any and all end as they should. Raises InputError."""
    expected = " or ".join(endings)
    if not paths:
        raise InputError(f"Choose a file that ends in {expected}")
    for path in paths:
        if os.path.isdir(path):
            raise InputError(f"{path} is a folder: choose a file that ends in {expected}")
        if _ending(path) not in endings:
            raise InputError(f"{path} does not end in {expected}: choose another file")
    return list(dict.fromkeys(paths))
