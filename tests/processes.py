# SPDX-License-Identifier: GPL-3.0-or-later
"""Processes that a test started: whether one is there, and its sudden end, on every system."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

_SYNCHRONIZE = 0x100000
_WAIT_TIMEOUT = 0x102


def is_alive(pid: int) -> bool:
    """Whether the process runs; one that ended and that nobody waited for does not."""
    if sys.platform == "win32":
        return _is_alive_on_windows(pid)
    try:
        if not Path("/proc/self").exists():
            os.kill(pid, 0)
            return True
        return "Z" not in Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False


def kill(pid: int) -> None:
    """Ends the process before it can do anything about it."""
    os.kill(pid, signal.SIGTERM if sys.platform == "win32" else signal.SIGKILL)


def _is_alive_on_windows(pid: int) -> bool:
    """os.kill(pid, 0) would end it there."""
    import ctypes

    system = ctypes.windll.kernel32  # type: ignore[attr-defined,unused-ignore]
    handle = system.OpenProcess(_SYNCHRONIZE, False, pid)
    if not handle:
        return False
    try:
        return bool(system.WaitForSingleObject(handle, 0) == _WAIT_TIMEOUT)
    finally:
        system.CloseHandle(handle)
