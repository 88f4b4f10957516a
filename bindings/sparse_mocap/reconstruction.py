# SPDX-License-Identifier: GPL-3.0-or-later
"""From what sensors measured to full-body motion: whole takes, and live."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _core
from ._core import (
    Model,
    MotionDatabase,
    PoseEstimate,
    Reconstruction,
    SensorInput,
    Skeleton,
    site_names,
)
from .calibration import Calibration, sensor_inputs
from .methods import option_values
from .readings import channels_in, push_samples
from .take import Take, devices_of

if TYPE_CHECKING:
    from .capture.sample_log import Samples

Progress = Callable[[int, int, str], bool | None]

__all__ = [
    "LiveReconstructor",
    "reconstruct",
    "sensor_recordings",
    "used_sensors",
    "with_locations",
]


def reconstruct(
    take: Take,
    database: MotionDatabase | str | os.PathLike[str] | None = None,
    *,
    best_quality: bool = False,
    method: str | None = None,
    preset: str | None = None,
    options: Mapping[str, Any] | None = None,
    calibration: Calibration | None = None,
    positions_along_bone: Mapping[str, float] | None = None,
    use_gyroscopes: bool = True,
    model: Model | None = None,
    body: Skeleton | None = None,
    excluded_clips: Sequence[int] = (),
    tracker_yaw_rad: float = 0.0,
    tracker_origin_m: Sequence[float] = (0.0, 0.0, 0.0),
    progress: Progress | None = None,
) -> Reconstruction:
    """Returns the motion of a take, with what the method says about it.

    best_quality: every pose may depend on the whole take; otherwise poses are as they would be
    live. method, preset and options are those that ``methods()`` lists; None is the default.
    calibration says how the take's sensors are worn, without one they sit as their names say, at
    the ends of their bones; positions_along_bone (by site, 0 to 1) win over it. model and body are
    for methods that need one; a body wins over the calibration's. Clips in excluded_clips
    (indices) are treated as if the database did not have them. Without use_gyroscopes sensors are
    used as accelerometers alone, but for trackers with a position. tracker_* say where the world of
    orientations and positions stands: yaw about the vertical (rad) and origin (m).
    progress(done, total, what) cancels by returning False.

    Raises ConfigError in one line for what does not fit together, CalibrationError for a sensor
    without a calibration, and Cancelled.
    """
    request = _request(
        database,
        method=method,
        preset=preset,
        options=options,
        model=model,
        body=_body(body, calibration),
        excluded_clips=excluded_clips,
        tracker_yaw_rad=tracker_yaw_rad,
        tracker_origin_m=tracker_origin_m,
    )
    take = with_locations(take, calibration)
    inputs = used_sensors(take, calibration, positions_along_bone, use_gyroscopes)
    return _core.reconstruct(
        sensor_recordings(take), inputs, request, best_quality=best_quality, progress=progress
    )


class LiveReconstructor:
    """Reconstructs a performance as its samples come; use it from one thread."""

    def __init__(
        self,
        sensors: Mapping[int, str],
        channels: Sequence[Sequence[str]],
        database: MotionDatabase | str | os.PathLike[str] | None = None,
        *,
        method: str | None = None,
        preset: str | None = None,
        options: Mapping[str, Any] | None = None,
        calibration: Calibration | None = None,
        devices: Mapping[int, str] | None = None,
        use_gyroscopes: bool = True,
        model: Model | None = None,
        body: Skeleton | None = None,
        tracker_yaw_rad: float = 0.0,
        tracker_origin_m: Sequence[float] = (0.0, 0.0, 0.0),
        largest_backlog: int = 0,
    ) -> None:
        """Takes the capture's numbers of the sensors and their names, and what each measures.

        Without a calibration the names are sites; in one, sensors are found by the identities in
        devices, by the same numbers. channels (of CHANNEL_NAMES) come in the order of
        sensors. largest_backlog: of more readings than this that wait only the newest is used, so
        that a slow machine stays in time; 0: all are. The rest is as in reconstruct(). Raises
        ConfigError and CalibrationError.
        """
        request = _request(
            database,
            method=method,
            preset=preset,
            options=options,
            model=model,
            body=body,
            tracker_yaw_rad=tracker_yaw_rad,
            tracker_origin_m=tracker_origin_m,
        )
        used = [_used(measured, use_gyroscopes) for measured in channels]
        names = list(sensors.values())
        identities = {sensors[number]: own for number, own in (devices or {}).items()}
        inputs = sensor_inputs(calibration, names, used, devices=identities)
        self._numbers = list(sensors)
        self.sensors: tuple[SensorInput, ...] = tuple(inputs)
        """Where the sensors are worn and how they are corrected, in the order of the numbers."""
        self._live = _core.LiveReconstructor(inputs, request, largest_backlog=largest_backlog)

    def push(self, samples: Samples) -> None:
        """Takes samples as the sample log has them."""
        push_samples(self._live.readings, self._numbers, samples)

    def advance(self, now_s: float) -> list[PoseEstimate]:
        """Returns the poses that can be had by now, on the machine's monotonic clock."""
        return list(self._live.advance(now_s))

    def flush(self) -> list[PoseEstimate]:
        """Returns the remaining poses, when the performance ends."""
        return list(self._live.flush())

    @property
    def skeleton(self) -> Skeleton:
        """The skeleton of the poses."""
        return self._live.skeleton

    @property
    def rate_hz(self) -> float:
        """Poses a second."""
        return self._live.rate_hz

    @property
    def latency_s(self) -> float:
        """How long after its reading a pose is ready."""
        return self._live.latency_s

    @property
    def last_reading_s(self) -> float:
        """When the last reading was that any sensor was in, on the machine's monotonic clock.

        Minus infinity before there is one. While it stays behind, poses are guesses.
        """
        return self._live.last_reading_s

    @property
    def notes(self) -> list[str]:
        """What the method says of the performance so far, a line each."""
        return list(self._live.notes)

    @property
    def num_skipped(self) -> int:
        """Readings that came faster than poses could be made of them."""
        return self._live.num_skipped


