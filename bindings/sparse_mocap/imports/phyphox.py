# SPDX-License-Identifier: GPL-3.0-or-later
"""CSV exports of phyphox (files or zip): a phone for each export."""

from __future__ import annotations

import numpy as np

from ..take import SensorRecord
from .phones import read_phones
from .tables import RecordingError, Table, Text, check_finite, interpolated, read_table

__all__ = ["read"]

NAME = "phyphox CSV"

_TIME = "Time (s)"
_FORCES = (
    tuple(f"Acceleration {axis} (m/s^2)" for axis in "xyz"),
    tuple(f"{axis} (m/s^2)" for axis in "XYZ"),
)
_LINEAR = "Linear Acceleration x (m/s^2)"
_RATES = tuple(f"Gyroscope {axis} (rad/s)" for axis in "xyz")


def read(texts: list[Text], notes: list[str]) -> dict[str, SensorRecord] | None:
    """Returns a record for each phone; None when it is another format."""
    return read_phones(texts, notes, _read)


def _read(texts: list[Text], _notes: list[str]) -> SensorRecord | None:
    tables = [table for text in texts if (table := _table(text)) is not None]
    if not tables:
        return None
    force_names: tuple[str, ...] = ()
    for table in tables:
        for names in _FORCES:
            if table.has(*names) and not force_names:
                force_table, force_names = table, names
    if not force_names:
        raise RecordingError(
            tables[0].path,
            1,
            "has no acceleration with gravity; record with phyphox's 'Acceleration (with g)'",
        )
    times_s, force = force_table.column(_TIME), force_table.columns(*force_names)
    check_finite(force_table, np.column_stack([times_s, force]), (_TIME, *force_names))
    keep = np.concatenate([[True], np.diff(times_s) > 0])
    times_s = times_s[keep]
    turn = None
    for table in tables:
        if table.has(*_RATES):
            turn = interpolated(times_s, table.column(_TIME), table.columns(*_RATES))
    return SensorRecord(times_s, force[keep], turn)


def _table(text: Text) -> Table | None:
    """Returns the table of a phyphox file with any separator and decimal sign."""
    head = text.lines[0] if text.lines else ""
    if not head.replace('"', "").startswith(_TIME):
        return None
    separator = (
        head.replace('"', "")[len(_TIME)] if len(head.replace('"', "")) > len(_TIME) else ","
    )
    if separator not in ",;\t":
        return None
    has_decimal_comma = separator != "," and any("," in line for line in text.lines[1:3])
    table = read_table(text, 0, separator, has_decimal_comma=has_decimal_comma)
    known = [*_RATES, _LINEAR, *(name for names in _FORCES for name in names)]
    return table if any(name in known for name in table.header) else None
