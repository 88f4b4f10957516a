# SPDX-License-Identifier: GPL-3.0-or-later
"""Ports: found again by their device's numbers, and errors that say what to do."""

from __future__ import annotations

import os
import socket
import sys
from pathlib import Path

import pytest
import serial
from sparse_mocap.capture import ports
from sparse_mocap.capture.errors import PortError
from sparse_mocap.capture.ports import PortInfo, device_at, open_port, port_of
from sparse_mocap.capture.udp_port import UdpPort

posix = pytest.mark.skipif(sys.platform == "win32", reason="ports of POSIX")

LEFT = PortInfo("/dev/ttyUSB0", "", 0x1A86, 0x7523, "A1", "QinHeng", "CH340", "1-1")
RIGHT = PortInfo("/dev/ttyUSB1", "", 0x1A86, 0x7523, "B2", "QinHeng", "CH340", "1-2")
NUMBERLESS = PortInfo("/dev/ttyUSB2", "", 0x1A86, 0x7523, None, None, None, "1-3")
BUILT_IN = PortInfo("/dev/ttyS0")


def moved(port: PortInfo, name: str, location: str | None = None) -> PortInfo:
    return PortInfo(
        name, port.description, port.vendor_id, port.product_id, port.serial_number,
        port.manufacturer, port.product, location or port.location,
    )  # fmt: skip


def test_a_device_is_found_under_another_name_by_its_serial_number() -> None:
    device = device_at(LEFT.port, lambda: [BUILT_IN, LEFT, RIGHT])
    assert device == LEFT
    swapped = [moved(RIGHT, "/dev/ttyUSB0"), moved(LEFT, "/dev/ttyUSB7", "2-4")]
    assert port_of(LEFT.port, device, lambda: swapped) == "/dev/ttyUSB7"


def test_a_device_without_a_number_is_found_by_where_it_is_plugged() -> None:
    there = [moved(NUMBERLESS, "/dev/ttyUSB5", "1-4"), moved(NUMBERLESS, "/dev/ttyUSB6")]
    assert port_of(NUMBERLESS.port, NUMBERLESS, lambda: there) == "/dev/ttyUSB6"


def test_another_device_is_not_taken_for_the_one_that_left() -> None:
    assert port_of(LEFT.port, LEFT, lambda: [RIGHT, NUMBERLESS, BUILT_IN]) == LEFT.port
    assert not BUILT_IN.is_same_device(BUILT_IN)


@posix
def test_urls_and_symbolic_links_are_opened_as_they_were_asked_for(tmp_path: Path) -> None:
    link = tmp_path / "wrist"
    link.symlink_to("/dev/ttyUSB0")
    assert device_at("socket://localhost:9", lambda: [LEFT]) is None
    assert port_of("socket://localhost:9", None, lambda: [LEFT]) == "socket://localhost:9"
    assert port_of(str(link), None, lambda: [LEFT]) == str(link)
    assert device_at(str(link), lambda: [LEFT]) == LEFT


def refusal(port: str) -> str:
    with pytest.raises(PortError) as error:
        open_port(port, 115200)
    text = str(error.value)
    assert text.startswith(f"{port}: ")
    assert "\n" not in text
    return text


def test_a_missing_port_says_so(tmp_path: Path) -> None:
    assert "no such port; plug the device in" in refusal(str(tmp_path / "ttyUSB0"))


@posix
def test_a_busy_port_says_so() -> None:
    master, slave = os.openpty()
    name = os.ttyname(slave)
    with open_port(name, 115200):
        assert "in use by another program" in refusal(name)
    open_port(name, 115200).close()
    os.close(master)
    os.close(slave)


@posix
def test_what_is_no_port_says_so(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("")
    assert "not a serial port" in refusal(str(file))
    assert "not a serial port" in refusal(str(tmp_path))


def test_nobody_at_the_other_end_says_so() -> None:
    assert "connection refused" in refusal("socket://127.0.0.1:1")
    assert "connection refused" in refusal("rfc2217://127.0.0.1:1")
    assert "protocol 'carrier-pigeon' not known" in refusal("carrier-pigeon://x")


@posix
def test_a_forbidden_port_names_the_group(monkeypatch: pytest.MonkeyPatch) -> None:
    def forbid(*_: object, **__: object) -> None:
        raise serial.SerialException(13, "could not open port /dev/ttyUSB0: [Errno 13] Permission")

    monkeypatch.setattr(ports.serial, "serial_for_url", forbid)
    assert "permission denied; add yourself to the port's group" in refusal("/dev/ttyUSB0")
    assert "dialout" in refusal("/dev/ttyUSB0")


def test_a_refused_datagram_does_not_end_the_reading(monkeypatch: pytest.MonkeyPatch) -> None:
    """On Windows, a read after a datagram that nobody took raises ConnectionResetError."""

    class Socket(socket.socket):
        refused = 2

        def recvfrom(self, size: int, flags: int = 0) -> tuple[bytes, tuple[str, int]]:
            if Socket.refused:
                Socket.refused -= 1
                raise ConnectionResetError(10054, "closed by the remote host")
            return super().recvfrom(size, flags)

    monkeypatch.setattr(socket, "socket", Socket)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        address = free.getsockname()
    port = UdpPort(f"udp://127.0.0.1:{address[1]}", 5.0)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sensor:
        sensor.sendto(b"a sample", address)
        assert [port.read(100) for _ in range(3)] == [b"", b"", b"a sample"]
        assert port.sender == "127.0.0.1:" + str(sensor.getsockname()[1])
    port.close()
