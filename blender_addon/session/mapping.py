# SPDX-License-Identifier: GPL-3.0-or-later
"""Maps the joints of a file's skeleton to the standard skeleton, automatically or by hand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .core import core
from .errors import InputError, one_line

SUFFIX = ".json"

_SIDED = {
    "clavicle": "Shoulder",
    "humerus": "Upper arm",
    "radius": "Forearm",
    "wrist": "Hand",
    "femur": "Thigh",
    "tibia": "Shin",
    "foot": "Foot",
    "toes": "Toes",
}
LABELS: dict[str, str] = {
    "root": "Pelvis",
    "lowerback": "Lower back",
    "upperback": "Upper back",
    "thorax": "Chest",
    "lowerneck": "Neck",
    "upperneck": "Upper neck",
    "head": "Head",
    **{f"l{joint}": f"{label} L" for joint, label in _SIDED.items()},
    **{f"r{joint}": f"{label} R" for joint, label in _SIDED.items()},
}
"""What animators call the standard joints; those without a label have no bone in usual rigs."""

_MOST_FRAMES = 1000  # of a motion, to detect the joints from


@dataclass(frozen=True)
class Mapped:
    """A skeleton and its mapping."""

    name: str
    motion: Any  # sparse_mocap.Motion, the first frames of the file
    joints: dict[str, str]
    """The file's joint for each standard joint that is mapped."""
    problem: str
    """Why there is no mapping; empty when there is."""

    @property
    def source_joints(self) -> list[str]:
        """All joints of the file's skeleton."""
        return list(self.motion.skeleton.names)


last_mapped: list[Mapped] = []
"""The skeleton that was looked at last: of an imported file or a character, if there is one."""


def label_of(joint: str) -> str:
    """What the panel calls a standard joint."""
    return LABELS.get(joint, joint)


def mapped(name: str, motion: Any, by_hand: dict[str, str] | None = None) -> Mapped:
    """The mapping of a motion: by hand if given, else the remembered one, else detected."""
    if motion.num_frames > _MOST_FRAMES:
        motion = motion.trimmed(0, _MOST_FRAMES)
    try:
        mapping, _ = core().mappings.find_mapping(motion, by_hand)
    except ValueError as error:
        return Mapped(name, motion, dict(by_hand or {}), one_line(error))
    return Mapped(name, motion, dict(mapping.joints), "")


def remember(joints: dict[str, str]) -> Mapped:
    """Remember this mapping for every file with the last skeleton. Raises InputError."""
    last = _last()
    by_hand = _checked(last, joints)
    found = mapped(last.name, last.motion, by_hand)
    if found.problem:
        raise InputError(found.problem)
    core().remember_mapping(last.motion.skeleton, by_hand)
    last_mapped[:] = [found]
    return found


def forget() -> Mapped:
    """Forget the remembered mapping of the last skeleton and detect it. Raises InputError."""
    last = _last()
    core().forget_mapping(last.motion.skeleton)
    last_mapped[:] = [mapped(last.name, last.motion)]
    return last_mapped[0]


def save(path: str, joints: dict[str, str]) -> str:
    """Write the mapping to a file and return its path. Raises InputError and OSError."""
    target = path if path.lower().endswith(SUFFIX) else path + SUFFIX
    core().write_mapping(target, _checked(_last(), joints))
    return target


def load(path: str) -> dict[str, str]:
    """The mapping in the file. Raises FormatError, or InputError for another skeleton."""
    return _checked(_last(), core().read_mapping(path))


def _last() -> Mapped:
    if not last_mapped:
        raise InputError("There is no skeleton to map: choose a character or import a motion file")
    return last_mapped[0]


def _checked(last: Mapped, joints: dict[str, str]) -> dict[str, str]:
    """The entries that name a joint. Raises InputError for a joint the skeleton does not have."""
    named = {standard: joint for standard, joint in joints.items() if joint}
    known = set(last.source_joints)
    for standard, joint in named.items():
        if joint not in known:
            raise InputError(
                f'{standard}: "{last.name}" has no joint "{joint}", choose another one'
            )
    return named
