# SPDX-License-Identifier: GPL-3.0-or-later
"""Imported motion files, on their own skeletons or on the standard skeleton."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .core import core
from .errors import InputError, one_line
from .file_cache import FileCache
from .job import Cancelled, Job, Progress
from .mapping import Mapped, last_mapped, mapped

IMPORTING = "Importing"
BVH, ACCLAIM = (".bvh",), (".asf", ".amc")
USUAL_SIZES_M = (0.5, 3.0)

_BVH_UNIT_M = 0.01  # the reader's default for .bvh


@dataclass(frozen=True)
class ImportOptions:
    """Options of the import."""

    unit_m: float | None = None
    """The file's length unit in metres; None: the one stored in the file, centimetres for .bvh."""
    up: str = "y"
    amc_rate_hz: float = 120.0
    is_standard: bool = False
    """Whether to transfer the motion to the standard skeleton."""


@dataclass(frozen=True)
class LoadedMotion:
    """A motion file. T frames (0: only a skeleton), J joints."""

    name: str
    skeleton: Any  # sparse_mocap.Skeleton
    frame_time_s: float
    root_positions: NDArray[np.float64]  # (T, 3) m
    rotations: NDArray[np.float64]  # (T, J, 4) w x y z
    offset_tracks: list[tuple[int, NDArray[np.float64]]]  # joint and (T, 3) m
    warnings: list[str]
    is_standard: bool
    """Whether the motion is on the standard skeleton."""
    mapped: Mapped
    """The file's skeleton and its mapping."""

    @property
    def num_frames(self) -> int:
        """Number of frames."""
        return len(self.root_positions)


@dataclass(frozen=True)
class Loaded:
    """What came of the chosen files."""

    motions: list[LoadedMotion]
    problems: list[str]
    """One line for each file that cannot be used."""


@dataclass(frozen=True)
class FileSummary:
    """Content of a motion file, shown before it is imported."""

    num_joints: int
    num_frames: int
    rate_hz: float
    size_m: float
    """Longest side of the figure's bounding box, in m with the file's own unit."""
    size_units: float
    """The same in units of the file."""

    def size_with(self, unit_m: float | None) -> float:
        """The figure's size (m) with another unit; None: the file's own."""
        return self.size_m if unit_m is None else self.size_units * unit_m


def import_job(paths: list[str], endings: tuple[str, ...], options: ImportOptions) -> Job:
    """The job that reads motion files; its result is Loaded.

    One of several that cannot be used does not keep the others out; when none can, its error is the
    job's. An .asf that is chosen together with .amc files is used as their skeleton. Raises
    InputError.
    """
    core()
    chosen = _checked(paths, endings)
    skeletons = [path for path in chosen if _ending(path) == ".asf"]
    motions = [path for path in chosen if path not in skeletons] or skeletons
    asf = skeletons[0] if len(skeletons) == 1 and motions != skeletons else None

    def work(progress: Progress) -> Loaded:
        loaded = Loaded([], [])
        for index, path in enumerate(motions):
            if not progress(index, len(motions), Path(path).name):
                raise Cancelled("Cancelled")
            try:
                loaded.motions.append(load_motion(path, options, asf))
            except (ValueError, OSError) as error:
                if not loaded.motions and index == len(motions) - 1:
                    raise
                loaded.problems.append(one_line(error))
        if not progress(len(motions), len(motions), ""):
            raise Cancelled("Cancelled")
        return loaded

    return Job(IMPORTING, work)


def load_motion(path: str, options: ImportOptions, asf: str | None = None) -> LoadedMotion:
    """The motion in the file. Raises FormatError, MappingError and OSError."""
    sparse_mocap = core()
    motion, warnings = sparse_mocap.read_motion(
        path,
        amc_rate_hz=options.amc_rate_hz,
        unit_m=options.unit_m,
        up=options.up,
        asf=asf,
        allow_no_frames=True,
    )
    name = Path(path).stem
    found = mapped(name, motion)
    is_standard = options.is_standard and motion.num_frames > 0
    if is_standard:
        if found.problem:
            last_mapped[:] = [found]  # to be corrected in the panel
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


def summarize(path: str) -> FileSummary:
    """Read the file's summary. Raises FormatError and OSError."""
    read = core().read_motion
    motion, _ = read(path, allow_no_frames=True)
    size_m = _size_m(motion)
    if _ending(path) in ACCLAIM:
        size_units = _size_m(read(path, unit_m=1.0, allow_no_frames=True)[0])
    else:
        size_units = size_m / _BVH_UNIT_M
    return FileSummary(
        num_joints=len(motion.skeleton.parents),
        num_frames=motion.num_frames,
        rate_hz=1.0 / motion.frame_time_s,
        size_m=size_m,
        size_units=size_units,
    )


file_summaries: FileCache[FileSummary] = FileCache("motion file", summarize)


def _size_m(motion: Any) -> float:
    """Longest side of the figure's bounding box, in the first frame or else in rest pose."""
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
    """The paths without repetitions. Raises InputError for none or a wrong extension."""
    expected = " or ".join(endings)
    if not paths:
        raise InputError(f"Choose a file that ends in {expected}")
    for path in paths:
        if os.path.isdir(path):
            raise InputError(f"{path} is a folder: choose a file that ends in {expected}")
        if _ending(path) not in endings:
            raise InputError(f"{path} does not end in {expected}: choose another file")
    return list(dict.fromkeys(paths))
