# SPDX-License-Identifier: GPL-3.0-or-later
"""A device that falls silent: when live readings are true again, and how long the take is."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from capture_support import SITES, some_take
from sparse_mocap import ReadingStream, SensorInput, filtered_at
from sparse_mocap.capture import (
    CaptureConfig,
    Emulator,
    Faults,
    LinkConfig,
    recording_to_take,
    start_capture,
)
from sparse_mocap.readings import push_samples

RATE_HZ = 25.0
TOLERANCE_MPS2 = 0.2
"""What a wrong time of 0.07 s makes of some_take()."""
DRIVERS: dict[str, tuple[int, dict[str, str]]] = {
    "xsens_mt": (2, {"output": "mtdata"}),
    "witmotion": (1, {}),
    "witmotion_ble": (1, {}),
    "ximu3": (1, {}),
    "text_line": (2, {"columns": "time,sensor,ax,ay,az"}),
    "slimevr": (2, {}),
}
"""How many sensors one device of each driver has, and its options."""


@dataclass(frozen=True)
class Found:
    """What a silence did."""

    back_s: float
    """The longest time from the return of the data until all readings were true."""
    length_error: float
    """Of the take against the wall clock, as a part."""
    num_false: int
    """Finite readings that were wrong, apart from the half second after each return."""


def silence(folder: Path, driver: str, seconds: float, faults: Faults, plays: int = 1) -> Found:
    """Plays a take with faults, follows it live and records it."""
    num_sensors, options = DRIVERS[driver]
    take = some_take(seconds, num_sensors)
    emulator = Emulator(
        take, driver, dict(options), faults=faults, link_path=folder / f"port-{driver}"
    )
    emulator.plug_in()
    begins_s: list[float] = []

    def play() -> None:
        for _ in range(plays):
            emulator.run()
            begins_s.append(emulator.begin_ns * 1e-9)

    thread = threading.Thread(target=play)
    thread.start()
    link = LinkConfig(str(folder / f"port-{driver}"), driver, options=options)
    config = CaptureConfig((link,), SITES[:num_sensors], must_record=True)
    readings = []
    with start_capture(config, folder / f"c-{driver}-{time.perf_counter_ns()}") as client:
        inputs = [SensorInput(site) for site in SITES[:num_sensors]]
        stream = ReadingStream(inputs, RATE_HZ)
        while thread.is_alive():
            push_samples(stream, list(range(num_sensors)), client.read())
            now_s = time.perf_counter()
            ready = stream.ready(now_s)
            readings += [
                (now_s, at_s, force)
                for at_s, force in zip(ready.times_s, ready.specific_force, strict=True)
            ]
            time.sleep(0.01)
        where = client.folder
        client.stop()
    emulator.close()
    recorded = recording_to_take(where)
    length_s = recorded.take.end_s - recorded.take.begin_s
    true_s = begins_s[-1] + float(take.end_s) - begins_s[0]
    back_s, num_false = _judged(readings, take, begins_s, faults, seconds)
    return Found(back_s, abs(length_s / true_s - 1.0), num_false)


def _judged(
    readings: list[tuple[float, float, np.ndarray]],
    take: object,
    begins_s: list[float],
    faults: Faults,
    seconds: float,
) -> tuple[float, int]:
    """Returns back_s and num_false."""
    returns_s = _returns(begins_s, faults)
    back = dict.fromkeys(returns_s, np.inf)
    num_false = 0
    for now_s, at_s, force in readings:
        begin_s = max((b for b in begins_s if b <= at_s), default=begins_s[0])
        expected = _expected(take, at_s - begin_s)
        is_true = bool(np.isfinite(force).all() and abs(force - expected).max() < TOLERANCE_MPS2)
        since = [r for r in returns_s if r <= at_s]
        if is_true and since and np.isinf(back[since[-1]]):
            back[since[-1]] = now_s - since[-1]
        settled = not since or at_s - since[-1] > 0.5
        inside = 0.2 < at_s - begin_s < seconds - 0.2
        is_wrong = np.isfinite(force).all() and not is_true
        num_false += bool(settled and inside and is_wrong)
    return max(back.values(), default=0.0), num_false


def _returns(begins_s: list[float], faults: Faults) -> list[float]:
    """When data returned, on the machine's clock."""
    begin_s = begins_s[0]
    returns = [begin_s + at + length for at, length in faults.stalls]
    returns += [begin_s + at for at in faults.resets_s]
    if faults.cut_after_s is not None and faults.replug_after_s is not None:
        returns.append(begin_s + faults.cut_after_s + faults.replug_after_s)
    return sorted([*returns, *begins_s[1:]])


def _expected(take: object, at_s: float) -> np.ndarray:
    at = np.array([at_s])
    return np.array([
        filtered_at(record.times_s, record.specific_force, at)[0]
        for record in take.sensors.values()  # type: ignore[attr-defined]
    ])  # fmt: skip
