# SPDX-License-Identifier: GPL-3.0-or-later
"""Emulators in threads of the tests, and a runtime folder of their own."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from capture_support import DRIVER, OPTIONS, Play, stop_captures
from sparse_mocap import Take
from sparse_mocap.capture import Emulator
from sparse_mocap.capture.remembered_sites import FILE_VARIABLE
from sparse_mocap.capture.session import FOLDER_VARIABLE


@pytest.fixture(autouse=True)
def runtime(
    tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Path]:
    """Whatever a test leaves running is ended."""
    folder = tmp_path_factory.mktemp("runtime")
    monkeypatch.setenv(FOLDER_VARIABLE, str(folder))
    monkeypatch.setenv(FILE_VARIABLE, str(tmp_path_factory.mktemp("settings") / "sensors.json"))
    yield folder
    stop_captures()


@pytest.fixture
def play() -> Iterator[Play]:
    """Starts an emulator in a thread of this process; ports are up when it returns."""
    stop = threading.Event()
    started: list[tuple[Emulator, threading.Thread]] = []

    def start(take: Take, driver: str = DRIVER, **how: Any) -> Emulator:
        emulator = Emulator(take, driver, how.pop("options", OPTIONS), **how)
        emulator.plug_in()
        thread = threading.Thread(target=lambda: emulator.run(stop.is_set))
        thread.start()
        started.append((emulator, thread))
        return emulator

    yield start
    stop.set()
    for emulator, thread in started:
        thread.join()
        emulator.close()
