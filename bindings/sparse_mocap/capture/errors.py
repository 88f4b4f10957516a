# SPDX-License-Identifier: GPL-3.0-or-later
"""What goes wrong with captures; str() of each is one line: where, what, what to do."""

from __future__ import annotations

__all__ = ["CaptureError", "LogError", "PortError", "RecordingError"]


class CaptureError(Exception):
    """A capture cannot be started, reached or used."""


class PortError(CaptureError):
    """A port cannot be used."""


class LogError(CaptureError):
    """What arrives cannot be kept, such as for a full disk."""


class RecordingError(CaptureError):
    """A recording cannot become a take."""
