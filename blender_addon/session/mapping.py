# SPDX-License-Identifier: GPL-3.0-or-later
"""Which joint of a file's skeleton is which of the standard one, found or said by hand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .core import core
from .errors import InputError, one_line

SUFFIX = ".json"
_MOST_FRAMES = 1000  # of a motion, to see the body by


@dataclass(frozen=True)
class Mapped:
    """A skeleton and where its body was found."""

    name: str
    motion: Any  # sparse_mocap.Motion, the first frames of the file
    joints: dict[str, str]
    """The skeleton's joint by standard joint; those that were found."""
    problem: str
    """Why no body was found; empty when one was."""

    @property
    def source_joints(self) -> list[str]:
        """All joints of the skeleton."""
        return list(self.motion.skeleton.names)


last_mapped: list[Mapped] = []
"""The skeleton of the last file that was imported, if there is one."""


def mapped(name: str, motion: Any, by_hand: dict[str, str] | None = None) -> Mapped:
    """The body in a motion: as it is told, else as it is remembered, else as it looks."""
    if motion.num_frames > _MOST_FRAMES:
        motion = motion.trimmed(0, _MOST_FRAMES)
    try:
        mapping, _ = core().mappings.find_mapping(motion, by_hand)
    except ValueError as error:
        return Mapped(name, motion, dict(by_hand or {}), one_line(error))
    return Mapped(name, motion, dict(mapping.joints), "")


def remember(joints: dict[str, str]) -> Mapped:
    """Keep what was said by hand for every file with the last skeleton. Raises InputError."""
    last = _last()
    told = _checked(last, joints)
    found = mapped(last.name, last.motion, told)
    if found.problem:
        raise InputError(found.problem)
    core().remember_mapping(last.motion.skeleton, told)
    last_mapped[:] = [found]
    return found


def forget() -> Mapped:
    """Find the body of the last skeleton by its looks again. Raises InputError."""
    last = _last()
    core().forget_mapping(last.motion.skeleton)
    last_mapped[:] = [mapped(last.name, last.motion)]
    return last_mapped[0]


def save(path: str, joints: dict[str, str]) -> str:
    """Write the mapping to a file and return its name. Raises InputError and OSError."""
    target = path if path.lower().endswith(SUFFIX) else path + SUFFIX
    core().write_mapping(target, _checked(_last(), joints))
    return target


def load(path: str) -> dict[str, str]:
    """The mapping in the file. Raises FormatError, and InputError when it is another skeleton's."""
    return _checked(_last(), core().read_mapping(path))


def _last() -> Mapped:
    if not last_mapped:
        raise InputError("No skeleton is at hand: import a motion file first")
    return last_mapped[0]


def _checked(last: Mapped, joints: dict[str, str]) -> dict[str, str]:
    """Those that name a joint. Raises InputError when the skeleton has none of that name."""
    told = {standard: joint for standard, joint in joints.items() if joint}
    known = set(last.source_joints)
    for standard, joint in told.items():
        if joint not in known:
            raise InputError(f'{standard}: "{last.name}" has no joint "{joint}", choose another')
    return told
