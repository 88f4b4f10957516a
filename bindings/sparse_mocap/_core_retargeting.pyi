# SPDX-License-Identifier: GPL-3.0-or-later
"""The compiled core: motions of other skeletons on the standard one, and back."""

import os

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._core_motion import Motion, Skeleton
from ._core_types import Floats, Path

class SkeletonMapping:
    """How a rig and the standard skeleton of 21 joints correspond, for both directions.

    A rig is any skeleton of a human body: of a motion file or of an animator's character.
    """

    @property
    def joints(self) -> dict[str, str]:
        """The rig's joint for each standard joint that it has."""
    @property
    def extremities(self) -> dict[str, str]:
        """The rig's joint for each of feet, toes and hands that it has."""
    @property
    def turned_joints(self) -> list[str]:
        """The rig's joints that to_rig turns; the others keep their rest."""
    @property
    def ankles(self) -> tuple[str, str]:
        """The rig's joints at which its left and right foot begin; empty where it has none."""
    @property
    def is_by_names(self) -> bool:
        """False where limbs were recognised by their shape."""
    @property
    def unit_scale(self) -> float:
        """The rig's lengths times this are metres."""
    @property
    def R_world_file(self) -> Floats:
        """(3, 3) rotation from the rig's world to one with y up."""
    @property
    def warnings(self) -> list[str]:
        """What was guessed about the rig, one line each."""
    def to_standard(
        self, motion: Motion, skeleton: Skeleton | None = None
    ) -> tuple[Motion, list[str]]:
        """Returns the rig's motion on a standard skeleton, and warnings.

        skeleton: the standard skeleton to use; None: one of the rig's proportions. Limbs point
        where the rig's do; root translation is scaled by the ratio of leg lengths. Raises
        ValueError for a motion of a skeleton with other joints.
        """
    def to_rig(self, motion: Motion) -> Motion:
        """Returns a motion of the standard skeleton on the rig, the reverse of to_standard.

        Limbs point where the standard's do; joints that map to nothing keep their rest; root
        translation is scaled by the ratio of leg lengths. Raises ValueError for a motion that is
        not on a standard skeleton.
        """
    def lock_feet(
        self,
        motion: Motion,
        contacts: ArrayLike,
        *,
        strength: float,
        ankle_height_m: float,
        least_certainty: float = 0.5,
        fastest_mps: float = 0.5,
        highest_m: float = 0.06,
    ) -> tuple[Motion, NDArray[np.bool_]]:
        """Returns the rig's motion with feet that stay where they stand, and when they do.

        contacts (T, 2): how certain it is that the left and the right foot stand, 0 to 1; the
        floor is at y = 0. A foot stands while it is certain enough, slower than fastest_mps and no
        more than highest_m above ankle_height_m, where the ankle is while the foot is flat.
        strength is from 0 to 1. The second result is (T, 2) bool. Raises ValueError for a motion
        of a skeleton with other joints.
        """
    def limb_errors_rad(self, motion: Motion, standard: Motion) -> dict[str, tuple[float, float]]:
        """Returns the mean and worst angle between a motion's limbs and those of its transfer.

        By the standard joint of each thigh, shank, upper arm and forearm, over all frames;
        standard is what to_standard made of the motion. Raises ValueError for a motion of a
        skeleton with other joints.
        """
    def faults(self, motion: Motion, standard: Motion) -> list[str]:
        """Returns what makes a motion doubtful, one line each, the worst first.

        Limbs that stray from the file's, a body that lies or stands on its head in every frame,
        sides that are mixed up, speeds that are no person's; standard is what to_standard made of
        it.
        """

def map_skeleton(motion: Motion, by_hand: dict[str, str] = ...) -> SkeletonMapping:
    """Returns the mapping of a motion's skeleton, with the rest poses aligned.

    by_hand: the skeleton's joint for some standard ones; the others are found by their names, then
    by their shape. Raises MappingError when it is not a human body.
    """

def standard_motion(
    motion: Motion, skeleton: Skeleton | None = None, by_hand: dict[str, str] = ...
) -> tuple[Motion, list[str]]:
    """Returns what map_skeleton and then to_standard return. Raises MappingError."""

def with_extremities(skeleton: Skeleton) -> Skeleton:
    """A standard skeleton with feet, toes and hands after its 21 joints.

    Raises ValueError for another skeleton.
    """

def standard_joint_names() -> list[str]:
    """Returns the standard skeleton's 21 joints, the root first."""

def read_mapping(path: Path) -> dict[str, str]:
    """Returns a file's mapping by hand, from standard joints to a rig's. Raises FormatError."""

def write_mapping(path: Path, joints: dict[str, str]) -> None:
    """Writes a mapping by hand atomically. Raises OSError."""

def remembered_mapping(folder: Path, skeleton: Skeleton) -> dict[str, str]:
    """Returns the mapping by hand that a folder holds for a skeleton; empty when there is none.

    Raises FormatError when its file cannot be read.
    """

def remembered_mapping_path(folder: Path, skeleton: Skeleton) -> str | os.PathLike[str]:
    """Returns where a folder holds the mapping of a skeleton, named after the skeleton's joints."""
