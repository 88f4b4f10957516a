# SPDX-License-Identifier: GPL-3.0-or-later
"""What nobody records is given up, and what is recorded is whole, whichever device sends."""

from __future__ import annotations

import random
import time
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from capture_support import SITES, some_take
from sparse_mocap import Take
from sparse_mocap.capture import (
    CaptureConfig,
    LinkConfig,
    recording_to_take,
    rolling_log,
    sample_log,
)
from sparse_mocap.capture.drivers import Encoder
from sparse_mocap.capture.emulator import instants
from sparse_mocap.capture.recorder import Recorder

RATE_HZ = 100.0
SETTINGS = {
    "Xbus": ("xsens_mt", 3, {"output": "mtdata", "num_sensors": "3"}),
    "MTi": ("xsens_mt", 1, {}),
    "WitMotion": ("witmotion", 1, {}),
    "WitMotion BLE": ("witmotion_ble", 1, {}),
    "x-IMU3": ("ximu3", 1, {}),
    "text": ("text_line", 1, {}),
    "text that names its columns": ("text_line", 3, {"columns": "header"}),
    "SlimeVR": ("slimevr", 2, {}),
}


class Sender:
    """A device that plays a take into a recorder, its bytes cut anywhere, on a clock made up."""

    def __init__(self, recorder: Recorder, name: str, clock_ns: list[int]) -> None:
        driver, num_sensors, options = SETTINGS[name]
        self.take = some_take(60.0, num_sensors, RATE_HZ)
        self._recorder, self._clock_ns, self._random = recorder, clock_ns, random.Random(name)
        self._encoder = Encoder(driver, self.take.sites, options)
        self._due = iter(instants(self.take))
        self._begin_ns = clock_ns[0]
        commands = recorder.connected(0, "port")
        data = b"".join(self._encoder.hello())
        self._arrive(data + b"".join(self._encoder.respond(command) for command in commands))

    def play(self, seconds: float) -> None:
        """Plays so much more of the take, at ten reads a second, looking after the log between."""
        pending = b""
        for number in range(round(seconds * RATE_HZ)):
            time_s, samples = next(self._due)
            pending += b"".join(self._encoder.encode(time_s, samples))
            self._clock_ns[0] = self._begin_ns + int(time_s * 1e9)
            if number % 10 == 9:
                cut = self._random.randrange(len(pending))
                self._arrive(pending[:cut])
                pending = pending[cut:]
            if number % 50 == 49:
                self._recorder.tick()
        self._arrive(pending)
        self._clock_ns[0] += 1_000_000

    def _arrive(self, data: bytes) -> None:
        if data:
            came = self._recorder.arrived(0, self._clock_ns[0], data)
            self._arrive(b"".join(self._encoder.respond(reply) for reply in came.replies))


@pytest.fixture
def clock_ns(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    monkeypatch.setattr(rolling_log, "FULL_BYTES", 8_000)
    monkeypatch.setattr(sample_log, "PER_FILE", 300)
    clock_ns = [10**12]
    monkeypatch.setattr(time, "perf_counter_ns", lambda: clock_ns[0])
    return clock_ns


@pytest.fixture
def recorder(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Recorder]:
    driver, num_sensors, options = SETTINGS[request.getfixturevalue("name")]
    config = CaptureConfig((LinkConfig("port", driver, options=options),), SITES[:num_sensors])
    recorder = Recorder(tmp_path, config)
    with closing(recorder._raw), closing(recorder._log):
        yield recorder


def size(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.iterdir())


def check_part(recorded: Take, played: Take, begin_s: float, end_s: float) -> None:
    """That it is the take from about begin to end, without a hole and without a wrong sample."""
    for own, sent in zip(recorded.sensors.values(), played.sensors.values(), strict=True):
        begin = round(begin_s * RATE_HZ)
        near = sent.specific_force[begin - 30 : begin + 31]
        first = begin - 30 + int(np.argmin(abs(near - own.specific_force[0]).sum(axis=1)))
        assert abs(len(own.times_s) - (end_s - begin_s) * RATE_HZ) <= 30
        part = sent.specific_force[first : first + len(own.times_s)]
        assert own.specific_force[: len(part)] == pytest.approx(part, abs=0.05)


@pytest.mark.parametrize("name", SETTINGS)
def test_what_is_recorded_amid_days_of_watching_is_whole(
    name: str, recorder: Recorder, clock_ns: list[int], tmp_path: Path
) -> None:
    device = Sender(recorder, name, clock_ns)
    device.play(20.0)
    assert not (tmp_path / "raw.log").exists()
    assert not (tmp_path / "samples.bin").exists()
    for _ in range(2):
        recorder.start_recording(None)
        device.play(8.0)
        recorder.stop_recording()
        device.play(12.0)
    both = [recording_to_take(tmp_path, number) for number in range(2)]
    for begin_s, recorded in zip((20.0, 40.0), both, strict=True):
        check_part(recorded.take, device.take, begin_s, begin_s + 8.0)
        assert recorded.num_missing == 0
        assert not recorded.gaps


@pytest.mark.parametrize("name", SETTINGS)
def test_watching_alone_needs_no_more_and_no_more_room(
    name: str, recorder: Recorder, clock_ns: list[int], tmp_path: Path
) -> None:
    device = Sender(recorder, name, clock_ns)
    sizes = []
    for _ in range(6):
        device.play(10.0)
        sizes.append(size(tmp_path))
    _, num_sensors, _ = SETTINGS[name]
    most_raw = 4 * (rolling_log.FULL_BYTES + 20_000) + 4_000
    assert max(sizes) < most_raw + 4 * 300 * 72 * num_sensors
    # What is left of it is readable, as after a crash, and holds no wrong sample.
    left = recording_to_take(tmp_path)
    length_s = left.take.end_s
    assert 0.5 < length_s < 40.0
    check_part(left.take, device.take, 60.0 - length_s, 60.0)


@pytest.mark.parametrize("name", ["text"])
def test_a_file_torn_at_its_begin_spoils_no_log(
    name: str, recorder: Recorder, clock_ns: list[int], tmp_path: Path
) -> None:
    device = Sender(recorder, name, clock_ns)
    device.play(20.0)
    recorder.start_recording(None)
    device.play(3.0)
    newest = max(int(path.name.split(".")[1]) for path in tmp_path.glob("raw.*.log"))
    whole = recording_to_take(tmp_path).take.sensors
    for torn in (b"", b"SMRAW", b"SMRAWLG1", b"SMRAWLG1\xf5\x4c\x03"):
        (tmp_path / f"raw.{newest + 1}.log").write_bytes(torn)
        again = recording_to_take(tmp_path).take.sensors
        assert {k: len(v.times_s) for k, v in again.items()} == {
            k: len(v.times_s) for k, v in whole.items()
        }
