# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: what sensors read."""

from collections.abc import Sequence

from numpy.typing import ArrayLike

from ._core_motion import Motion
from ._core_types import Floats

def site_names() -> list[str]:
    """Returns all sensor locations, such as left_wrist, in the order of a database's arrays."""

def simulate(
    motion: Motion,
    sites: Sequence[str],
    rate_hz: float,
    positions_along_bone: Sequence[float] | None = None,
) -> dict[str, Floats]:
    """Returns what ideal sensors read during a motion of the standard skeleton.

    ``time_s`` (T,); ``specific_force`` (S, T, 3) m/s^2 and ``angular_velocity`` (S, T, 3) rad/s,
    both in the sensor's axes; ``position`` (S, T, 3) m, world; ``orientation`` (S, T, 4)
    R_world_sensor, w x y z. See Tautges et al. 2011, section 3.

    positions_along_bone has a number for each site, from 0 at the joint near the body to 1, the
    default, at the bone's far end. Raises ConfigError for an unknown site, and ValueError for a
    motion of fewer than 3 frames, a rate that is not positive or another number of positions.
    """

def filtered_at(times_s: ArrayLike, values: ArrayLike, wanted_s: ArrayLike) -> Floats:
    """Returns values (T, C) at times (T,) low-passed and sampled at wanted_s (N,), as (N, C).

    The filter is the Gaussian one, -3 dB at 11.5 Hz, that a database's readings passed; times_s
    ascend, evenly or not. Raises ValueError when they are empty.
    """

FILTER_REACH_S: float
"""How far from a wanted time filtered_at uses samples, in s, to both sides."""
