# SPDX-License-Identifier: GPL-3.0-or-later
"""Recordings of other programs, recognised by their content."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..take import SensorRecord, Take, devices_of, read_take
from ..take_file import device_comment
from . import phyphox, sensor_logger, ximu3, xsens_dot, xsens_mt_manager
from .tables import RecordingError, Text, find_line, read_texts, shown

__all__ = ["read_recording", "recording_formats"]

Reader = Callable[[list[Text], list[str]], dict[str, SensorRecord] | None]


@dataclass(frozen=True)
class _Format:
    name: str
    read: Reader


_FORMATS = tuple(
    _Format(module.NAME, module.read)
    for module in (xsens_mt_manager, xsens_dot, ximu3, phyphox, sensor_logger)
)


def recording_formats() -> list[str]:
    """Returns the names of the formats that read_recording knows."""
    return [*(known.name for known in _FORMATS), "take file"]


def read_recording(path: str | os.PathLike[str], sites: Mapping[str, str] | None = None) -> Take:
    """Returns the take in a recording: a file, a folder or a zip.

    The format is recognised by its content. Sensors keep their own names unless ``sites`` has a
    site for them. Times begin at 0. The take's comments list all conversions. Raises RecordingError
    and OSError.
    """
    if not os.path.exists(path):
        raise FileNotFoundError(2, "No such file or directory", os.fspath(path))
    texts = read_texts(path)
    if len(texts) == 1 and find_line(texts[0], "time_s", "sensor", "ax") is not None:
        take = read_take(path)
        named = _named(path, take.sensors, sites or {})
        return Take(named, _renamed(take, list(named)))
    for known in _FORMATS:
        notes: list[str] = []
        records = known.read(texts, notes)
        if records is not None:
            origin = f"imported from {Path(path).name} ({known.name})"
            named = _named(path, _from_zero(records), sites or {})
            devices = [device_comment(*pair) for pair in zip(named, records, strict=True)]
            return Take(named, (origin, *devices, *dict.fromkeys(notes)))
    raise RecordingError(
        path, 0, f"unknown recording format ({_content(texts)}); supported are "
        + ", ".join(recording_formats())
    )  # fmt: skip


def _renamed(take: Take, names: list[str]) -> tuple[str, ...]:
    """The take's comments, with its devices under new names."""
    devices = devices_of(take)
    old = {device_comment(name, identity) for name, identity in devices.items()}
    new = [
        device_comment(name, devices[before])
        for before, name in zip(take.sensors, names, strict=True)
        if before in devices
    ]
    return (*(comment for comment in take.comments if comment not in old), *new)


def _from_zero(records: dict[str, SensorRecord]) -> dict[str, SensorRecord]:
    begin = min(float(record.times_s[0]) for record in records.values())
    return {
        name: SensorRecord(
            np.asarray(record.times_s - begin),
            record.specific_force,
            record.angular_velocity,
            record.orientation,
        )
        for name, record in records.items()
    }


def _named(
    path: str | os.PathLike[str], records: dict[str, SensorRecord], sites: Mapping[str, str]
) -> dict[str, SensorRecord]:
    unknown = [name for name in sites if name not in records]
    if unknown:
        raise RecordingError(
            path, 0, f"has no sensor {unknown[0]!r}; it has {', '.join(map(repr, records))}"
        )
    named = {sites.get(name, name).replace(",", " "): record for name, record in records.items()}
    if len(named) < len(records):
        raise RecordingError(
            path, 0, "two of its sensors would have the same name; choose other locations"
        )
    return named


def _content(texts: list[Text]) -> str:
    if not texts:
        return "it contains no .csv, .txt or .json"
    first = next((line for line in texts[0].lines if line.strip()), "")
    return f"{len(texts)} text files, the first starts with {shown(first)}"
