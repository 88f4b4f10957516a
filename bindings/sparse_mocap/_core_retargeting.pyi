# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: motions of other skeletons on the standard one, and back."""

import os

from ._core_motion import Motion, Skeleton
from ._core_types import Floats, Path

class SkeletonMapping:
    """How a rig and the standard skeleton of 21 joints correspond, for both directions.

    A rig is any skeleton of a human body: of a motion file or of an animator's character.
    """

    @property
    def joints(self) -> dict[str, str]:
        """The rig's joint for each standard one that it has."""
    @property
    def is_by_names(self) -> bool:
        """False where limbs were recognised by their shape."""
    @property
    def unit_scale(self) -> float:
        """The rig's lengths times this are metres."""
    @property
    def R_world_file(self) -> Floats:
        """(3, 3) turns the rig's world into one with y up."""
    @property
    def warnings(self) -> list[str]: ...
    def to_standard(
        self, motion: Motion, skeleton: Skeleton | None = None
    ) -> tuple[Motion, list[str]]:
        """The motion on a standard skeleton (of its own proportions when None), and warnings."""
    def to_rig(self, motion: Motion) -> Motion:
        """A motion of the standard skeleton on the rig, the reverse of to_standard.

        Limbs point where the standard's do; joints that map to nothing keep their rest; root
        translation is scaled by the ratio of leg lengths. Raises ValueError for a motion that is
        not on a standard skeleton.
        """
    def limb_errors_rad(self, motion: Motion, standard: Motion) -> dict[str, tuple[float, float]]:
        """Mean and worst angle between each limb of a motion and of what to_standard made of it."""

def map_skeleton(motion: Motion, by_hand: dict[str, str] = ...) -> SkeletonMapping:
    """Finds the body in a motion's skeleton and aligns the rest poses.

    by_hand: the skeleton's joint for some standard ones; the others are found by their names, then
    by their shape. Raises MappingError.
    """

def standard_motion(
    motion: Motion, skeleton: Skeleton | None = None, by_hand: dict[str, str] = ...
) -> tuple[Motion, list[str]]:
    """map_skeleton and to_standard in one. Raises MappingError."""

def standard_joint_names() -> list[str]: ...
def read_mapping(path: Path) -> dict[str, str]:
    """A mapping by hand, from standard joints to a skeleton's. Raises FormatError."""

def write_mapping(path: Path, joints: dict[str, str]) -> None:
    """Writes a mapping by hand atomically."""

def remembered_mapping(folder: Path, skeleton: Skeleton) -> dict[str, str]:
    """The mapping by hand that a folder keeps for a skeleton, empty when there is none."""

def remembered_mapping_path(folder: Path, skeleton: Skeleton) -> str | os.PathLike[str]:
    """Where the folder keeps it."""
