# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole paths from a device: URLs over real sockets, ports of their own, a hub that is pulled."""

from __future__ import annotations

import os
import select
import socket
import threading
from collections.abc import Iterator
from contextlib import closing, suppress
from pathlib import Path

import numpy as np
import pytest
import serial
from capture_support import DRIVER, OPTIONS, Play, some_take, until
from numpy.typing import NDArray
from serial import rfc2217
from sparse_mocap.capture import CaptureConfig, LinkConfig, recording_to_take, start_capture
from sparse_mocap.capture.link import Arrived, Link, State
from sparse_mocap.capture.ports import PortInfo, device_at, port_of
from sparse_mocap.capture.sample_log import SampleLogReader

tty = pytest.importorskip("tty", reason="needs pseudo-terminals")

SCHEMES = ["socket", "rfc2217"]
pytestmark = pytest.mark.filterwarnings("ignore:set(Daemon|Name).. is deprecated")  # pyserial's


class Wire(serial.Serial):
    """A pseudo-terminal as a serial port; it has no modem lines."""

    cts = dsr = ri = cd = False

    def _update_dtr_state(self) -> None:
        pass

    def _update_rts_state(self) -> None:
        pass


class Bridge:
    """Serves a serial port to one who connects at a time, bare or by pyserial's RFC 2217."""

    def __init__(self, scheme: str, path: str) -> None:
        self.is_bare = scheme == "socket"
        self.port = Wire(path, timeout=0)
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.url = f"{scheme}://127.0.0.1:{self._listener.getsockname()[1]}"
        self._is_over = threading.Event()
        self._must_hang_up = threading.Event()
        self.num_served = 0
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def hang_up(self) -> None:
        self._must_hang_up.set()
        until(lambda: not self._must_hang_up.is_set())

    def close(self) -> None:
        self._is_over.set()
        self._thread.join()
        self._listener.close()
        self.port.close()

    def _run(self) -> None:
        while not self._is_over.is_set():
            if select.select([self._listener], [], [], 0.02)[0]:
                connection, _ = self._listener.accept()
                self.num_served += 1
                with closing(connection), suppress(OSError):
                    self._serve(connection)
                self._must_hang_up.clear()

    def _serve(self, connection: socket.socket) -> None:
        class Writer:
            write = staticmethod(connection.sendall)

        manager = None if self.is_bare else rfc2217.PortManager(self.port, Writer())
        while not (self._is_over.is_set() or self._must_hang_up.is_set()):
            ready = select.select([connection, self.port], [], [], 0.02)[0]
            if connection in ready:
                data = connection.recv(4096)
                if not data:
                    return
                self.port.write(b"".join(manager.filter(data)) if manager else data)
            if self.port in ready:
                data = self.port.read(4096)
                connection.sendall(b"".join(manager.escape(data)) if manager else data)


class Notes:
    """A sink that keeps everything."""

    def __init__(self) -> None:
        self.data = b""

    def connected(self, link: int, port: str, device: str) -> tuple[bytes, ...]:
        return (b"go",)

    def keep_alive(self, link: int) -> tuple[bytes, ...]:
        return ()

    def arrived(self, link: int, arrival_ns: int, data: bytes, sender: str) -> Arrived:
        self.data += data
        return Arrived(len(data))

    def changed(self, link: int, state: State, message: str) -> None:
        pass


class Terminal:
    """A pseudo-terminal whose other end is a device."""

    def __init__(self) -> None:
        self.master, slave = os.openpty()
        tty.setraw(slave)
        self.path = os.ttyname(slave)
        os.close(slave)

    def close(self) -> None:
        os.close(self.master)


@pytest.fixture
def terminal() -> Iterator[Terminal]:
    with closing(Terminal()) as terminal:
        yield terminal


@pytest.mark.parametrize("scheme", SCHEMES)
def test_every_byte_passes_both_ways_and_again_after_a_break(
    scheme: str, terminal: Terminal
) -> None:
    every = bytes(range(256)) * 8
    with closing(Bridge(scheme, terminal.path)) as bridge:
        notes = Notes()
        link = Link(0, LinkConfig(bridge.url, "letters", 57600), notes)
        link.start()
        try:
            for times in (1, 2):
                expected = times * every
                until(lambda: link.state is State.CONFIGURING)
                assert os.read(terminal.master, 2) == b"go"
                os.write(terminal.master, every)
                until(lambda: len(notes.data) >= len(expected))  # noqa: B023 - waits at once
                assert notes.data == expected
                assert bridge.is_bare or bridge.port.baudrate == 57600
                if times == 1:
                    bridge.hang_up()
                    until(lambda: bridge.num_served == 2)
            assert link.num_reconnects == 1
        finally:
            link.stop()


