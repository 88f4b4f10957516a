# SPDX-License-Identifier: GPL-3.0-or-later
"""Skeleton mappings made by hand, remembered for each skeleton.

A mapping is made only once for each skeleton: it is saved in the user's folder under a name derived
from the skeleton's joints, and is used for every later file with the same joints.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from ._core import (
    Motion,
    Skeleton,
    SkeletonMapping,
    map_skeleton,
    remembered_mapping,
    remembered_mapping_path,
    with_extremities,
    write_mapping,
)
from .settings_folder import settings_folder

__all__ = ["find_mapping", "forget_mapping", "mapping_folder", "remember_mapping", "to_standard"]


def mapping_folder() -> Path:
    """The folder of remembered mappings; the variable SPARSE_MOCAP_MAPPINGS overrides it."""
    if named := os.environ.get("SPARSE_MOCAP_MAPPINGS"):
        return Path(named)
    return settings_folder() / "mappings"


def remember_mapping(skeleton: Skeleton, joints: Mapping[str, str]) -> Path:
    """Remembers a mapping for every motion with this skeleton; returns its file."""
    path = Path(remembered_mapping_path(mapping_folder(), skeleton))
    path.parent.mkdir(parents=True, exist_ok=True)
    write_mapping(path, dict(joints))
    return path


def forget_mapping(skeleton: Skeleton) -> bool:
    """Forgets the mapping of a skeleton; False when there was none."""
    path = Path(remembered_mapping_path(mapping_folder(), skeleton))
    known = path.exists()
    path.unlink(missing_ok=True)
    return known


def find_mapping(
    motion: Motion, by_hand: Mapping[str, str] | None = None
) -> tuple[SkeletonMapping, list[str]]:
    """The mapping of a motion: by hand if given, else the remembered one, else detected.

    Also returns a note if a remembered mapping is used. Raises MappingError.
    """
    if by_hand is not None:
        return map_skeleton(motion, dict(by_hand)), []
    remembered = remembered_mapping(mapping_folder(), motion.skeleton)
    path = remembered_mapping_path(mapping_folder(), motion.skeleton)
    notes = [f"using the mapping remembered in {path}"] if remembered else []
    return map_skeleton(motion, remembered), notes


def to_standard(
    motion: Motion,
    skeleton: Skeleton | None = None,
    by_hand: Mapping[str, str] | None = None,
    *,
    extremities: bool = False,
) -> tuple[Motion, list[str]]:
    """The motion on a standard skeleton (None: with its own proportions), and warnings.

    extremities: with feet, toes and hands, relaxed where the motion has none. The joints are mapped
    as by find_mapping. Raises MappingError.
    """
    mapping, notes = find_mapping(motion, by_hand)
    standard, warnings = mapping.to_standard(motion, skeleton)
    if extremities:
        standard, _ = mapping.to_standard(motion, with_extremities(standard.skeleton))
    return standard, notes + warnings
