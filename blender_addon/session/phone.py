# SPDX-License-Identifier: GPL-3.0-or-later
"""One phone: its recordings as takes, and how its app streams."""

from __future__ import annotations

from pathlib import Path

from .core import core, imports_module
from .errors import InputError
from .names import file_name
from .new_files import free_path
from .take import SUFFIX

PHONE_PORT = "udp://0.0.0.0:5005"
PHONE_DRIVER = "text_line"
PHONE_OPTIONS = "columns=time,ax,ay,az,gx,gy,gz, time_unit=s, angular_velocity_unit=rad/s"


def import_phone(recording: Path, folder: Path, site: str) -> tuple[str, tuple[str, ...]]:
    """Save a phone's recording as a take in the folder; returns its path and what was converted.

    Raises InputError for recordings of several sensors, and what is wrong with the file.
    """
    module = imports_module()
    take = module.read_recording(recording)
    names = list(take.sensors)
    if len(names) != 1:
        raise InputError(
            f"The recording has {len(names)} sensors, and one phone is expected: "
            "convert it with `sparse-mocap import`"
        )
    take = module.read_recording(recording, {names[0]: site})
    folder.mkdir(parents=True, exist_ok=True)
    path = free_path(folder / f"{file_name(recording.stem)}{SUFFIX}")
    core().write_take(path, take)
    return str(path), tuple(take.comments)
