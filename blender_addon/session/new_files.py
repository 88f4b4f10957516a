# SPDX-License-Identifier: GPL-3.0-or-later
"""Folders and names of new files."""

from __future__ import annotations

import time
from pathlib import Path

TAKES = "takes"
STARTER_SET = "demo movements.smdb"


def takes_folder(blend_path: str, folder: str = "") -> Path:
    """The folder for takes: next to the .blend file; if that is not saved, in the given folder.

    folder: empty for the one in the home folder.
    """
    if blend_path:
        return Path(blend_path).parent / TAKES
    return Path(folder) if folder else _home() / TAKES


def starter_set(folder: str = "") -> Path:
    """The motion database of generated movements, in the given folder.

    folder: empty for the one in the home folder.
    """
    return (Path(folder) if folder else _home()) / STARTER_SET


def _home() -> Path:
    return Path.home() / "Sparse Mocap"


def stamp() -> str:
    """Date and time for a file name."""
    return time.strftime("%Y%m%d-%H%M%S")


def free_path(path: Path) -> Path:
    """The path, with a number if the file exists."""
    candidate, number = path, 1
    while candidate.exists():
        number += 1
        candidate = path.with_name(f"{path.stem}-{number}{path.suffix}")
    return candidate
