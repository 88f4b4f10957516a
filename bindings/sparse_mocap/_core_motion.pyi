# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: skeletons, motions and their files."""

from collections.abc import Callable, Mapping
from pathlib import Path as _Path

from numpy.typing import ArrayLike

from ._core_types import Floats, Path

class Skeleton:
    """A joint tree: pivot = end_parent + R_parent offset, end = pivot + R_joint bone."""

    def __init__(
        self, names: list[str], parents: list[int], pivots: ArrayLike, ends: ArrayLike
    ) -> None:
        """Pivots and ends (J, 3) m: where the joints turn and end in rest pose, in the world.

        parents (J,) are smaller than their joint's own index, -1 for the first. Raises ValueError
        when they are not, or a name is repeated.
        """
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
    def angles(self, rotations: ArrayLike, reference: ArrayLike | None = None) -> Floats:
        """Returns the angles (T, A) rad that turn the joints by rotations (T, J, 4) w x y z.

        Of angles that mean the same rotation these are the nearest to reference (T, A), by default
        0. Raises ValueError for other shapes.
        """

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
    def without_extremities(self) -> Motion:
        """The motion of the 21 standard joints alone; one of another skeleton as it is."""
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

class ReadOptions:
    """What motion files do not say of themselves.

    amc_rate_hz: frames per second of .amc files; unit_m: metres a unit of the file (None: what an
    .asf says, 0.01 for .bvh); up: the file's up axis, what is read has y up; asf: the skeleton of
    .amc files (None: the one found beside each); allow_no_frames: a skeleton alone, also an .asf,
    is a motion without frames; rate_hz: the rate whatever the file says; further_readers: functions
    that read files of other endings and return the motion and warnings.
    """

    def __init__(
        self,
        *,
        amc_rate_hz: float = 120.0,
        unit_m: float | None = None,
        up: str = "y",
        asf: Path | None = None,
        allow_no_frames: bool = False,
        rate_hz: float | None = None,
        further_readers: Mapping[str, Callable[[_Path], tuple[Motion, list[str]]]] = ...,
    ) -> None:
        """Raises ConfigError naming what is out of its range."""

def read_motion(path: Path, options: ReadOptions = ...) -> tuple[Motion, list[str]]:
    """The file's motion on its own skeleton, and warnings. Raises FormatError."""

def write_bvh(path: Path, motion: Motion) -> None:
    """Writes atomically, in centimetres."""

def write_acclaim(path: Path, motion: Motion) -> None:
    """Writes path (.amc) and the skeleton beside it (.asf), each atomically, in inches / 0.45.

    Offsets of joints become fixed bones. Raises FormatError for what Acclaim cannot hold.
    """
