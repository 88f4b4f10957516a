# SPDX-License-Identifier: GPL-3.0-or-later
"""The gravity that devices state in g, or take out."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .. import GRAVITY_MPS2
from ..rotations import inverse, rotated

__all__ = ["with_gravity"]

Floats = NDArray[np.float64]

STANDARD_GRAVITY_MPS2 = 9.80665
"""The unit g of accelerometers."""


def with_gravity(rotation: Floats, free_acceleration: Floats) -> Floats:
    """Returns specific force (T, 3) in sensor axes.

    Of rotations (T, 4) into a world with z up and accelerations without gravity in that world.
    """
    force_world = free_acceleration + np.array([0.0, 0.0, GRAVITY_MPS2])
    return np.asarray(rotated(inverse(rotation), force_world))
