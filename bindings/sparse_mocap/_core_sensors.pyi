# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: what sensors read."""

from collections.abc import Sequence

from numpy.typing import ArrayLike

from ._core_motion import Motion
from ._core_types import Floats

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
