# SPDX-License-Identifier: GPL-3.0-or-later
"""Which clips are tested, and what the database may know then (Tautges et al. 2011, table I)."""

from __future__ import annotations

import os
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path, PurePosixPath

from .. import Clip, FormatError
from ..table_errors import TableError

__all__ = [
    "EVERYTHING",
    "Content",
    "choose_tests",
    "excluded_clips",
    "is_copy",
    "motion_files",
    "source_path",
]

SCENARIOS = {
    1: "the database holds other clips of the actor and of others",
    2: "the database holds other clips of the actor only",
    3: "the database holds clips of other actors only",
}


@dataclass(frozen=True)
class Content:
    """Some of a database's clips."""

    actors: tuple[str, ...] = ()
    """Empty: all."""
    classes: tuple[str, ...] = ()
    """Patterns on the kinds of movement; empty: all."""
    with_mirrored: bool = True
    with_reversed: bool = True
    every: int = 1
    """Of the files, sorted by name, only every so many-th."""

    def rest(self, clips: Sequence[Clip]) -> set[int]:
        """Returns the indices of all other clips."""
        files = sorted({clip.source for clip in clips})
        kept = set(files[:: self.every])
        return {i for i, clip in enumerate(clips) if clip.source not in kept or not self.has(clip)}

    def has(self, clip: Clip) -> bool:
        """Whether a clip is of these actors, kinds and copies."""
        return (
            (not self.actors or clip.actor in self.actors)
            and (not self.classes or any(fnmatch(clip.motion_class, p) for p in self.classes))
            and (self.with_mirrored or not clip.is_mirrored)
            and (self.with_reversed or not clip.is_reversed)
        )


EVERYTHING = Content()


def motion_files(folder: str | os.PathLike[str]) -> dict[str, list[Path]]:
    """Returns the motion files in a folder (recursively) by their paths in it and their names."""
    files: dict[str, list[Path]] = {}
    for path in sorted(Path(folder).rglob("*")):
        if path.suffix.lower() in (".bvh", ".amc") and path.is_file():
            files.setdefault(path.name, []).append(path)
    for path in [path for same_name in files.values() for path in same_name]:
        files[path.relative_to(folder).as_posix()] = [path]
    return files


def is_copy(clip: Clip) -> bool:
    """Whether a clip is another one mirrored, reversed or at another tempo."""
    return clip.is_mirrored or clip.is_reversed or clip.tempo != 1.0


def choose_tests(
    clips: Sequence[Clip],
    pattern: str | None = None,
    among: Content | None = None,
    per_class: int = 1,
) -> list[int]:
    """Returns the indices of the clips to test: as they were recorded, no copies.

    Without a pattern on file names these are, for each actor and class, the first ones by name.
    """
    others = among.rest(clips) if among is not None else set()
    originals = sorted(
        (i for i, clip in enumerate(clips) if not is_copy(clip) and i not in others),
        key=lambda i: (clips[i].name, clips[i].source),
    )
    if pattern is not None:
        return [i for i in originals if _matches(clips[i].source, pattern)]
    firsts: dict[tuple[str, str], list[int]] = {}
    for i in originals:
        firsts.setdefault((clips[i].actor, clips[i].motion_class), []).append(i)
    return [i for found in firsts.values() for i in found[:per_class]]


def _matches(source: str, pattern: str) -> bool:
    names = (source, PurePosixPath(source).name)
    return any(fnmatch(name.lower(), pattern.lower()) for name in names)


def excluded_clips(
    clips: Sequence[Clip], test: int, scenario: int, same: Collection[str] = ()
) -> list[int]:
    """Returns the clips that a test's database must not have.

    Whatever comes from the test's file, from a copy of it, or from one of the files in ``same``
    (see same_motion) is always among them.
    """
    tested = clips[test]

    def is_excluded(clip: Clip) -> bool:
        is_same = (
            clip.source == tested.source
            or clip.source_hash == tested.source_hash
            or clip.source in same
        )
        is_same_actor = clip.actor == tested.actor
        if scenario == 2:
            return is_same or not is_same_actor
        if scenario == 3:
            return is_same or is_same_actor
        return is_same

    return [i for i, clip in enumerate(clips) if is_excluded(clip)]


def source_path(files: dict[str, list[Path]], clip: Clip) -> Path:
    """Returns the file that a clip was made from. Raises FormatError where that is unclear."""
    found = files.get(clip.source, [])
    if len(found) != 1:
        problem = "is gone" if not found else f"occurs {len(found)} times"
        raise _unclear(clip.source, problem)
    return found[0]


def _unclear(name: str, problem: str) -> FormatError:
    return TableError(name, 0, f"{problem} under the database's source; rename it")
