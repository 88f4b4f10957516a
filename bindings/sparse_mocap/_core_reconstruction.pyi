# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: the methods, and reconstructions by them."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._core_database import MotionDatabase
from ._core_model import Model
from ._core_motion import Motion, Skeleton
from ._core_readings import Readings, ReadingStream, SensorInput
from ._core_types import Floats, ProgressCallback

def method_infos() -> list[dict[str, Any]]:
    """What is known of each method, the default first, as JSON has it."""

class ReconstructionRequest:
    """How a performance is to be reconstructed."""

    def __init__(
        self,
        *,
        method: str = "",
        preset: str = "",
        options: Mapping[str, str] = {},
        database: MotionDatabase | None = None,
        model: Model | None = None,
        body: Skeleton | None = None,
        excluded_clips: Sequence[int] = (),
        tracker_yaw_rad: float = 0.0,
        tracker_origin_m: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> None: ...

class SensorRecording:
    """What one sensor measured in a performance."""

    def __init__(
        self,
        times_s: ArrayLike,
        specific_force: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        position: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
    ) -> None: ...

class PoseEstimate:
    """One reconstructed frame."""

    @property
    def time_s(self) -> float:
        """When the sensors read it."""
    @property
    def rotations(self) -> Floats:
        """(J, 4) w x y z: each joint relative to its parent, the root in the world."""
    @property
    def root_position(self) -> Floats:
        """(3,) m, world."""
    @property
    def positions(self) -> Floats:
        """(J, 3) m: the joints in the heading frame."""
    @property
    def contacts(self) -> Floats:
        """(2,) probability that the left and the right foot stand."""
    @property
    def diagnostics(self) -> dict[str, Floats]:
        """What the method says of the frame: name to array, units in the names."""

class Reconstruction:
    """A reconstructed take: T frames, J joints."""

    @property
    def motion(self) -> Motion:
        """The motion in the world, on the method's skeleton."""
    @property
    def readings(self) -> Readings:
        """What the method was given, at its rate."""
    @property
    def rate_hz(self) -> float:
        """Frames a second."""
    @property
    def latency_s(self) -> float | None:
        """How long after its reading a live pose is ready; None for best quality."""
    @property
    def contacts(self) -> Floats:
        """(T, 2) probability that the left and the right foot stand."""
    @property
    def diagnostics(self) -> dict[str, Floats]:
        """What the method says of each frame: name to (T, N), units in the names."""

def reconstruct(
    take: Sequence[SensorRecording],
    sensors: Sequence[SensorInput],
    request: ReconstructionRequest,
    *,
    best_quality: bool = False,
    progress: ProgressCallback | None = None,
) -> Reconstruction:
    """A whole take. Raises ConfigError and Cancelled."""

class LiveReconstructor:
    """Sensors' samples to poses as they come; use it from one thread."""

    def __init__(
        self,
        sensors: Sequence[SensorInput],
        request: ReconstructionRequest,
        *,
        largest_backlog: int = 0,
    ) -> None: ...
    @property
    def readings(self) -> ReadingStream:
        """The stream that takes the sensors' samples."""
    def advance(self, now_s: float) -> list[PoseEstimate]:
        """The poses that can be had by now, on the clock of the samples."""
    def flush(self) -> list[PoseEstimate]:
        """The remaining poses, when the performance ends."""
    @property
    def skeleton(self) -> Skeleton:
        """The skeleton of the poses."""
    @property
    def rate_hz(self) -> float:
        """Poses a second."""
    @property
    def latency_s(self) -> float:
        """How long after its reading a pose is ready."""
    @property
    def history_s(self) -> float:
        """How far back the readings of a pose reach."""
    @property
    def num_skipped(self) -> int:
        """Readings that came faster than poses could be made of them."""

class TrainingClip:
    """One example that a model is trained from."""

    def __init__(
        self,
        name: str,
        motion: Motion,
        *,
        motion_class: str = "",
        readings: Readings | None = None,
    ) -> None: ...

def train(
    method: str,
    clips: Sequence[TrainingClip],
    *,
    preset: str = "",
    options: Mapping[str, str] = {},
    progress: ProgressCallback | None = None,
) -> Model:
    """What a method learns from clips. Raises ConfigError and Cancelled."""

def playback_best_path(
    database: MotionDatabase, take: Readings, excluded_clips: Sequence[int] = ()
) -> NDArray[np.int64]:
    """Baseline: for each reading the database frame at the end of the best path."""

def nearest_windows(
    database: MotionDatabase, take: Readings, window: int = 10, excluded_clips: Sequence[int] = ()
) -> NDArray[np.int64]:
    """Baseline: for each reading the frame whose last `window` readings are nearest."""

def nearest_poses(
    database: MotionDatabase, positions: ArrayLike, excluded_clips: Sequence[int] = ()
) -> NDArray[np.int64]:
    """Oracle: for each pose (T, 21, 3; heading frame) the database frame that is nearest."""
