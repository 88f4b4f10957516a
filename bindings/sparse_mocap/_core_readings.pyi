# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: from samples to readings, and rotations. Absent values are NaN."""

from collections.abc import Sequence

from numpy.typing import ArrayLike

from ._core_types import Floats

CHANNEL_NAMES: tuple[str, ...]
"""specific_force, angular_velocity, gravity_direction, orientation, position."""
LARGEST_CLOCK_DRIFT: float
"""Quartz drifts by 1e-4 at most; a device's clock that is off by more is not in real time."""

class SensorInput:
    """A sensor of a performance: where it is worn, what is wanted of it, how it is corrected."""

    def __init__(
        self,
        site: str,
        channels: Sequence[str] = ("specific_force",),
        *,
        position_along_bone: float = 1.0,
        scale: float = 1.0,
        R_site_sensor: ArrayLike | None = None,
        gyroscope_bias: ArrayLike | None = None,
    ) -> None:
        """Takes channels of CHANNEL_NAMES.

        Specific forces times scale are m/s^2; R_site_sensor (3, 3) is applied after the scale;
        gyroscope_bias (3,) is in rad/s and the sensor's own axes. Raises ConfigError for a site or
        channel that is not known.
        """
    @property
    def site(self) -> str: ...
    @property
    def position_along_bone(self) -> float: ...
    @property
    def channels(self) -> list[str]: ...
    def corrected(
        self,
        specific_force: ArrayLike,
        angular_velocity: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
    ) -> tuple[Floats, Floats | None, Floats | None]:
        """What an ideal sensor would have measured, (T, 3), (T, 3) and (T, 4)."""

class Readings:
    """What S sensors read at T times, in their own axes unless said otherwise."""

    def __init__(
        self,
        sites: Sequence[str],
        times_s: ArrayLike,
        *,
        specific_force: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        gravity_direction: ArrayLike | None = None,
        position: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
        positions_along_bone: Sequence[float] | None = None,
    ) -> None:
        """A sensor has the channels that are known of it at some time."""
    def __len__(self) -> int: ...
    def __getitem__(self, index: int | slice) -> Readings: ...
    @property
    def times_s(self) -> Floats:
        """(T,) s."""
    @property
    def specific_force(self) -> Floats:
        """(T, S, 3) m/s^2."""
    @property
    def angular_velocity(self) -> Floats:
        """(T, S, 3) rad/s."""
    @property
    def gravity_direction(self) -> Floats:
        """(T, S, 3) unit vectors against gravity."""
    @property
    def position(self) -> Floats:
        """(T, S, 3) m, world."""
    @property
    def orientation(self) -> Floats:
        """(T, S, 4) R_world_sensor."""
    @property
    def sites(self) -> list[str]: ...
    @property
    def positions_along_bone(self) -> list[float]: ...
    @property
    def channels(self) -> list[list[str]]:
        """A list of names for each sensor."""

class ReadingStream:
    """From sensors' samples to readings at a rate, live and for whole takes.

    Samples are corrected, low-passed and resampled; a sensor that is silent for longer than 0.1 s
    has no reading in between.
    """

    def __init__(
        self,
        sensors: Sequence[SensorInput],
        rate_hz: float,
        *,
        gravity_average: str = "causal",
        tracker_yaw_rad: float = 0.0,
        tracker_origin_m: ArrayLike | None = None,
    ) -> None:
        """Averages gravity over the past alone ("causal") or over the "whole_take".

        With the latter all readings come with flush(). tracker_*: where the world of positions and
        orientations stands in the performer's, turned about the vertical and then moved. Raises
        ValueError without sensors or channels, or when the rate is not positive.
        """
    def push(
        self,
        sensor: int,
        times_s: ArrayLike,
        specific_force: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        position: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
    ) -> int:
        """Takes samples of one sensor by their times on the common clock; gives how many."""
    def push_arrivals(
        self,
        sensor: int,
        arrival_s: ArrayLike,
        device_time_s: ArrayLike,
        specific_force: ArrayLike | None = None,
        angular_velocity: ArrayLike | None = None,
        position: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
    ) -> int:
        """Takes samples that arrived together; the common clock is that of the arrivals.

        device_time_s is unwrapped, and NaN for a device without a clock.
        """
    def ready(self, now_s: float) -> Readings:
        """The readings that can be had by now.

        A sensor that is late is waited for a tenth of a second; then the others go on without it.
        """
    def flush(self) -> Readings:
        """All further readings up to the last sample: the performance has ended."""
    @property
    def delay_s(self) -> float:
        """How long after its time a reading can be had, when no sensor is late."""
    @property
    def rate_hz(self) -> float: ...

def channels_of(
    specific_force: ArrayLike,
    angular_velocity: ArrayLike | None = None,
    position: ArrayLike | None = None,
    orientation: ArrayLike | None = None,
) -> list[str]:
    """What a recording tells; a gyroscope that never turned tells nothing."""

def gravity_directions(
    times_s: ArrayLike,
    specific_force: ArrayLike,
    angular_velocity: ArrayLike,
    *,
    average: str = "causal",
) -> Floats:
    """Unit vectors against gravity in a sensor's axes, (T, 3); average as in ReadingStream.

    NaN in the first half second of the causal average, and everywhere when the gyroscope never
    turned.
    """

def spread_evenly(arrival_s: ArrayLike) -> Floats:
    """Times that ascend: samples that arrived at once are spread over the time before."""

def host_times(device_s: ArrayLike, arrival_s: ArrayLike) -> tuple[Floats, float]:
    """When samples were taken, in s of the machine's clock, and its seconds to one of the device's.

    A rate that is not real (an emulator that plays faster) is returned, but the device's own
    seconds are kept.
    """

R_WORLD_ZUP: tuple[float, float, float, float]
"""The rotation of a world with z up in this project's."""

def rotation_product(left: ArrayLike, right: ArrayLike) -> Floats:
    """Left times right, (T, 4)."""

def rotated(rotations: ArrayLike, vectors: ArrayLike) -> Floats:
    """The vectors (T, 3), each by its rotation (T, 4)."""

def rotations_from_matrices(matrices: ArrayLike) -> Floats:
    """Rotations (T, 4) of matrices (T, 3, 3)."""
