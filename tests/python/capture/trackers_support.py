# SPDX-License-Identifier: GPL-3.0-or-later
"""Four sensors in an order of their own, one of which is replugged meanwhile: SlimeVR trackers over
UDP, or devices on USB adapters, which are pseudo-terminals with made-up serial numbers."""

from __future__ import annotations

import socket
import struct
import threading
import time
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path

import numpy as np
from capture_support import SITES
from sparse_mocap import SensorRecord, Take
from sparse_mocap.capture import (
    CaptureConfig,
    Emulator,
    Faults,
    LinkConfig,
    PortInfo,
    recording_to_take,
    start_capture,
)
from sparse_mocap.capture.recorder import Recorder

NUM = 4
_STEP_S = 0.01
_LONGEST_S = 20.0


class Tracker:
    """Its acceleration along x says which it is."""

    def __init__(self, number: int, address: tuple[str, int]) -> None:
        self.number, self._packet = number, 1
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.connect(address)
        self._socket.settimeout(5.0)
        mac = bytes([0x24, 0xE6, 0xA1, 0, 0, number])
        self._socket.send(struct.pack(">iq7iB", 3, 0, *[0] * 6, 22, 0) + mac)
        assert self._socket.recv(100)[1:13] == b"Hey OVR =D 5"

    def send(self) -> None:
        self._packet += 2
        self._socket.send(struct.pack(">iq2B4fB", 17, self._packet, 0, 1, 0, 0, 0, 1, 0))
        self._socket.send(struct.pack(">iq3fB", 4, self._packet + 1, self.number + 1.0, 0, 0, 0))

    def close(self) -> None:
        self._socket.close()


def are_on_their_limbs(folder: Path, order: Sequence[int]) -> bool:
    """Whether each is recorded at its site, although the first one moves to another address."""
    with closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as free:
        free.bind(("127.0.0.1", 0))
        address = free.getsockname()
    site_of = {f"24:e6:a1:00:00:{number:02x}": SITES[number] for number in range(NUM)}
    link = LinkConfig(f"udp://{address[0]}:{address[1]}", "slimevr")
    running: list[Tracker] = []
    with start_capture(CaptureConfig((link,), site_of=site_of, must_record=True), folder) as client:
        while client.status()["links"][0]["state"] != "configuring":
            time.sleep(0.01)
        for number in (*order, order[0]):
            for old in [tracker for tracker in running if tracker.number == number]:
                running.remove(old)
                old.close()
            running.append(Tracker(number, address))
            for _ in range(10):
                for tracker in running:
                    tracker.send()
                time.sleep(_STEP_S)
        expected = 10 * sum(NUM + 1 - order.index(number) for number in range(NUM))
        end = time.perf_counter() + 10.0
        while client.status()["samples"] < expected and time.perf_counter() < end:
            time.sleep(0.02)
        client.stop()
    for tracker in running:
        tracker.close()
    take = recording_to_take(folder).take
    return sorted(take.sites) == sorted(SITES[:NUM]) and all(
        abs(take.sensors[SITES[number]].specific_force[:, 0] - number - 1.0).max() < 1e-3
        for number in range(NUM)
    )


def plugged_in(number: int, is_replugged: bool) -> Emulator:
    """A device without an identity of its own on a pseudo-terminal."""
    times_s = np.arange(150) / 100.0
    force = np.tile([number + 1.0, 0.0, 9.81], (len(times_s), 1))
    faults = Faults(cut_after_s=0.5, replug_after_s=0.2) if is_replugged else Faults()
    take = Take({"device": SensorRecord(times_s, force)})
    emulator = Emulator(take, "text_line", {"columns": "time,ax,ay,az"}, faults=faults)
    emulator.plug_in()
    return emulator


def adapters_are_on_their_limbs(folder: Path, order: Sequence[int]) -> bool:
    """Whether each is known by its adapter, whatever port it has and in whichever order."""
    folder.mkdir(parents=True)
    emulators = {number: plugged_in(number, number == order[0]) for number in order}
    settings = {"columns": "time,ax,ay,az"}
    links = tuple(
        LinkConfig(emulators[number].lines[0].path, "text_line", options=settings)
        for number in order
    )
    site_of = {f"SERIAL{number}": SITES[number] for number in range(NUM)}
    recorder = Recorder(folder, CaptureConfig(links, site_of=site_of, must_record=True))

    def device_of(port: str) -> PortInfo | None:
        for number, emulator in emulators.items():
            if emulator.lines[0].path == port:
                return PortInfo(port, "", 1, 2, f"SERIAL{number}")
        return None

    def name_of(port: str, device: PortInfo | None) -> str:
        if device is None or device.serial_number is None:
            return port
        return emulators[int(device.serial_number[-1])].lines[0].path

    for link in recorder.links:
        link.device_of, link.name_of = device_of, name_of
    late = threading.Event()
    threads = [
        threading.Thread(target=emulator.run, args=(late.is_set,))
        for emulator in emulators.values()
    ]
    for thread in threads:
        thread.start()
    recorder.start()
    end = time.perf_counter() + _LONGEST_S
    for thread in threads:
        thread.join(max(0.0, end - time.perf_counter()))
    late.set()
    recorder.stop()
    for emulator in emulators.values():
        emulator.close()
    take = recording_to_take(folder).take
    return sorted(take.sites) == sorted(SITES[:NUM]) and all(
        abs(take.sensors[SITES[number]].specific_force[:, 0] - number - 1.0).max() < 1e-3
        for number in range(NUM)
    )
