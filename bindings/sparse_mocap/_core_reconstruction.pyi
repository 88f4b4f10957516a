# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: the methods."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._core_database import MotionDatabase
from ._core_motion import Motion
from ._core_types import Floats, ProgressCallback

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
    root_position: Floats
    yaw_rad: float
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
    database_frame: int

class Reconstruction:
    """A solved take: the stacked estimates (T first) and the motion."""

    motion: Motion
    angles: Floats
    positions: Floats
    contacts: Floats
    spread_m: Floats
    sensor_misfit_mps2: Floats
    clips: NDArray[np.int64]
    database_frames: NDArray[np.int64]

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
        quantities: Sequence[str] | None = None,
        excluded_clips: Sequence[int] = (),
    ) -> None:
        """quantities: of each entry of sites "specific_force" or "up", a unit vector's readings."""
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
