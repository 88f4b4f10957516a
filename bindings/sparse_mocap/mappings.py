# SPDX-License-Identifier: GPL-3.0-or-later
"""Mappings by hand, remembered for each skeleton.

Who says once which joint of a rig is its left forearm need not say it again: the mapping is kept
in the user's own folder under a name made of the skeleton's joints, and every later file with the
same joints finds it there.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from pathlib import Path

from ._core import (
    HumanoidMapping,
    Motion,
    Skeleton,
    map_humanoid,
    remembered_mapping,
    remembered_mapping_path,
    write_mapping,
)

__all__ = ["find_mapping", "forget_mapping", "mapping_folder", "remember_mapping", "to_standard"]


def mapping_folder() -> Path:
    """Where mappings are remembered; the variable SPARSE_MOCAP_MAPPINGS names another folder."""
    if named := os.environ.get("SPARSE_MOCAP_MAPPINGS"):
        return Path(named)
    if sys.platform == "win32":
        settings = Path(os.environ.get("APPDATA") or Path.home() / "AppData" / "Roaming")
    elif sys.platform == "darwin":
        settings = Path.home() / "Library" / "Application Support"
    else:
        settings = Path(os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config")
    return settings / "sparse-mocap" / "mappings"


def remember_mapping(skeleton: Skeleton, joints: Mapping[str, str]) -> Path:
    """Keeps a mapping by hand for every motion on such a skeleton; gives its file."""
    path = Path(remembered_mapping_path(mapping_folder(), skeleton))
    path.parent.mkdir(parents=True, exist_ok=True)
    write_mapping(path, dict(joints))
    return path


def forget_mapping(skeleton: Skeleton) -> bool:
    """Removes what is remembered for a skeleton; False when nothing was."""
    path = Path(remembered_mapping_path(mapping_folder(), skeleton))
    known = path.exists()
    path.unlink(missing_ok=True)
    return known


def find_mapping(
    motion: Motion, by_hand: Mapping[str, str] | None = None
) -> tuple[HumanoidMapping, list[str]]:
    """The body in a motion: as it is told, else as it is remembered, else as it looks.

    Gives a line that says so when it was remembered. Raises MappingError.
    """
    if by_hand is not None:
        return map_humanoid(motion, dict(by_hand)), []
    remembered = remembered_mapping(mapping_folder(), motion.skeleton)
    path = remembered_mapping_path(mapping_folder(), motion.skeleton)
    notes = [f"mapped by hand, as {path} remembers"] if remembered else []
    return map_humanoid(motion, remembered), notes


def to_standard(
    motion: Motion, skeleton: Skeleton | None = None, by_hand: Mapping[str, str] | None = None
) -> tuple[Motion, list[str]]:
    """The motion on a standard skeleton (of its own proportions when None), and warnings.

    The body is found as find_mapping does. Raises MappingError.
    """
    mapping, notes = find_mapping(motion, by_hand)
    standard, warnings = mapping.to_standard(motion, skeleton)
    return standard, notes + warnings
