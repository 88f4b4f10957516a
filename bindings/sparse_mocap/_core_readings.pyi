# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: from samples to readings, and rotations. Absent values are NaN."""

from collections.abc import Sequence

from numpy.typing import ArrayLike

from ._core_types import Floats

CHANNEL_NAMES: tuple[str, ...]
"""specific_force, angular_velocity, gravity_direction, orientation, position."""
LARGEST_CLOCK_DRIFT: float
"""A device's clock that is off by a larger part does not show real time; quartz is within 1e-4."""

class SensorInput:
    """A sensor of a performance: its location, the channels to use and how to correct them."""

    def __init__(
        self,
        site: str,
        channels: Sequence[str] = ("specific_force",),
        *,
        position_along_bone: float = 1.0,
        scale: float = 1.0,
        R_site_sensor: ArrayLike | None = None,
        gyroscope_bias: ArrayLike | None = None,
        offset_m: ArrayLike | None = None,
    ) -> None:
        """Takes a site of site_names() and channels of CHANNEL_NAMES.

        position_along_bone is 0 at the joint near the body and 1 at the bone's far end. Specific
        forces times scale are m/s^2; R_site_sensor (3, 3) is applied after the scale;
        gyroscope_bias (3,) is in rad/s and the sensor's own axes; offset_m (3,) is where the sensor
        sits, seen from its site, in the site's axes. Raises ConfigError for an unknown site or
        channel.
        """
    @property
    def site(self) -> str:
        """The sensor location, one of site_names()."""
    @property
    def position_along_bone(self) -> float:
        """From 0 at the joint near the body to 1 at the bone's far end."""
    @property
    def channels(self) -> list[str]:
        """The channels to use, in the order of CHANNEL_NAMES."""
    def corrected(
        self,
        specific_force: ArrayLike,
        angular_velocity: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
    ) -> tuple[Floats, Floats | None, Floats | None]:
        """Returns the values that an ideal sensor would have measured, None for what is not given.

        specific_force (T, 3), in m/s^2 once scaled; angular_velocity (T, 3) rad/s; orientation
        (T, 4) R_world_sensor, w x y z. Given in the sensor's axes, returned in its site's.
        """

class Readings:
    """The values of S sensors at T times, in each sensor's axes unless said otherwise.

    An index or a slice selects times; len() is T.
    """

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
        """Takes arrays shaped like the properties below; a channel that is not given is NaN.

        A sensor has those channels that are finite at some time; positions_along_bone are 1 by
        default. Raises ConfigError for an unknown site and ValueError for other shapes.
        """
    def __len__(self) -> int: ...
    def __getitem__(self, index: int | slice) -> Readings: ...
    @property
    def times_s(self) -> Floats:
        """(T,) s, ascending."""
    @property
    def specific_force(self) -> Floats:
        """(T, S, 3) m/s^2, gravity included: 9.81 upwards at rest."""
    @property
    def angular_velocity(self) -> Floats:
        """(T, S, 3) rad/s."""
    @property
    def gravity_direction(self) -> Floats:
        """(T, S, 3) unit vectors against gravity, upwards."""
    @property
    def position(self) -> Floats:
        """(T, S, 3) m, world."""
    @property
    def orientation(self) -> Floats:
        """(T, S, 4) R_world_sensor, w x y z."""
    @property
    def sites(self) -> list[str]:
        """The S sensor locations."""
    @property
    def positions_along_bone(self) -> list[float]:
        """S positions, from 0 at the joint near the body to 1 at the bone's far end."""
    @property
    def channels(self) -> list[list[str]]:
        """The names of each sensor's channels, of CHANNEL_NAMES."""

class ReadingStream:
    """Turns sensors' samples into readings at a fixed rate, live and for whole takes.

    Samples are corrected, low-passed and resampled. Where a sensor sent nothing for longer than
    0.1 s, its readings are NaN.
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
        """gravity_average: "causal" averages over the past, "whole_take" over the whole take.

        With the latter flush() returns all readings. tracker_yaw_rad and tracker_origin_m (3,)
        place the tracker's world, of positions and orientations, in the performer's: a turn about
        the vertical, then a shift. Raises ValueError without sensors, for a sensor without
        channels, and for a rate that is not positive.
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
        """Takes N samples of one sensor by its index; returns how many it used.

        times_s (N,) are on the clock that all sensors share. specific_force and angular_velocity
        (N, 3) are in the sensor's axes and units, position (N, 3) m and orientation (N, 4)
        R_world_sensor in the tracker's world. Samples that are not finite or not after the sensor's
        last one are skipped.
        """
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
        """Takes N samples that arrived together, as push does; the shared clock is the host's.

        arrival_s (N,) is when they were received; device_time_s (N,) is the device's clock,
        unwrapped, or NaN for a device without one. Returns how many samples it used.
        """
    def ready(self, now_s: float) -> Readings:
        """Returns the next readings that are complete at now_s, on the clock of the samples.

        A late sensor is waited for 0.1 s; then the readings come without it.
        """
    def flush(self) -> Readings:
        """Returns all remaining readings, up to the last sample, when the performance has ended."""
    @property
    def delay_s(self) -> float:
        """How long after its time a reading is ready when no sensor is late, in s."""
    @property
    def rate_hz(self) -> float:
        """Readings a second."""

def channels_of(
    specific_force: ArrayLike,
    angular_velocity: ArrayLike | None = None,
    position: ArrayLike | None = None,
    orientation: ArrayLike | None = None,
) -> list[str]:
    """Returns which channels of CHANNEL_NAMES a recording of T samples has.

    A gyroscope that reads nothing but zeros does not count: devices without one may send them.
    """

def gravity_directions(
    times_s: ArrayLike,
    specific_force: ArrayLike,
    angular_velocity: ArrayLike,
    *,
    average: str = "causal",
) -> Floats:
    """Returns unit vectors against gravity, upwards, in a sensor's axes, (T, 3).

    specific_force (T, 3) m/s^2 and angular_velocity (T, 3) rad/s are in the sensor's axes; average
    is a gravity_average of ReadingStream. NaN in the first half second of the causal average, and
    everywhere when the gyroscope reads nothing but zeros. Inclination as in VQF (Laidig and Seel,
    Information Fusion 91, 2023).
    """

def spread_evenly(arrival_s: ArrayLike) -> Floats:
    """Returns ascending times (T,) of samples by their arrivals (T,), s.

    Samples that arrived at once are spread over the time before.
    """

def host_times(device_s: ArrayLike, arrival_s: ArrayLike) -> tuple[Floats, float]:
    """Returns when samples were taken, (T,) s on the host's clock, and its rate.

    The rate is host seconds per device second. device_s (T,) is unwrapped, or NaN for a device
    without a clock; then the arrivals are spread evenly. A rate further from 1 than
    LARGEST_CLOCK_DRIFT, such as that of an emulator that plays faster, is returned, but the times
    keep the device's seconds. Raises ValueError when sizes differ.
    """

R_WORLD_ZUP: tuple[float, float, float, float]
"""The rotation from a world with z up to this project's, with y up; w x y z."""

def rotation_product(left: ArrayLike, right: ArrayLike) -> Floats:
    """Returns left times right, (T, 4) each, w x y z: the rotation by right and then by left."""

def rotated(rotations: ArrayLike, vectors: ArrayLike) -> Floats:
    """Returns vectors (T, 3), each turned by its rotation (T, 4), w x y z."""

def rotations_from_matrices(matrices: ArrayLike) -> Floats:
    """Returns the unit quaternions (T, 4), w x y z, of rotation matrices (T, 3, 3)."""
