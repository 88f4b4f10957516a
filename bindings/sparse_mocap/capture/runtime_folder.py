# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder of session files and control channels, which only its user can enter."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

from .errors import CaptureError

__all__ = ["FOLDER_VARIABLE", "check_private", "runtime_folder"]

FOLDER_VARIABLE = "SPARSE_MOCAP_RUNTIME"
_OTHERS = 0o077


def runtime_folder() -> Path:
    """Returns the user's folder of session files, created if needed.

    Raises CaptureError when it is a link or belongs to another user.
    """
    named = os.environ.get(FOLDER_VARIABLE)
    folder = Path(named) if named else _usual_folder()
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    check_private(folder)
    return folder


def check_private(folder: Path) -> None:
    """Closes a folder to other users. Raises CaptureError when it is a link or not this user's."""
    if sys.platform == "win32":  # the user's own folders are closed to others there
        return
    found = os.lstat(folder)
    if not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid():
        raise CaptureError(
            f"{folder}: is not a folder of this user; remove it, or name another one in the "
            f"environment variable {FOLDER_VARIABLE}"
        )
    if found.st_mode & _OTHERS:
        folder.chmod(0o700)


def _usual_folder() -> Path:
    """In a place where no other user can be first."""
    if sys.platform == "win32":
        local = os.environ.get("LOCALAPPDATA")
        return (Path(local) if local else Path.home()) / "sparse-mocap" / "runtime"
    given = os.environ.get("XDG_RUNTIME_DIR")
    if given and os.path.isdir(given) and os.stat(given).st_uid == os.getuid():
        return Path(given) / "sparse-mocap"
    cache = os.environ.get("XDG_CACHE_HOME")
    return (Path(cache) if cache else Path.home() / ".cache") / "sparse-mocap" / "runtime"
