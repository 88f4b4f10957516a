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
    """Returns the methods' descriptions, the default first, as values that JSON can hold.

    sparse_mocap.method_info() returns one of them as a MethodInfo.
    """

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
    ) -> None:
        """An empty method or preset means the default; options map names to values as text.

        database, model and body (a standard skeleton) are given where the method needs them.
        excluded_clips are indices of database clips that are not used. tracker_* as in
        ReadingStream. Raises ValueError unless tracker_origin_m has three numbers.
        """

class SensorRecording:
    """T samples of one sensor."""

    def __init__(
        self,
        times_s: ArrayLike,
        specific_force: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        position: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
    ) -> None:
        """times_s (T,) ascend and are on the clock that all sensors share.

        specific_force (T, 3), in m/s^2 once calibrated, and angular_velocity (T, 3) rad/s are in
        the sensor's axes; position (T, 3) m and orientation (T, 4) R_world_sensor, w x y z, in the
        tracker's world. None and NaN: not measured. Raises ValueError for other shapes.
        """

class PoseEstimate:
    """One reconstructed frame."""

    @property
    def time_s(self) -> float:
        """When the sensors measured it, in s on the clock of the samples."""
    @property
    def rotations(self) -> Floats:
        """(J, 4) w x y z: each joint relative to its parent, the root in the world."""
    @property
    def root_position(self) -> Floats:
        """(3,) m, world, pivot of the root."""
    @property
    def positions(self) -> Floats:
        """(J, 3) m, the joints' ends in the heading frame."""
    @property
    def contacts(self) -> Floats:
        """(2,) probability that the left and the right foot are on the ground."""
    @property
    def diagnostics(self) -> dict[str, Floats]:
        """Further results of the method: name to array, units in the names."""

class Reconstruction:
    """A reconstructed take: T frames, J joints."""

    @property
    def motion(self) -> Motion:
        """The motion in the world, on the method's skeleton."""
    @property
    def readings(self) -> Readings:
        """The T readings that the method used."""
    @property
    def rate_hz(self) -> float:
        """Frames a second."""
    @property
    def latency_s(self) -> float | None:
        """How long after its reading a live pose is ready, in s; None for best quality."""
    @property
    def notes(self) -> list[str]:
        """What the method says of the take, a line each."""
    @property
    def alternatives(self) -> list[Reconstruction]:
        """What else the take may have been, the likeliest first, each a whole result.

        In best quality, where the method has an option of that name and it is set.
        """
    @property
    def differences(self) -> list[tuple[float, float, float]]:
        """Where an alternative differs from the result that has it.

        (begin, end, distance): s from the take's beginning, and how far the joints are apart, m,
        mean over the joints and the part, heading frame. Empty for the first result.
        """
    @property
    def contacts(self) -> Floats:
        """(T, 2) probability that the left and the right foot are on the ground."""
    @property
    def diagnostics(self) -> dict[str, Floats]:
        """Further results of the method: name to (T, N), units in the names; NaN where absent."""

def reconstruct(
    take: Sequence[SensorRecording],
    sensors: Sequence[SensorInput],
    request: ReconstructionRequest,
    *,
    best_quality: bool = False,
    progress: ProgressCallback | None = None,
) -> Reconstruction:
    """Returns the motion of a whole take: a recording and an input for each sensor.

    best_quality uses the whole take for each pose; otherwise poses are those of a live preview.
    Raises ConfigError for what the method cannot use, Cancelled, and ValueError unless there are
    as many recordings as sensors.
    """

