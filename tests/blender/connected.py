# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on connected to an emulator."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import bpy
from live_support import DRIVER, OPTIONS, emulated, own_runtime, serial_folder, until
from support import SITES, Skipped, addon, library, settings


@contextmanager
def connected(
    tmp_path: Path,
    take: Any = None,
    *,
    sites: Sequence[str] = SITES,
    options: str = OPTIONS,
) -> Iterator[object]:
    """A session with an emulator that plays a take, the library's when None, beside a saved file.

    take: as for emulated(). sites: of its sensors; options: the driver's.
    """
    if os.name == "nt":
        raise Skipped("there are no pseudo-terminals")
    serial_folder()
    import sparse_mocap

    (tmp_path / "runtime").mkdir(mode=0o700)
    if take is None:
        take = sparse_mocap.read_take(library().take)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    with own_runtime(tmp_path / "runtime"), emulated(take, as_dict(options)) as port:
        chosen = settings()
        chosen.port, chosen.driver, chosen.driver_options = port, DRIVER, options
        chosen.sites, chosen.database = ", ".join(sites), str(library().database)
        assert bpy.ops.sparse_mocap.connect_sensors() == {"FINISHED"}
        session = addon("session.live").current()
        until(lambda: session.state.error or len(session.state.sensors) == len(sites))
        assert session.state.error == ""
        try:
            yield session
        finally:
            session.close()


def as_dict(options: str) -> dict[str, str]:
    """Options of a driver as the emulator takes them."""
    return dict(part.split("=") for part in options.split(", "))
