# SPDX-License-Identifier: GPL-3.0-or-later
"""The emulator: every driver's bytes are read back as the take, and faults come as told."""

from __future__ import annotations

import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import serial
from capture_support import DRIVER, some_take, until
from sparse_mocap import ConfigError, StreamEncoder, StreamParser, Take, driver_names
from sparse_mocap.capture import CaptureError, Emulator, Faults
from sparse_mocap.capture.drivers import parsed, start_commands
from sparse_mocap.capture.emulated_port import TcpPort
from sparse_mocap.capture.emulator import instants

FAST = 25.0
OPTIONS = {DRIVER: {"output": "mtdata", "num_sensors": "3"}}


class Host:
    """Opens an emulator's ports, answers like a capture, and hears until the take was played."""

    def __init__(self, emulator: Emulator) -> None:
        self.emulator = emulator
        self.heard = [b"" for _ in emulator.lines]
        self.parsers = [StreamParser(emulator.driver, **emulator.options) for _ in self.heard]
        self.samples: list[np.ndarray] = []

    def run(self) -> None:
        ports = [serial.serial_for_url(path, timeout=0.02) for path in self.emulator.plug_in()]
        thread = threading.Thread(target=self.emulator.run)
        thread.start()
        parts: list[list[np.ndarray]] = [[] for _ in ports]
        try:
            for port in ports:
                for command in start_commands(self.emulator.driver, self.emulator.options):
                    port.write(command)
            is_last = False
            while not is_last:
                is_last = self.emulator.is_done
                for index, port in enumerate(ports):
                    data = port.read(max(1, port.in_waiting))
                    # of a socket, in_waiting tells only whether there is something
                    data += port.read(4096 if self.emulator.over_tcp else port.in_waiting)
                    self.heard[index] += data
                    parts[index].append(parsed(self.parsers[index], data))
                    for reply in self.parsers[index].pop_replies():
                        port.write(reply)
        finally:
            for port in ports:
                port.close()
            thread.join()
            self.emulator.close()
        self.samples = [np.concatenate(part) for part in parts]


def played(take: Take, driver: str = DRIVER, speed: float = FAST, **how: Any) -> Host:
    how.setdefault("options", OPTIONS.get(driver, {}))
    host = Host(Emulator(take, driver, speed=speed, **how))
    host.run()
    return host


def is_gone(port: serial.Serial) -> bool:
    try:
        port.read(max(1, port.in_waiting))
    except OSError:
        return True
    return False


@pytest.mark.parametrize("driver", driver_names())
def test_every_driver_speaks_the_take(driver: str) -> None:
    take = some_take(1.0)
    host = played(take, driver, 10.0)
    assert host.emulator.num_overrun == 0
    has_heard(host, take)


def test_over_tcp_a_host_hears_the_take_too() -> None:
    take = some_take(1.0)
    has_heard(played(take, speed=2.0, over_tcp=True), take)


def has_heard(host: Host, take: Take) -> None:
    forces = [
        samples[samples["sensor"] == local]["specific_force"]
        for line, samples in zip(host.emulator.lines, host.samples, strict=True)
        for local in range(len(line.sensors))
    ]
    for record, force in zip(take.sensors.values(), forces, strict=True):
        sent = record.specific_force
        # The first may be the end of a line, the last may wait for its successor.
        assert len(sent) - 2 <= len(force) <= len(sent)
        begin = min(range(3), key=lambda at: abs(sent[at] - force[0]).sum())
        assert force == pytest.approx(sent[begin : begin + len(force)], abs=0.05)


def test_a_tcp_port_is_opened_left_and_plugged_in_again() -> None:
    port = TcpPort()
    url = port.plug_in()
    assert not port.is_open()
    assert port.send(b"nobody hears this")
    for data in (b"first", b"again"):
        with serial.serial_for_url(url, timeout=2.0) as host:
            until(port.is_open)
            assert port.send(data)
            assert host.read(5) == data
            host.write(b"answer")
            until(lambda: port.received() == b"answer")
        until(lambda: not port.is_open())
    host = serial.serial_for_url(url, timeout=0.02)
    until(port.is_open)
    port.unplug()
    until(lambda: is_gone(host))
    host.close()
    assert not port.is_plugged_in
    assert port.plug_in() == url
    port.unplug()
    with pytest.raises(CaptureError, match="no pseudo-terminals to link to"):
        TcpPort(Path("link"))


def test_lost_packets_are_counted_by_the_devices_counter() -> None:
    host = played(some_take(4.0), faults=Faults(loss=0.1, seed=5))
    (samples,) = host.samples
    counters = samples[samples["sensor"] == 0]["counter"]
    missing = 1 + counters[-1] - counters[0] - len(counters)
    assert 15 < missing < 70
    assert host.parsers[0].counters["missing_samples"] > 0


