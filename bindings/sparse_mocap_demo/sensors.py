# SPDX-License-Identifier: GPL-3.0-or-later
"""The demonstration's sensors: emulated over a pseudo-terminal, and recorded as real ones are."""

from __future__ import annotations

import shutil
import threading
import time
from collections.abc import Callable
from pathlib import Path

from sparse_mocap import Cancelled
from sparse_mocap.capture import CaptureClient, Emulator
from sparse_mocap.capture.recording import recording_to_take
from sparse_mocap.take import Take

Progress = Callable[[int, int, str], object]

_DRIVER = "xsens_mt"
_SPEED = 4.0
"""The device sends its own time, so that a take played faster is recorded as it was."""
_FIRST_SAMPLE_S = 20.0
_LAST_SAMPLE_S = 0.3


def record_emulated(take: Take, folder: Path, progress: Progress) -> Take:
    """Plays a take on emulated sensors and returns what the capture recorded of it.

    The capture's logs lie in the folder meanwhile. Raises CaptureError, RecordingError, Cancelled.
    """
    shutil.rmtree(folder, ignore_errors=True)
    emulator = Emulator(take, _DRIVER, speed=_SPEED)
    (port,) = emulator.plug_in()
    must_end = threading.Event()
    player = threading.Thread(target=emulator.run, args=(must_end.is_set,))
    player.start()
    try:
        with CaptureClient.start(port, _DRIVER, folder) as client:
            client.record()
            client.wait_for_samples(_FIRST_SAMPLE_S)
            _follow(emulator, player, take.end_s - take.begin_s, progress)
            client.stop_recording()
            client.stop()
        return recording_to_take(folder, sites=tuple(take.sites)).take
    finally:
        must_end.set()
        player.join()
        emulator.close()
        shutil.rmtree(folder, ignore_errors=True)


def _follow(
    emulator: Emulator, player: threading.Thread, duration_s: float, progress: Progress
) -> None:
    total = round(1000 * duration_s)
    while player.is_alive():
        played_s = (time.perf_counter_ns() - emulator.begin_ns) * 1e-9 * _SPEED
        if progress(min(round(1000 * played_s), total), total, "") is False:
            raise Cancelled("cancelled")
        time.sleep(0.05)
    time.sleep(_LAST_SAMPLE_S)
