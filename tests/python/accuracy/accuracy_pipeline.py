# SPDX-License-Identifier: GPL-3.0-or-later
"""The only way by which the accuracy tests reach databases and reconstructions."""

from __future__ import annotations

from pathlib import Path

from sparse_mocap import (
    Motion,
    MotionDatabase,
    Take,
    build_database,
    read_motion,
    reconstruct,
    standard_motion,
)


def built(folder: Path, path: Path) -> MotionDatabase:
    """A database of all motion files in a folder, with its mirrored and its tempo copies."""
    build_database([folder], path, mirror=True)
    return MotionDatabase(path)


def truth(performance: Path, database: MotionDatabase) -> Motion:
    """A motion file as a perfect reconstruction would give it."""
    motion, _ = standard_motion(read_motion(performance)[0], database.skeleton)
    return motion.resampled(database.rate_hz)


def reconstructed(
    take: Take,
    database: MotionDatabase,
    *,
    best_quality: bool,
    gyroscopes: bool,
    own_headings: bool = True,
) -> Motion:
    """The motion that the product's own method makes of a take, live or from the whole take."""
    return reconstruct(
        take,
        database,
        best_quality=best_quality,
        use_gyroscopes=gyroscopes,
        options={"use_own_headings": own_headings},
    ).motion
