# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core. Shapes: T frames, J joints, S sensors. SI units, quaternions w x y z.

Long calls release the GIL. ``progress(done, total, what)`` is called with the GIL held and cancels
the call by returning False (the call then raises Cancelled and leaves nothing behind).
"""

import os
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Path = str | os.PathLike[str]
ProgressCallback = Callable[[int, int, str], bool | None]
Floats = NDArray[np.float64]

__version__: str
GRAVITY_MPS2: float

class FormatError(ValueError):
    """The input is at fault; str() is one line: where, what, what to do."""

    path: str
    line: int
    column: int

class ConfigError(ValueError):
    """A setting is outside what it may be; str() names it, its value and its range."""

class MappingError(ValueError):
    """A skeleton is not recognised as a human body; str() says why."""

class Cancelled(Exception):
    """The progress callback asked to stop."""

class Skeleton:
    """A joint tree: pivot = end_parent + R_parent offset, end = pivot + R_joint bone."""

    @property
    def names(self) -> list[str]: ...
    @property
    def parents(self) -> list[int]: ...
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
    ) -> None: ...
    @property
    def skeleton(self) -> Skeleton: ...
    @property
    def frame_time_s(self) -> float: ...
    @property
    def num_frames(self) -> int: ...
    @property
    def root_positions(self) -> Floats:
        """(T, 3) m, world, pivot of the root."""
    @property
    def rotations(self) -> Floats:
        """(T, J, 4) rotation of each joint relative to its parent, w x y z."""
    def joint_positions(self, frame: str = "world") -> Floats:
        """(T, J, 3) m, the joints' ends; frame: 'heading' (standard skeleton), 'root', 'world'."""
    def pivot_positions(self) -> Floats:
        """(T, J, 3) m, world, what the joints turn about."""
    def resampled(self, rate_hz: float) -> Motion: ...
    def trimmed(self, begin: int, end: int) -> Motion: ...
    def reversed(self) -> Motion: ...
    def mirrored(self) -> Motion: ...

def read_motion(path: Path, *, amc_rate_hz: float = 120.0) -> tuple[Motion, list[str]]:
    """The file's motion on its own skeleton, and warnings. Raises FormatError."""

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

def site_names() -> list[str]: ...
def simulate(
    motion: Motion,
    sites: Sequence[str],
    rate_hz: float,
    places: Sequence[float] | None = None,
) -> dict[str, Floats]:
    """What ideal sensors on a standard-skeleton motion read.

    ``time_s`` (T,), ``specific_force`` and ``angular_velocity`` (S, T, 3), ``orientation``
    (S, T, 4, R_world_sensor). places: along the carrying bone, 1 (default) at its distal end.
    """

def filtered_at(times_s: ArrayLike, values: ArrayLike, wanted_s: ArrayLike) -> Floats:
    """(len(wanted), C): values (T, C) through the database's reading filter, sampled anew."""

FILTER_REACH_S: float

class Clip:
    name: str
    actor: str
    motion_class: str
    source: str
    source_hash: str
    is_mirrored: bool
    is_reversed: bool
    tempo: float
    begin: int
    end: int

class MotionDatabase:
    """An opened .smdb, read-only and thread-safe."""

    def __init__(self, path: Path) -> None: ...
    @property
    def path(self) -> str: ...
    @property
    def num_frames(self) -> int: ...
    @property
    def rate_hz(self) -> float: ...
    @property
    def skeleton(self) -> Skeleton: ...
    @property
    def clips(self) -> list[Clip]: ...
    @property
    def site_names(self) -> list[str]: ...
    @property
    def build_info(self) -> str:
        """JSON: options and counts of the build."""
    def array(self, name: str) -> NDArray[np.float32]:
        """A read-only view of the rows.

        Names: angles, positions, root_motion, contacts, specific_force_pivot, specific_force_end,
        angular_velocity, up.
        """
    def clip_motion(self, index: int) -> Motion:
        """The clip as a motion on the standard skeleton, starting at the origin."""

def find_motion_files(sources: Sequence[Path], exclude: Sequence[str] = ()) -> list[Path]:
    """The motion files that the sources are or hold, without those excluded, sorted.

    Raises FormatError when a source does not exist or nothing is left.
    """

