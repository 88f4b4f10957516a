# SPDX-License-Identifier: GPL-3.0-or-later
"""A file that is locked while a process runs; the system unlocks it when the process ends."""

from __future__ import annotations

import os
import sys

__all__ = ["lock", "release"]

if sys.platform == "win32":
    import msvcrt

    _FAR = 1 << 30
    """Windows also keeps others from reading a locked part: it lies behind the content."""

    def lock(file: int) -> bool:
        """Locks an open file; returns False when another process holds it."""
        os.lseek(file, _FAR, os.SEEK_SET)
        try:
            msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
        except OSError:
            return False
        finally:
            os.lseek(file, 0, os.SEEK_SET)
        return True

    def release(file: int) -> None:
        """Unlocks the file."""
        os.lseek(file, _FAR, os.SEEK_SET)
        msvcrt.locking(file, msvcrt.LK_UNLCK, 1)

else:
    import fcntl

    def lock(file: int) -> bool:
        """Locks an open file; returns False when another process holds it."""
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            return False
        return True

    def release(file: int) -> None:
        """Unlocks the file."""
        fcntl.flock(file, fcntl.LOCK_UN)
