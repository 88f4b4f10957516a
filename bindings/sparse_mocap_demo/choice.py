# SPDX-License-Identifier: GPL-3.0-or-later
"""Which motion the demonstration performs, and what its database is built from."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from sparse_mocap import Cancelled, FormatError, MappingError, read_motion, to_standard
from sparse_mocap.demo_motions import generate_library, generate_performance
from sparse_mocap.evaluation import motion_files
from sparse_mocap.table_errors import TableError

Progress = Callable[[int, int, str], object]


@dataclass(frozen=True)
class Choice:
    """A motion file to perform, and a folder that the database is built from."""

    performance: Path
    library: Path
    exclude: tuple[str, ...]
    """Patterns on file names that keep the performance out of the database."""


def generated(folder: Path, progress: Progress) -> Choice:
    """Returns motions made here: a library, and a performance by someone who is not in it."""
    library = folder / "library"
    generate_library(library, progress=_plain(progress))
    performance = generate_performance(folder / "performance.bvh")
    return Choice(performance, library, ())


def _plain(progress: Progress) -> Callable[[int, int, str], None]:
    def call(done: int, total: int, what: str) -> None:
        if progress(done, total, what) is False:
            raise Cancelled("cancelled")

    return call


def recorded(folder: Path, progress: Progress) -> Choice:
    """Returns motion capture of one's own, of which a clip of median length is performed."""
    files = [path for same_name in motion_files(folder).values() for path in same_name]
    lengths, call = [], _plain(progress)
    for done, path in enumerate(files):
        call(done, len(files), path.name)
        try:
            motion, _ = to_standard(read_motion(path)[0])
        except (FormatError, MappingError):
            continue  # the database will say so
        lengths.append((motion.num_frames * motion.frame_time_s, path.name, path))
    if len(lengths) < 2:
        raise TableError(folder, 0, "holds fewer than two motions of a person, .bvh or .amc")
    performance = sorted(lengths)[len(lengths) // 2][2]
    return Choice(performance, folder, (_escaped(performance.name),))


def _escaped(name: str) -> str:
    """Returns the pattern that only this name matches."""
    return re.sub(r"([*?\[])", r"[\1]", name)
