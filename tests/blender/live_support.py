# SPDX-License-Identifier: GPL-3.0-or-later
"""An emulator in a thread, and captures with a runtime folder of their own. No bpy here."""

from __future__ import annotations

import atexit
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

DRIVER, OPTIONS = "xsens_mt", "output=mtdata"


@contextmanager
def emulated(take: Any, options: dict[str, str] | None = None, **faults: Any) -> Iterator[str]:
    """The port at which the take is played again and again, however long a busy machine needs.

    take: or a function that returns the take to play now; another one begins at once.
    options: the driver's; None: {"output": "mtdata"}, accelerometers without a device's clock.
    """
    from sparse_mocap.capture import Emulator, Faults

    doing = take if callable(take) else lambda: take

    class Performer(Emulator):
        def schedule(self) -> Iterator[tuple[float, Any]]:
            return _again_and_again(doing)

    emulator = Performer(doing(), DRIVER, options or {"output": "mtdata"}, faults=Faults(**faults))
    stop = threading.Event()
    [port] = emulator.plug_in()
    thread = threading.Thread(target=lambda: emulator.run(stop.is_set))
    thread.start()
    try:
        yield port
    finally:
        stop.set()
        thread.join()
        emulator.close()


def _again_and_again(doing: Callable[[], Any]) -> Iterator[tuple[float, Any]]:
    """What is sent, and when in s, as doing() says."""
    from sparse_mocap.capture.emulator import instants, period_s

    known: dict[int, list[tuple[float, Any]]] = {}
    begin_s = 0.0
    while True:
        take = doing()
        if id(take) not in known:
            known[id(take)] = instants(take)
        next_s = begin_s
        for time_s, samples in known[id(take)]:
            if doing() is not take:
                break
            yield begin_s + time_s, samples
            next_s = begin_s + time_s + period_s(take)
        begin_s = next_s


def part_of(take: Any, begin_s: float, end_s: float) -> Any:
    """What the sensors read from one time to the other."""
    from sparse_mocap import Take

    parts = {}
    for site, record in take.sensors.items():
        is_in = (record.times_s >= begin_s) & (record.times_s < end_s)
        values = {
            name: None if value is None else value[is_in] for name, value in vars(record).items()
        }
        parts[site] = replace(record, **values)
    return Take(parts)


@contextmanager
def own_runtime(folder: Path) -> Iterator[None]:
    """Captures and remembered sensors are in that folder alone; captures are ended afterwards."""
    from sparse_mocap.capture import CaptureClient, CaptureError
    from sparse_mocap.capture.remembered_sites import FILE_VARIABLE
    from sparse_mocap.capture.session import FOLDER_VARIABLE, sessions

    before = os.environ.get(FOLDER_VARIABLE)
    os.environ[FOLDER_VARIABLE] = str(folder)
    os.environ[FILE_VARIABLE] = str(folder / "sensors.json")
    try:
        yield
    finally:
        for session in sessions():
            with suppress(CaptureError):
                CaptureClient(session).stop()
        os.environ.pop(FOLDER_VARIABLE)
        os.environ.pop(FILE_VARIABLE)
        if before is not None:
            os.environ[FOLDER_VARIABLE] = before


def until(is_so: Callable[[], Any], timeout_s: float = 20.0) -> None:
    """Wait until it is so; fails when it never is."""
    end = time.perf_counter() + timeout_s
    while not is_so():
        assert time.perf_counter() < end, "it never happened"
        time.sleep(0.01)


@cache
def serial_folder() -> Path:
    """A folder from which pyserial can be imported, and now is; for Blenders without it.

    Raises Skipped when there is none.
    """
    from support import Skipped, addon

    addon("session.core").capture()  # knows the one in the release file
    known = importlib.util.find_spec("serial")
    if known is not None and known.submodule_search_locations:
        return Path(known.submodule_search_locations[0]).parent
    folder = Path(tempfile.mkdtemp(prefix="sparse_mocap_serial_"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    code = "import serial; print(serial.__path__[0])"
    python = shutil.which("python") or "python3"
    found = subprocess.run([python, "-c", code], capture_output=True, text=True, check=False)
    if found.returncode != 0:
        raise Skipped("pyserial is not installed")
    (folder / "serial").symlink_to(found.stdout.strip())
    sys.path.append(str(folder))
    return folder
