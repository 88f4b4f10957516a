# SPDX-License-Identifier: GPL-3.0-or-later
"""Records sensors from a COM port of Windows, which is a pseudo-terminal of Linux."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from conftest import Windows
from sparse_mocap import SensorRecord, Take, read_take
from sparse_mocap.capture import Emulator

SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
RATE_HZ = 25.0  # a pseudo-terminal holds half a second of it, should Wine be slow
PLAYED_S = 40.0
RECORDED_S = 5.0
PORT = "COM9"
DRIVER, OPTIONS = "xsens_mt", {"output": "mtdata"}


@pytest.fixture
def take() -> Take:
    times_s = np.arange(round(PLAYED_S * RATE_HZ)) / RATE_HZ
    swing = np.sin(times_s[:, None] * [3.0, 2.0, 1.0])
    return Take(
        {
            site: SensorRecord(times_s, (1.0 + index) * swing + [0.0, 0.0, 9.8], 0.5 * swing)
            for index, site in enumerate(SITES)
        }
    )


@pytest.fixture
def port(take: Take) -> Iterator[str]:
    """The emulated sensors on a port that Wine knows."""
    link = Path(os.environ["SPARSE_MOCAP_WINE_DEVICES"]) / PORT.lower()
    stop = threading.Event()
    emulator = Emulator(take, DRIVER, OPTIONS, link_path=link)
    emulator.plug_in()
    thread = threading.Thread(target=lambda: emulator.run(stop.is_set))
    thread.start()
    yield PORT
    stop.set()
    thread.join()
    emulator.close()


def test_a_take_is_recorded_from_a_com_port(
    windows: Windows, port: str, take: Take, tmp_path: Path
) -> None:
    path = tmp_path / "take.csv"
    options = [word for name, value in OPTIONS.items() for word in ("--option", f"{name}={value}")]
    words = ("--port", port, "--driver", DRIVER, *options, "--seconds", RECORDED_S, "-o", path)
    print(windows("-m", "sparse_mocap", "record", "--sites", ",".join(SITES), *words))
    recorded = read_take(path)
    assert set(recorded.sensors) == set(SITES)
    for site, sensor in recorded.sensors.items():
        assert len(sensor.times_s) > 0.9 * RECORDED_S * RATE_HZ
        assert np.diff(sensor.times_s).max() < 1.5 / RATE_HZ, "samples are missing"
        played = take.sensors[site].specific_force
        nearest = np.abs(played[None] - sensor.specific_force[:, None]).max(axis=2).min(axis=1)
        assert nearest.max() < 0.01, "not what the sensors sent"
    assert not path.with_suffix(".capture").exists()
