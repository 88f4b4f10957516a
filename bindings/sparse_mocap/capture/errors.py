# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of captures; str() of each is one line: where, what, what to do."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys

__all__ = ["CaptureError", "LogError", "PortError", "RecordingError", "recover_command"]


class CaptureError(Exception):
    """A capture cannot be started, reached or used."""


class PortError(CaptureError):
    """A port cannot be used."""


class LogError(CaptureError):
    """The log cannot be written, for example because the disk is full."""


class RecordingError(CaptureError):
    """A recording cannot be converted to a take."""


def recover_command(folder: str | os.PathLike[str]) -> str:
    """The command that saves what a capture received, from the folder of its logs."""
    path = os.fspath(folder)
    quoted = subprocess.list2cmdline([path]) if sys.platform == "win32" else shlex.quote(path)
    return f"sparse-mocap record --recover {quoted} -o TAKE.csv"
