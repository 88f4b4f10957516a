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
    positions_along_bone: Sequence[float] | None = None,
) -> dict[str, Floats]:
    """What ideal sensors on a standard-skeleton motion read.

    ``time_s`` (T,), ``specific_force``, ``angular_velocity`` and ``position`` (S, T, 3; m, world),
    ``orientation`` (S, T, 4, R_world_sensor). positions_along_bone: 1, the default, at the distal
    end of the carrying bone.
    """

def filtered_at(times_s: ArrayLike, values: ArrayLike, wanted_s: ArrayLike) -> Floats:
    """(len(wanted), C): values (T, C) through the database's reading filter, sampled anew."""

FILTER_REACH_S: float
