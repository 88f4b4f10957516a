# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: skeletons, motions, other skeletons on the standard one."""

import os

from numpy.typing import ArrayLike

from ._core_types import Floats, Path

class Skeleton:
    """A joint tree: pivot = end_parent + R_parent offset, end = pivot + R_joint bone."""

    @property
    def names(self) -> list[str]:
        """The J joints' names, the root first."""
    @property
    def parents(self) -> list[int]:
        """(J,) index of each joint's parent, smaller than its own; -1 for the root."""
    @property
    def offsets(self) -> Floats:
        """(J, 3) m, from the parent's end to the pivot, in the parent's frame."""
    @property
    def bones(self) -> Floats:
        """(J, 3) m, from pivot to end, in the joint's frame (the world's in rest pose)."""

class Motion:
    """What a skeleton does, sampled evenly."""

    def __init__(
        self,
        skeleton: Skeleton,
        frame_time_s: float,
        root_positions: ArrayLike,
        rotations: ArrayLike,
    ) -> None:
        """root_positions (T, 3) m; rotations (T, J, 4) w x y z, relative to the parent."""
    @property
    def skeleton(self) -> Skeleton:
        """A copy of it."""
    @property
    def frame_time_s(self) -> float:
        """From one frame to the next."""
    @property
    def num_frames(self) -> int:
        """T."""
    @property
    def root_positions(self) -> Floats:
        """(T, 3) m, world, pivot of the root."""
    @property
    def rotations(self) -> Floats:
        """(T, J, 4) rotation of each joint relative to its parent, w x y z."""
    @property
    def offset_tracks(self) -> list[tuple[int, Floats]]:
        """Joints that the file moves besides the root, and (T, 3) m their offset in every frame."""
    def joint_positions(self, frame: str = "world") -> Floats:
        """(T, J, 3) m, the joints' ends; frame: 'heading' (standard skeleton), 'root', 'world'."""
    def pivot_positions(self) -> Floats:
        """(T, J, 3) m, world, what the joints turn about."""
    def resampled(self, rate_hz: float) -> Motion:
        """The motion sampled at a new rate: rotations by slerp, positions by interpolation.

        A zero-phase Gaussian low-pass comes first where the rate goes down.
        """
    def trimmed(self, begin: int, end: int) -> Motion:
        """The frames [begin, end)."""
    def reversed(self) -> Motion:
        """The same movement played backwards."""
    def mirrored(self) -> Motion:
        """The movement seen in a mirror at x = 0: left and right joints change places."""

def read_motion(
    path: Path,
    *,
    amc_rate_hz: float = 120.0,
    unit_m: float | None = None,
    up: str = "y",
    asf: Path | None = None,
    allow_no_frames: bool = False,
) -> tuple[Motion, list[str]]:
    """The file's motion on its own skeleton, and warnings. Raises FormatError.

    unit_m: metres a unit of the file (None: what an .asf says, 0.01 for .bvh); up: the file's up
    axis, what is read has y up; asf: the skeleton of an .amc (None: the one found beside it). With
    allow_no_frames a skeleton alone, also an .asf, is a motion without frames.
    """

def write_bvh(path: Path, motion: Motion) -> None:
    """Writes atomically, in centimetres."""

def write_acclaim(path: Path, motion: Motion) -> None:
    """Writes path (.amc) and the skeleton beside it (.asf), each atomically, in inches / 0.45.

    Offsets of joints become fixed bones. Raises FormatError for what Acclaim cannot hold.
    """

class HumanoidMapping:
    """How a foreign skeleton carries the standard one of 21 joints."""

    @property
    def joints(self) -> dict[str, str]:
        """The skeleton's joint for each standard one that it has."""
    @property
    def is_by_names(self) -> bool:
        """False where limbs were recognised by their shape."""
    @property
    def unit_scale(self) -> float:
        """The file's lengths times this are metres."""
    @property
    def R_world_file(self) -> Floats:
        """(3, 3) turns the file's world into one with y up."""
    @property
    def warnings(self) -> list[str]: ...
    def to_standard(
        self, motion: Motion, skeleton: Skeleton | None = None
    ) -> tuple[Motion, list[str]]:
        """The motion on a standard skeleton (of its own proportions when None), and warnings."""
    def limb_errors_rad(self, motion: Motion, standard: Motion) -> dict[str, tuple[float, float]]:
        """Mean and worst angle between each limb of a motion and of what to_standard made of it."""

def map_humanoid(motion: Motion, by_hand: dict[str, str] = ...) -> HumanoidMapping:
    """Finds the body in a motion's skeleton and matches the rest poses.

    by_hand: the skeleton's joint for some standard ones; the others are found by their names, then
    by their shape. Raises MappingError.
    """

def standard_motion(
    motion: Motion, skeleton: Skeleton | None = None, by_hand: dict[str, str] = ...
) -> tuple[Motion, list[str]]:
    """map_humanoid and to_standard in one. Raises MappingError."""

def standard_joint_names() -> list[str]: ...
def read_mapping(path: Path) -> dict[str, str]:
    """A mapping by hand, from standard joints to a skeleton's. Raises FormatError."""

def write_mapping(path: Path, joints: dict[str, str]) -> None:
    """Writes a mapping by hand atomically."""

def remembered_mapping(folder: Path, skeleton: Skeleton) -> dict[str, str]:
    """The mapping by hand that a folder keeps for a skeleton, empty when there is none."""

def remembered_mapping_path(folder: Path, skeleton: Skeleton) -> str | os.PathLike[str]:
    """Where the folder keeps it."""