def _body(body: Skeleton | None, calibration: Calibration | None) -> Skeleton | None:
    if body is not None or calibration is None or calibration.body is None:
        return body
    return calibration.body.skeleton


def with_locations(take: Take, calibration: Calibration | None) -> Take:
    """Returns the take without sensors that were recorded under their identities alone.

    Nobody said where these are worn. Raises ConfigError when no other is left.
    """
    devices = devices_of(take)
    known = {*site_names(), *(calibration.sensors if calibration else ())}
    calibrated = {s.device for s in calibration.sensors.values()} if calibration else set()
    sensors = {
        name: record
        for name, record in take.sensors.items()
        if name in known or name not in devices or devices[name] in calibrated
    }
    if not sensors:
        first = next(iter(take.sensors))
        raise _core.ConfigError(
            f"the take does not say where its sensors are worn: {', '.join(take.sensors)}; give it "
            f"with `sparse-mocap import TAKE.csv -o NAMED.csv --site '{first}=left_wrist'`"
        )
    return Take(sensors, take.comments)


def _request(
    database: MotionDatabase | str | os.PathLike[str] | None,
    *,
    method: str | None,
    preset: str | None,
    options: Mapping[str, Any] | None,
    **rest: Any,
) -> _core.ReconstructionRequest:
    if database is not None and not isinstance(database, MotionDatabase):
        database = MotionDatabase(database)
    rest["excluded_clips"] = list(rest.get("excluded_clips", ()))
    return _core.ReconstructionRequest(
        method=method or "",
        preset=preset or "",
        options=option_values(options or {}),
        database=database,
        **rest,
    )


def used_sensors(
    take: Take,
    calibration: Calibration | None,
    positions_along_bone: Mapping[str, float] | None,
    use_gyroscopes: bool,
) -> list[SensorInput]:
    """Returns a take's sensors with the channels that each has, as reconstruct() uses them."""
    channels = [_used(channels_in(record), use_gyroscopes) for record in take.sensors.values()]
    return sensor_inputs(calibration, take.sites, channels, positions_along_bone, devices_of(take))


def sensor_recordings(take: Take) -> list[_core.SensorRecording]:
    """Returns a take's records as the core takes them, in their order."""
    return [
        _core.SensorRecording(
            record.times_s,
            record.specific_force,
            record.angular_velocity,
            record.position,
            record.orientation,
        )
        for record in take.sensors.values()
    ]


def _used(channels: Sequence[str], use_gyroscopes: bool) -> list[str]:
    """Without gyroscopes there is no orientation either, but for trackers with a position."""
    if use_gyroscopes:
        return list(channels)
    theirs = {"angular_velocity", "gravity_direction"}
    if "specific_force" in channels and "position" not in channels:
        theirs.add("orientation")
    return [name for name in channels if name not in theirs]
