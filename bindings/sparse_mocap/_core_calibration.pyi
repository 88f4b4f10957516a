# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: clocks, time lags, calibration."""

from collections.abc import Sequence
from typing import Any

from numpy.typing import ArrayLike

from ._core_model import Model
from ._core_motion import Skeleton
from ._core_types import Floats

class ClockModel:
    """Maps a device's clock to the host's monotonic clock; samples arrive late, never early.

    A delay that all samples share cannot be measured and stays in the offset.
    """

    def __init__(self, *, largest_drift_ppm: float = 500.0, window_s: float = 600.0) -> None:
        """Estimates a drift of at most largest_drift_ppm from the arrivals of the last window_s."""
    def observe(self, device_s: float, arrival_s: float) -> float:
        """Returns the host time of a sample or burst, s; never before the one returned last.

        device_s is the device's unwrapped time, arrival_s the host's when it was received. Raises
        ValueError for times that are not finite.
        """
    def host_time_s(self, device_s: float) -> float:
        """Returns the host time of a device time, s, as estimated from all arrivals so far."""
    @property
    def offset_s(self) -> float:
        """Host time at which the device's time is 0, s."""
    @property
    def drift_ppm(self) -> float:
        """How slow the device's clock is, in parts per million; negative when it is fast."""
    @property
    def mean_lateness_s(self) -> float:
        """How much later than estimated the arrivals of the window are on average, s."""
    @property
    def num_segments(self) -> int:
        """1 from the first sample on, and 1 more for each reset of the device's clock."""

def align_in_time(
    first_times_s: ArrayLike,
    first: ArrayLike,
    second_times_s: ArrayLike,
    second: ArrayLike,
    *,
    largest_lag_s: float = 1.0,
    window_s: float = 1.5,
) -> dict[str, Any]:
    """Returns the lag between the clocks of two sensors, from an event that both recorded.

    first and second are magnitudes, such as that of specific force, one for each of the ascending
    times. They are correlated in a window around the strongest common event, a clap or a jump.

    ``lag_s``: subtract it from the second sensor's times; ``correlation``: at this lag, -1 to 1;
    ``runner_up``: the best correlation at another lag; ``event_s``: the middle of the event on the
    first clock; ``is_found``: True when the event is clear and only one lag fits it.

    Raises ValueError when sizes differ or the recordings overlap by less than the window.
    """

def standing_pose_names() -> list[str]:
    """Returns the poses that a performer may stand in during a calibration."""

def guided_movements() -> dict[str, tuple[str, list[str]]]:
    """Returns each guided movement's instruction and the sites that it calibrates, by its name."""

def calibrate_sensor(
    site: str,
    pose: str,
    standing: tuple[Floats, Floats, Floats | None],
    movements: Sequence[tuple[str, tuple[Floats, Floats, Floats | None]]],
    height_m: float,
    default_position_along_bone: float | None,
    body: Skeleton | None = None,
) -> dict[str, Any]:
    """Returns one sensor's calibration: the fields of SensorCalibration but its site.

    standing and each named movement are a recording: times_s (T,), specific_force (T, 3) in m/s^2
    or g, angular_velocity (T, 3) in rad/s or None, in the sensor's axes. Bones are those of body,
    or of a medium body of that height. default_position_along_bone, 0 to 1, is used where the
    movements do not determine it; None: one that is usual for the site.

    Raises ConfigError for an unknown site, pose or movement, for a height or position out of range,
    and for a performer who does not stand still long enough.
    """

def calibration_poses() -> list[tuple[str, str, Floats]]:
    """Returns the poses of a calibration: name, instruction, rotations (21, 4) of the joints.

    Rotations of the standard skeleton's joints, w x y z, relative to the parent; facing +z.
    """

def calibrate_from_poses(
    sites: Sequence[str],
    poses: Sequence[tuple[str, ArrayLike, ArrayLike]],
    model: Model | None = None,
) -> dict[str, Any]:
    """Returns bones and mountings from held poses (Liu et al. 2011, section 4).

    poses: the name of each, where the S trackers were while it was held, (S, 3) m, and their
    rotations R_world_sensor (S, 3, 3), NaN where a tracker says nothing. model: bone lengths that
    liu2011 was trained on; None: published proportions.

    ``bones`` (21, 3) m, ``bone_deviation_m`` and ``is_bone_determined`` (20,) of all bones but the
    root's; ``sensors``: a dict each with R_site_sensor (3, 3), offset_m (3,) in the site's axes,
    their deviations and whether the poses determine them; ``missed_deg``: how far the limbs with
    sensors were from each shown pose, RMS; ``imitation_deg``: the deviation of each angle from
    them; ``yaw_rad`` of the performer's front in the trackers' world; ``are_poses_alike``.

    Raises ConfigError for an unknown site or pose, without sensors or poses, and when no tracker
    says anything in a pose; FormatError for a model without bone lengths.
    """