class BuildReport:
    num_files: int
    num_clips: int
    num_frames: int
    skipped: list[tuple[str, str]]
    warnings: list[str]

def build_database(
    sources: Sequence[Path],
    output: Path,
    *,
    rate_hz: float = 25.0,
    mirror: bool = False,
    reverse: bool = False,
    tempo_copies: Sequence[float] = (0.8, 1.25),
    exclude: Sequence[str] = (),
    strict: bool = False,
    progress: ProgressCallback | None = None,
) -> BuildReport: ...

class PoseEstimate:
    """One reconstructed frame."""

    @property
    def angles(self) -> Floats:
        """(43,) rad, root without heading."""
    @property
    def positions(self) -> Floats:
        """(21, 3) m, heading frame."""
    @property
    def rotations(self) -> Floats:
        """(21, 4) joint rotations, w x y z, the root's in the world."""
    @property
    def root_position(self) -> Floats: ...
    @property
    def yaw_rad(self) -> float: ...
    @property
    def contacts(self) -> Floats:
        """(2,) probability that the left and right foot stand."""
    @property
    def spread_m(self) -> Floats:
        """(21,) how far the retrieved poses disagree about each joint."""
    @property
    def sensor_misfit_mps2(self) -> Floats:
        """(S,) how far the retrieved readings are from the measured ones."""
    @property
    def clip(self) -> int:
        """Index of the clip the estimate leans on most."""
    @property
    def database_frame(self) -> int: ...

class Reconstruction:
    """A solved take: the stacked estimates (T first) and the motion."""

    @property
    def motion(self) -> Motion: ...
    @property
    def angles(self) -> Floats: ...
    @property
    def positions(self) -> Floats: ...
    @property
    def contacts(self) -> Floats: ...
    @property
    def spread_m(self) -> Floats: ...
    @property
    def sensor_misfit_mps2(self) -> Floats: ...
    @property
    def clips(self) -> NDArray[np.int64]: ...
    @property
    def database_frames(self) -> NDArray[np.int64]: ...

def method_names() -> list[str]: ...
def preset_names(method: str) -> list[str]: ...

class Reconstructor:
    """One performance's reconstruction by one method; use it from one thread at a time."""

    def __init__(
        self,
        database: MotionDatabase,
        sites: Sequence[str],
        *,
        method: str = "tautges2011",
        preset: str = "default",
        places: Sequence[float] | None = None,
        excluded_clips: Sequence[int] = (),
    ) -> None: ...
    @property
    def latency_frames(self) -> int:
        """How many readings an estimate of step() lags behind."""
    def step(self, specific_force: ArrayLike) -> PoseEstimate | None:
        """Gives the estimate of latency_frames ago, None until there is one.

        Takes the next reading at the database's rate, (S, 3) m/s^2, NaN rows for silent sensors.
        """
    def flush(self) -> list[PoseEstimate]:
        """The estimates still owed when the performance ends."""
    def reset(self) -> None: ...
    def solve(
        self,
        specific_force: ArrayLike,
        *,
        offline: bool = False,
        progress: ProgressCallback | None = None,
    ) -> Reconstruction:
        """The whole take, readings (T, S, 3); offline may look at all of it for every frame."""

def playback_best_path(
    database: MotionDatabase,
    sites: Sequence[str],
    specific_force: ArrayLike,
    excluded_clips: Sequence[int] = (),
) -> NDArray[np.int64]:
    """Baseline: for each reading the database frame at the end of the best path."""

def nearest_windows(
    database: MotionDatabase,
    sites: Sequence[str],
    specific_force: ArrayLike,
    window: int = 10,
    excluded_clips: Sequence[int] = (),
) -> NDArray[np.int64]:
    """Baseline: for each reading the frame whose last `window` readings are nearest."""

def nearest_poses(
    database: MotionDatabase, positions: ArrayLike, excluded_clips: Sequence[int] = ()
) -> NDArray[np.int64]:
    """Oracle: for each pose (T, 21, 3; heading frame) the database frame that is nearest."""