def ends_with(specific_force: NDArray[np.float64], folder: Path) -> bool:
    """Whether the newest sample of the log is this one: bytes may be on their way for a while."""
    with closing(SampleLogReader(folder)) as reader:
        received = reader.read()["specific_force"]
    return len(received) > 0 and bool(np.allclose(received[-1], specific_force, atol=1e-4))


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_capture_over_the_network_loses_nothing(scheme: str, play: Play, tmp_path: Path) -> None:
    options = {**OPTIONS, "num_sensors": "6"}
    take = some_take(4.0, 6, 50.0)
    last_sent = list(take.sensors.values())[-1].specific_force[-1]
    emulator = play(take, options=options)
    with closing(Bridge(scheme, emulator.lines[0].path)) as bridge:
        link = LinkConfig(bridge.url, DRIVER, options=options)
        config = CaptureConfig((link,), tuple(take.sites), must_record=True)
        with start_capture(config, tmp_path / "c") as client:
            until(lambda: emulator.is_done)
            until(lambda: ends_with(last_sent, tmp_path / "c"))
            client.stop()
    recorded = recording_to_take(tmp_path / "c")
    assert recorded.num_missing == 0
    for own, sent in zip(recorded.take.sensors.values(), take.sensors.values(), strict=True):
        # What the device sends before pyserial has set up the line is purged by it.
        assert len(own.times_s) > 100
        last = sent.specific_force[-len(own.times_s) :]
        assert own.specific_force == pytest.approx(last, abs=1e-4)
    # A record for each byte would make the log many times the data.
    assert (tmp_path / "c" / "raw.log").stat().st_size < 600 * 200


@pytest.mark.parametrize("columns", ["ax,ay,az,gx,gy,gz", "time,sensor,ax,ay,az"])
def test_not_even_the_first_line_of_text_is_lost(columns: str, play: Play, tmp_path: Path) -> None:
    take = some_take(1.5, 2)
    options = {"columns": columns}
    lines = play(take, "text_line", options=options).lines
    links = tuple(LinkConfig(line.path, "text_line", options=options) for line in lines)
    sites = tuple(take.sites)
    with start_capture(CaptureConfig(links, sites, must_record=True), tmp_path / "c") as client:
        until(lambda: client.status()["samples"] == 300)
        client.stop()
    recorded = recording_to_take(tmp_path / "c").take
    assert recorded.sites == take.sites
    for own, sent in zip(recorded.sensors.values(), take.sensors.values(), strict=True):
        assert own.specific_force == pytest.approx(sent.specific_force, abs=1e-4)


def test_a_hub_that_is_pulled_gives_every_link_its_own_device_back() -> None:
    plugged = {f"S{number}": Terminal() for number in range(4)}
    notes = {name: Notes() for name in plugged}
    # What the system calls a device is given again in another order.
    names = {name: terminal.path for name, terminal in plugged.items()}

    def ports() -> list[PortInfo]:
        return [PortInfo(path, "", 1, 2, name) for name, path in names.items()]

    links = [
        Link(
            index, LinkConfig(names[name], "letters"), notes[name],
            device_of=lambda port: device_at(port, ports),
            name_of=lambda asked, device: port_of(asked, device, ports),
        )
        for index, name in enumerate(plugged)
    ]  # fmt: skip
    for link in links:
        link.start()
    try:
        until(lambda: all(link.state is State.CONFIGURING for link in links))
        names.clear()
        for terminal in plugged.values():
            terminal.close()
        until(lambda: all(link.state is State.RECONNECTING for link in links))
        back = [Terminal() for _ in plugged]
        plugged = dict(zip(plugged, reversed(back), strict=True))
        names.update({name: terminal.path for name, terminal in plugged.items()})
        until(lambda: all(link.num_reconnects == 1 for link in links))
        for name, terminal in plugged.items():
            os.write(terminal.master, name.encode())
        until(lambda: all(notes[name].data == name.encode() for name in plugged))
    finally:
        for link in links:
            link.stop()
        for terminal in plugged.values():
            terminal.close()
