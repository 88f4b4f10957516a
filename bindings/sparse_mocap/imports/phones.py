# SPDX-License-Identifier: GPL-3.0-or-later
"""Exports of several phones in one folder or zip: each phone's files lie together."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import PurePath

from ..take import SensorRecord
from .tables import Text

__all__ = ["read_phones"]

Reader = Callable[[list[Text], list[str]], SensorRecord | None]


def read_phones(
    texts: list[Text], notes: list[str], read: Reader
) -> dict[str, SensorRecord] | None:
    """Returns a record for each export among the texts, by the name of its folder or zip.

    A single one is called phone. None when there is none. Each starts at its own time 0.
    """
    records: dict[str, SensorRecord] = {}
    for folder, own in _exports(texts).items():
        record = read(own, notes)
        if record is not None:
            records[_name(folder, records)] = record
    if len(records) < 2:
        return dict(zip(["phone"], records.values(), strict=False)) or None
    notes.append(
        "each phone's times start at 0: synchronize them by a clap, with `sparse-mocap merge` or "
        "`reconstruct --clap`"
    )
    return {
        name: SensorRecord(
            record.times_s - record.times_s[0],
            record.specific_force,
            record.angular_velocity,
            record.orientation,
        )
        for name, record in records.items()
    }


def _exports(texts: list[Text]) -> dict[PurePath, list[Text]]:
    """The texts by the folder of their export, whose subfolder meta describes the phone."""
    exports: dict[PurePath, list[Text]] = {}
    for text in texts:
        folder = PurePath(text.path).parent
        exports.setdefault(folder.parent if folder.name == "meta" else folder, []).append(text)
    return exports


def _name(folder: PurePath, taken: dict[str, SensorRecord]) -> str:
    name = folder.name.removesuffix(".zip") or "phone"
    number = 2
    unique = name
    while unique in taken:
        unique, number = f"{name} {number}", number + 1
    return unique