def test_faults_are_the_same_for_the_same_seed() -> None:
    def samples_with(seed: int) -> bytes:
        faults = Faults(loss=0.2, seed=seed)
        samples = played(some_take(1.0), "ximu3", faults=faults).samples
        return b"".join(part["device_time_s"].tobytes() for part in samples)

    assert samples_with(3) == samples_with(3) != samples_with(4)


def test_corrupted_packets_give_no_samples() -> None:
    host = played(some_take(2.0), faults=Faults(corruption=0.002, seed=1))
    (samples,) = host.samples
    assert 200 < len(samples) < 600
    assert abs(samples["specific_force"]).max() < 12.0
    assert host.parsers[0].counters["bad_checksums"] > 10


@pytest.mark.parametrize(
    "faults", [Faults(garbage=((0.5, 0.5),), seed=2), Faults(stalls=((0.5, 0.5),))]
)
def test_garbage_and_a_stall_are_holes_of_their_length(faults: Faults) -> None:
    samples = played(some_take(2.0), "ximu3", faults=faults).samples[0]
    steps = np.diff(samples["device_time_s"])
    assert steps.max() == pytest.approx(0.51, abs=0.02)
    assert len(samples) == pytest.approx(150, abs=2)


def test_a_reset_begins_the_devices_clock_anew() -> None:
    host = played(some_take(2.0), speed=5.0, faults=Faults(resets_s=(1.0,)))
    (samples,) = host.samples
    assert host.parsers[0].counters["device_resets"] == 2  # the first is its start
    assert len(samples) > 500
    assert (np.diff(samples[samples["sensor"] == 0]["device_time_s"]) > 0).all()


def test_a_duplicate_id_is_one_sensor_that_speaks_twice() -> None:
    take = some_take(1.0, 2)
    columns = {"columns": "time,sensor,counter,ax,ay,az"}
    single = played(take, "text_line", options=columns)
    double = played(take, "text_line", options=columns, faults=Faults(is_id_duplicate=True))
    assert sorted(single.parsers[0].sensor_names) == ["left_wrist", "right_wrist"]
    assert double.parsers[0].sensor_names == ["left_wrist"]
    counters = double.parsers[0].counters
    assert counters["repeated"] + counters["out_of_order"] > 50


@pytest.mark.skipif(sys.platform == "win32", reason="needs pseudo-terminals")
def test_a_cut_takes_the_port_away() -> None:
    emulator = Emulator(some_take(5.0), DRIVER, speed=FAST, faults=Faults(cut_after_s=1.0))
    (path,) = emulator.plug_in()
    with serial.Serial(path, timeout=0.02) as port:
        thread = threading.Thread(target=emulator.run)
        thread.start()
        until(lambda: is_gone(port))
        thread.join()
    assert not emulator.lines[0].port.is_plugged_in


def test_it_waits_for_a_host_and_is_paced() -> None:
    emulator = Emulator(some_take(1.0), DRIVER, speed=2.0)
    (path,) = emulator.plug_in()
    stop = threading.Event()
    thread = threading.Thread(target=lambda: emulator.run(stop.is_set))
    thread.start()
    assert emulator.num_sent == 0
    with serial.serial_for_url(path, timeout=0.02) as port:
        until(lambda: emulator.begin_ns > 0)
        until(lambda: port.read(100_000) == b"" and emulator.num_sent > 90)
    stop.set()
    thread.join()
    emulator.close()


def test_sensors_of_unlike_rates_are_each_sent_once() -> None:
    take = some_take(1.0)
    uneven = Take({site: record for site, record in take.sensors.items()})
    half = type(take.sensors["left_wrist"])(
        take.sensors["left_wrist"].times_s[::2], take.sensors["left_wrist"].specific_force[::2]
    )
    uneven.sensors["left_wrist"] = half
    groups = instants(uneven)
    assert sum(len(group) for _, group in groups) == 250
    assert all(len(np.unique(group["sensor"])) == len(group) for _, group in groups)
    times = [time for time, _ in groups]
    assert times == sorted(times)


def test_data_without_a_layout_make_the_host_ask_for_it() -> None:
    parser, device = StreamParser("xsens_mt"), StreamEncoder("xsens_mt", ["a", "b"])
    force = np.array([[0.0, 0.0, 9.8], [1.0, 2.0, 3.0]])
    for counter in range(3):
        assert len(parsed(parser, b"".join(device.encode(0.01 * counter, counter, force)))) == 0
    asked = parser.pop_replies()
    assert [packet[2] for packet in asked] == [0x30, 0x0C, 0x10]
    parser.feed(device.respond(b"".join(asked)))
    samples = parsed(parser, b"".join(device.encode(0.03, 3, force)))
    assert samples["specific_force"] == pytest.approx(force)
    assert parser.counters["unconfigured"] == 3


def test_a_driver_without_options_has_none_to_offer() -> None:
    with pytest.raises(ConfigError, match='no option "rate_hz"'):
        StreamParser("slimevr", rate_hz=100)
