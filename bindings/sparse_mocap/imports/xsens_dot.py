# SPDX-License-Identifier: GPL-3.0-or-later
"""CSV exports of Movella (Xsens) DOT: one file for each sensor."""

from __future__ import annotations

import re

import numpy as np

from ..rotations import from_z_up, normalised
from ..take import SensorRecord
from .gravity import with_gravity
from .tables import (
    Floats,
    RecordingError,
    Table,
    Text,
    check_finite,
    find_line,
    read_table,
    unwrapped,
)

__all__ = ["read"]

NAME = "Movella DOT CSV"

_QUATERNION = ("Quat_W", "Quat_X", "Quat_Y", "Quat_Z")
_FREE = ("FreeAcc_X", "FreeAcc_Y", "FreeAcc_Z")
_FORCE = ("Acc_X", "Acc_Y", "Acc_Z")
_RATES = ("Gyr_X", "Gyr_Y", "Gyr_Z")
_TICK_S = 1e-6


def read(texts: list[Text], notes: list[str]) -> dict[str, SensorRecord] | None:
    """Returns a record for each file, named after it; None when it is another format."""
    found = [(text, find_line(text, "PacketCounter,", "SampleTimeFine")) for text in texts]
    files = [(text, at) for text, at in found if at is not None]
    if not files:
        return None
    tables = {_sensor_name(text): read_table(text, at, ",") for text, at in files}
    times = {
        name: unwrapped(table.column("SampleTimeFine"), 32) * _TICK_S
        for name, table in tables.items()
    }
    begin = min(float(time[0]) for time in times.values())
    if not all(find_line(text, "SyncStatus", "Synced") is not None for text, _ in files):
        notes.append("the sensors were not synchronised: each record begins at 0 s")
        times = {name: time - time[0] + begin for name, time in times.items()}
    return {name: _record(table, times[name] - begin, notes) for name, table in tables.items()}


def _record(table: Table, times_s: Floats, notes: list[str]) -> SensorRecord:
    rotation = normalised(table.columns(*_QUATERNION)) if table.has(*_QUATERNION) else None
    if table.has(*_FORCE):
        force = table.columns(*_FORCE)
    elif table.has(*_FREE) and rotation is not None:
        force = with_gravity(rotation, table.columns(*_FREE))
        notes.append("gravity was added using the sensors' own orientation")
    else:
        raise RecordingError(
            table.path,
            table.first_line - 1,
            "has neither Acc_X nor FreeAcc_X with Quat_W; record in another measurement mode",
        )
    check_finite(table, force, _FORCE)
    keep = np.concatenate([[True], np.diff(times_s) > 0])
    turn = np.radians(table.columns(*_RATES)) if table.has(*_RATES) else None
    return SensorRecord(
        times_s[keep],
        force[keep],
        None if turn is None else turn[keep],
        None if rotation is None else from_z_up(rotation)[keep],
    )


def _sensor_name(text: Text) -> str:
    return re.sub(r"_\d{8}_\d{6}(_\d+)?$", "", text.name)
