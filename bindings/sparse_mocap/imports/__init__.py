# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports recordings of other programs as takes."""

from __future__ import annotations

from .recording import read_recording, recording_formats
from .tables import RecordingError

__all__ = ["RecordingError", "read_recording", "recording_formats"]