class LiveReconstructor:
    """Turns sensors' samples into poses as they arrive; use it from one thread."""

    def __init__(
        self,
        sensors: Sequence[SensorInput],
        request: ReconstructionRequest,
        *,
        largest_backlog: int = 0,
    ) -> None:
        """largest_backlog: when more readings wait, all but the newest are skipped; 0: never.

        After a skip the method starts again without a past. Raises ConfigError for what the method
        cannot use.
        """
    @property
    def readings(self) -> ReadingStream:
        """The stream to push the sensors' samples into."""
    def advance(self, now_s: float) -> list[PoseEstimate]:
        """Returns the next poses that are ready at now_s, on the clock of the samples."""
    def flush(self) -> list[PoseEstimate]:
        """Returns the remaining poses when the performance has ended."""
    @property
    def skeleton(self) -> Skeleton:
        """The skeleton of the poses."""
    @property
    def rate_hz(self) -> float:
        """Poses a second."""
    @property
    def latency_s(self) -> float:
        """How long after its reading a pose is ready, in s."""
    @property
    def history_s(self) -> float:
        """How far back the readings reach that a pose depends on, in s."""
    @property
    def last_reading_s(self) -> float:
        """When the last reading was that any sensor was in, in s; -inf before there is one."""
    @property
    def notes(self) -> list[str]:
        """What the method says of the performance so far, a line each."""
    @property
    def num_skipped(self) -> int:
        """How many readings were skipped because they came faster than poses could be computed."""

class TrainingClip:
    """One example that a model is trained from."""

    def __init__(
        self,
        name: str,
        motion: Motion,
        *,
        motion_class: str = "",
        readings: Readings | None = None,
        segments: Sequence[tuple[float, str]] = (),
    ) -> None:
        """Takes a motion on a standard skeleton, feet and hands or not; an empty class is unknown.

        readings were recorded with the motion, at its rate; None: they are simulated. segments are
        times (s) and labels as clip_segments() returns them; none: the method finds them.
        """
    motion_class: str
    """Empty: unknown."""
    segments: list[tuple[float, str]]
    """As clip_segments() returns them."""
    @property
    def name(self) -> str:
        """Of messages."""
    @property
    def motion(self) -> Motion:
        """On a standard skeleton."""

def train(
    method: str,
    clips: Sequence[TrainingClip],
    *,
    preset: str = "",
    options: Mapping[str, str] = {},
    progress: ProgressCallback | None = None,
) -> Model:
    """Returns the model that a method learns from clips.

    Raises ConfigError for a method that learns nothing and for what it cannot use, and Cancelled.
    """

def clip_segments(
    method: str,
    clip: TrainingClip,
    *,
    preset: str = "",
    options: Mapping[str, str] = {},
) -> list[tuple[float, str]]:
    """Returns the parts that training divides a clip into: when each begins (s), its label.

    Raises ConfigError for a method that divides none, and for a clip that it cannot use.
    """

def playback_best_path(
    database: MotionDatabase, take: Readings, excluded_clips: Sequence[int] = ()
) -> NDArray[np.int64]:
    """Returns for each of T readings the database frame at the end of the best path, (T,).

    A baseline that plays back the database: the paths are those of the online lazy neighbourhood
    graph. excluded_clips, by index, and copies at other tempos are not used.
    """

def nearest_windows(
    database: MotionDatabase,
    take: Readings,
    window: int = 10,
    excluded_clips: Sequence[int] = (),
) -> NDArray[np.int64]:
    """Returns for each of T readings the database frame whose past readings are nearest, (T,).

    A baseline after an idea of Slyper and Hodgins 2008; compares the last `window` readings.
    excluded_clips, by index, and copies at other tempos are not used.
    """

def nearest_poses(
    database: MotionDatabase, positions: ArrayLike, excluded_clips: Sequence[int] = ()
) -> NDArray[np.int64]:
    """Returns for each pose the database frame whose pose is nearest, (T,).

    positions (T, 21, 3) m are in the heading frame. No retrieval from the database can be closer.
    excluded_clips, by index, and copies at other tempos are not used.
    """

def graph_times(
    database: MotionDatabase, take: Readings, window: int, excluded_clips: Sequence[int] = ()
) -> tuple[float, float, float]:
    """Returns what paths cost a reading: s online, s when made anew, and how often they agree.

    The online lazy neighbourhood graph of Tautges et al. 2011 beside one that is made anew for each
    reading from the last `window` of them; processor time of the process in the graphs alone. The
    last figure is the share of readings with the same end of the best path.
    """
