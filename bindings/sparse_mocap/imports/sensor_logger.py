# SPDX-License-Identifier: GPL-3.0-or-later
"""CSV exports of the app Sensor Logger (files or zip): a phone for each export."""

from __future__ import annotations

import numpy as np

from ..rotations import from_z_up, normalised
from ..rotations import interpolated as interpolated_rotations
from ..take import SensorRecord
from .gravity import STANDARD_GRAVITY_MPS2
from .phones import read_phones
from .tables import (
    Floats,
    RecordingError,
    Table,
    Text,
    check_finite,
    interpolated,
    read_table,
)

__all__ = ["read"]

NAME = "Sensor Logger CSV"

_TIME = "seconds_elapsed"
_AXES = ("x", "y", "z")
_WITH_GRAVITY = ("totalacceleration", "accelerometeruncalibrated")


def read(texts: list[Text], notes: list[str]) -> dict[str, SensorRecord] | None:
    """Returns a record for each phone; None when it is another format."""
    return read_phones(texts, notes, _read)


def _read(texts: list[Text], notes: list[str]) -> SensorRecord | None:
    tables = {
        text.name.lower(): read_table(text, 0, ",")
        for text in texts
        if text.lines and "seconds_elapsed" in text.lines[0].split(",")
    }
    if not tables:
        return None
    times_s, force = _specific_force(tables)
    size = float(np.median(np.linalg.norm(force, axis=1)))
    if 0.5 < size < 2.0:
        force = force * STANDARD_GRAVITY_MPS2
        notes.append("accelerations were converted from g")
    if _is_of_an_iphone(texts):
        force = -force
        notes.append("accelerations were negated, since an iPhone reports the opposite sign")
    turn = orientation = None
    if "gyroscope" in tables:
        table = tables["gyroscope"]
        turn = interpolated(times_s, table.column(_TIME), table.columns(*_AXES))
    if "orientation" in tables and tables["orientation"].has("qw", "qx", "qy", "qz"):
        table = tables["orientation"]
        values = from_z_up(normalised(table.columns("qw", "qx", "qy", "qz")))
        orientation = interpolated_rotations(times_s, table.column(_TIME), values)
    return SensorRecord(times_s, force, turn, orientation)


def _specific_force(tables: dict[str, Table]) -> tuple[Floats, Floats]:
    for name in _WITH_GRAVITY:
        if name in tables:
            return _checked(tables[name])
    if "accelerometer" in tables and "gravity" in tables:
        times_s, linear = _checked(tables["accelerometer"])
        return times_s, linear + interpolated(times_s, *_checked(tables["gravity"]))
    table = next(iter(tables.values()))
    raise RecordingError(
        table.path,
        1,
        "has no acceleration with gravity; record TotalAcceleration too",
    )


def _checked(table: Table) -> tuple[Floats, Floats]:
    times_s, values = table.column(_TIME), table.columns(*_AXES)
    check_finite(table, np.column_stack([times_s, values]), (_TIME, *_AXES))
    keep = np.concatenate([[True], np.diff(times_s) > 0])
    return times_s[keep], values[keep]


def _is_of_an_iphone(texts: list[Text]) -> bool:
    """Whether the axes are an iPhone's own, because the option to standardise frames was off."""
    for text in texts:
        if text.name.lower() == "metadata" and len(text.lines) > 1:
            table = read_table(text, 0, ",")
            metadata = dict(zip(table.header, table.first_row, strict=True))
            is_standardised = metadata.get("standardisation", "false").strip().lower() == "true"
            return metadata.get("platform", "").strip().lower() == "ios" and not is_standardised
    return False
