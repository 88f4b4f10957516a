# SPDX-License-Identifier: GPL-3.0-or-later
"""Where files of one's own are put, and what they are called."""

from __future__ import annotations

import time
from pathlib import Path

TAKES = "takes"


def takes_folder(blend_path: str) -> Path:
    """Where takes are kept: beside the .blend file, or in the user's folder before it is saved."""
    home = Path(blend_path).parent if blend_path else Path.home() / "Sparse Mocap"
    return home / TAKES


def stamp() -> str:
    """Date and time as a part of a file's name."""
    return time.strftime("%Y%m%d-%H%M%S")


def free_path(path: Path) -> Path:
    """The path, numbered when it is taken."""
    candidate, number = path, 1
    while candidate.exists():
        number += 1
        candidate = path.with_name(f"{path.stem}-{number}{path.suffix}")
    return candidate
