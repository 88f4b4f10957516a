# SPDX-License-Identifier: GPL-3.0-or-later
"""Capture from real sensors, in a separate process that keeps recording when its clients end.

A **capture** has one or more **links** (a serial port or URL, and the driver for its protocol).
Everything received is written to disk at once (raw_log, sample_log). Clients attach and detach at
any time; a **recording** is a part of a capture, converted to a take from the raw log alone.
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
    """Imports names when they are used: a client of a capture does not need pyserial."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(_HOMES[name], __name__), name)
