# SPDX-License-Identifier: GPL-3.0-or-later
"""x-IMU3 log folders: one folder for each device, with Inertial.csv and Quaternion.csv."""

from __future__ import annotations

import json
import re
from pathlib import PurePath

import numpy as np

from ..rotations import from_z_up, interpolated, normalised
from ..take import SensorRecord
from .gravity import STANDARD_GRAVITY_MPS2
from .tables import Text, check_finite, find_line, read_table

__all__ = ["read"]

NAME = "x-IMU3 log folder"

_TIME = "Timestamp (us)"
_FORCE = ("Accelerometer X (g)", "Accelerometer Y (g)", "Accelerometer Z (g)")
_RATES = ("Gyroscope X (deg/s)", "Gyroscope Y (deg/s)", "Gyroscope Z (deg/s)")


def read(texts: list[Text], notes: list[str]) -> dict[str, SensorRecord] | None:
    """Returns a record for each device under its name; None when it is another format."""
    records = {}
    for text in texts:
        at = find_line(text, _TIME, "Accelerometer X (g)")
        if at is not None:
            beside = {
                PurePath(other.path).name.lower(): other
                for other in texts
                if PurePath(other.path).parent == PurePath(text.path).parent
            }
            records[_device_name(text, beside.get("command.json"))] = _record(text, at, beside)
    if len(records) > 1:
        notes.append(
            "times are from the devices' own clocks, which match only if they were synchronised"
        )
    return records or None


def _record(text: Text, at: int, beside: dict[str, Text]) -> SensorRecord:
    table = read_table(text, at, ",")
    times_s = table.column(_TIME) * 1e-6
    force = table.columns(*_FORCE) * STANDARD_GRAVITY_MPS2
    check_finite(table, np.column_stack([times_s, force]), (_TIME, *_FORCE))
    keep = np.concatenate([[True], np.diff(times_s) > 0])
    times_s = times_s[keep]
    orientation = None
    if "quaternion.csv" in beside:
        turns = read_table(beside["quaternion.csv"], 0, ",")
        values = from_z_up(normalised(turns.columns("W", "X", "Y", "Z")))
        orientation = interpolated(times_s, turns.column(_TIME) * 1e-6, values)
    turn = np.radians(table.columns(*_RATES))[keep] if table.has(*_RATES) else None
    return SensorRecord(times_s, force[keep], turn, orientation)


def _device_name(text: Text, command: Text | None) -> str:
    """Returns the name in the device's reply, else that of its folder."""
    try:
        replies = json.loads("\n".join(command.lines)) if command else []
        for reply in replies:
            if "ping" in reply:
                return str(reply["ping"]["name"])
    except (ValueError, TypeError, KeyError):
        pass
    folder = PurePath(text.path).parent.name
    return re.sub(r" [0-9A-F]{8}( \(.*\))?$", "", folder) or text.name
