# SPDX-License-Identifier: GPL-3.0-or-later
"""Capture from real sensors, in a process of its own that outlives its clients while it records.

A **capture** owns one or several **links** (a serial port or URL, and the driver that speaks
there). What arrives is on disk at once (raw_log, sample_log). Clients attach, detach and attach
again; a **recording** is a part of a capture and becomes a take from the raw log alone.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .client import CaptureClient, start_capture
    from .config import CaptureConfig, LinkConfig
    from .emulator import Emulator, Faults
    from .errors import CaptureError, PortError, RecordingError
    from .ports import PortInfo, available_ports
    from .recording import RecordedTake, recording_to_take

_HOMES = {
    **dict.fromkeys(("CaptureClient", "start_capture"), ".client"),
    **dict.fromkeys(("CaptureConfig", "LinkConfig"), ".config"),
    **dict.fromkeys(("Emulator", "Faults"), ".emulator"),
    **dict.fromkeys(("CaptureError", "PortError", "RecordingError"), ".errors"),
    **dict.fromkeys(("PortInfo", "available_ports"), ".ports"),
    **dict.fromkeys(("RecordedTake", "recording_to_take"), ".recording"),
}

__all__ = [
    "CaptureClient",
    "CaptureConfig",
    "CaptureError",
    "Emulator",
    "Faults",
    "LinkConfig",
    "PortError",
    "PortInfo",
    "RecordedTake",
    "RecordingError",
    "available_ports",
    "recording_to_take",
    "start_capture",
]


def __getattr__(name: str) -> Any:
    """Loads what is asked for: a client of a capture needs no pyserial."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_HOMES[name], __name__), name)
