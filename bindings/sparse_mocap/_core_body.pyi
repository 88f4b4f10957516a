# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: the bodies of performers."""

from numpy.typing import ArrayLike

from ._core_motion import Skeleton
from ._core_types import Floats

class Body:
    """The body of a performer: a standard skeleton of their proportions. Immutable."""

    def __init__(self, bones: ArrayLike, performer: str = "") -> None:
        """Takes bones as below. Raises ConfigError for lengths that nobody has."""
    performer: str
    @property
    def bones(self) -> Floats:
        """(21, 3) m, from pivot to end of each standard joint in rest pose."""
    @property
    def skeleton(self) -> Skeleton:
        """The standard skeleton with these bones."""
    @property
    def height_m(self) -> float:
        """How tall somebody with these bones stands, sole to crown."""

def body_of_height(height_m: float) -> Body:
    """A medium body scaled to a standing height. Raises ConfigError unless it is 0.5 to 2.5 m."""
