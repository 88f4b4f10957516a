# SPDX-License-Identifier: GPL-3.0-or-later
"""Text exports of Xsens MT Manager: one tab-separated file for each sensor."""

from __future__ import annotations

import re

import numpy as np

from ..rotations import from_z_up, normalised, rotations_from_matrices
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

NAME = "Xsens MT Manager text"

_FORCE = ("Acc_X", "Acc_Y", "Acc_Z")
_FREE = ("FreeAcc_E", "FreeAcc_N", "FreeAcc_U")
_RATES = ("Gyr_X", "Gyr_Y", "Gyr_Z")
_MATRIX = tuple(f"Mat[{row}][{column}]" for column in (1, 2, 3) for row in (1, 2, 3))
_QUATERNIONS = (
    ("Quat_q0", "Quat_q1", "Quat_q2", "Quat_q3"),
    ("Quat_w", "Quat_x", "Quat_y", "Quat_z"),
)


def read(texts: list[Text], notes: list[str]) -> dict[str, SensorRecord] | None:
    """Returns a record for each file, named after its sensor; None when it is another format."""
    found = [(text, find_line(text, "PacketCounter\t")) for text in texts]
    files = [(text, at) for text, at in found if at is not None]
    if not files:
        return None
    tables = {_sensor_name(text): (text, read_table(text, at, "\t")) for text, at in files}
    counters = {
        name: unwrapped(table.column("PacketCounter"), 16) for name, (_, table) in tables.items()
    }
    begin = min(float(counter[0]) for counter in counters.values())
    return {
        name: _record(table, (counters[name] - begin) / _rate_hz(text), notes)
        for name, (text, table) in tables.items()
    }


def _record(table: Table, times_s: Floats, notes: list[str]) -> SensorRecord:
    rotation = _rotation(table)
    if table.has(*_FORCE):
        force = table.columns(*_FORCE)
    elif table.has(*_FREE) and rotation is not None:
        force = with_gravity(rotation, table.columns(*_FREE))
        notes.append("gravity was added using the sensors' own orientation")
    else:
        raise RecordingError(
            table.path, table.first_line - 1, "has no column Acc_X; export the acceleration"
        )
    check_finite(table, force, _FORCE)
    keep = np.concatenate([[True], np.diff(times_s) > 0])
    turn = table.columns(*_RATES) if table.has(*_RATES) else None
    return SensorRecord(
        times_s[keep],
        force[keep],
        None if turn is None else turn[keep],
        None if rotation is None else from_z_up(rotation)[keep],
    )


def _rotation(table: Table) -> Floats | None:
    for names in _QUATERNIONS:
        if table.has(*names):
            return normalised(table.columns(*names))
    if not table.has(*_MATRIX):
        return None
    columns = table.columns(*_MATRIX)
    check_finite(table, columns, _MATRIX)
    return np.asarray(rotations_from_matrices(columns.reshape(-1, 3, 3).transpose(0, 2, 1)))


def _rate_hz(text: Text) -> float:
    for line in text.lines[:20]:
        match = re.match(r"//\s*Update Rate:\s*([0-9.]+)\s*Hz", line)
        if match and float(match[1]) > 0:
            return float(match[1])
    raise RecordingError(text.path, 0, "has no line '// Update Rate: ...Hz'; export it again")


def _sensor_name(text: Text) -> str:
    return text.name.rsplit("_", 1)[-1]
