# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: clocks, time lags, calibration."""

from collections.abc import Sequence
from typing import Any

from numpy.typing import ArrayLike

from ._core_motion import Skeleton
from ._core_types import Floats

class ClockModel:
    """Maps a device's clock to the host's; arrivals are only ever late."""

    def __init__(self, *, largest_drift_ppm: float = 500.0, window_s: float = 600.0) -> None: ...
    def observe(self, device_s: float, arrival_s: float) -> float:
        """Takes a sample's device and arrival times; gives its host time, never going back."""
    def host_time_s(self, device_s: float) -> float:
        """By all that is known now."""
    @property
    def offset_s(self) -> float: ...
    @property
    def drift_ppm(self) -> float: ...
    @property
    def mean_lateness_s(self) -> float: ...
    @property
    def num_segments(self) -> int:
        """1 + how often the device's clock was set anew."""

def align_in_time(
    first_times_s: ArrayLike,
    first: ArrayLike,
    second_times_s: ArrayLike,
    second: ArrayLike,
    *,
    largest_lag_s: float = 1.0,
    window_s: float = 1.5,
) -> dict[str, Any]:
    """The lag of the second signal: lag_s, correlation, runner_up, event_s, is_found."""

def standing_pose_names() -> list[str]: ...
def guided_movements() -> dict[str, tuple[str, list[str]]]:
    """Each movement's instruction and the sites that it calibrates."""

def calibrate_sensor(
    site: str,
    pose: str,
    standing: tuple[Floats, Floats, Floats | None],
    movements: Sequence[tuple[str, tuple[Floats, Floats, Floats | None]]],
    height_m: float,
    default_position_along_bone: float | None,
    body: Skeleton | None = None,
) -> dict[str, Any]:
    """One sensor's calibration; recordings are times_s, specific_force, angular_velocity."""
