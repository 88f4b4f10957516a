# SPDX-License-Identifier: GPL-3.0-or-later
"""A link's states, over real pseudo-terminals, pyserial's loop and ports that fail in every way."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import serial
from sparse_mocap.capture import link as link_module
from sparse_mocap.capture.config import LinkConfig
from sparse_mocap.capture.errors import LogError, PortError
from sparse_mocap.capture.link import Arrived, Link, State
from sparse_mocap.capture.ports import PortInfo, open_port

termios = pytest.importorskip("termios", reason="needs pseudo-terminals")
tty = pytest.importorskip("tty", reason="needs pseudo-terminals")


class Notes:
    """A sink: every byte 's' is a sample, every '?' wants a '!'."""

    def __init__(self) -> None:
        self.states: list[State] = []
        self.messages: list[str] = []
        self.data = b""
        self.connections: list[str] = []
        self.is_full = False
        self.pause_s = 0.0

    def connected(self, link: int, port: str, device: str) -> tuple[bytes, ...]:
        self.connections.append(port)
        return (b"go",)

    def keep_alive(self, link: int) -> tuple[bytes, ...]:
        return ()

    def arrived(self, link: int, arrival_ns: int, data: bytes, sender: str) -> Arrived:
        if self.is_full:
            raise LogError("/full: No space left on device; free some space")
        assert 0 <= time.perf_counter_ns() - arrival_ns < 5 * 10**9
        time.sleep(self.pause_s)
        self.pause_s = 0.0
        self.data += data
        return Arrived(data.count(b"s"), (b"!",) * data.count(b"?"))

    def changed(self, link: int, state: State, message: str) -> None:
        self.states.append(state)
        self.messages.append(message)


def until(is_so: Callable[[], Any], timeout_s: float = 10.0) -> None:
    end = time.perf_counter() + timeout_s
    while not is_so():
        assert time.perf_counter() < end, "it never happened"
        time.sleep(0.005)


@pytest.fixture(autouse=True)
def impatience(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(link_module, "STALL_S", 0.3)
    monkeypatch.setattr(link_module, "UNDECODED_S", 0.5)
    monkeypatch.setattr(link_module, "REOPEN_S", 1.2)


@pytest.fixture
def links() -> Iterator[Callable[..., tuple[Link, Notes]]]:
    made: list[Link] = []

    def make(port: str, *, baud: int = 115200, **how: Any) -> tuple[Link, Notes]:
        notes = Notes()
        link = Link(0, LinkConfig(port, "letters", baud), notes, **how)
        made.append(link)
        link.start()
        return link, notes

    yield make
    for link in made:
        link.stop()
        assert link._thread is not None
        assert not link._thread.is_alive()


class Device:
    """The other end of a pseudo-terminal, found by a symbolic link."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.plug_in()

    def plug_in(self) -> None:
        self.master, slave = os.openpty()
        tty.setraw(slave)
        self.name = os.ttyname(slave)
        os.close(slave)
        self.path.unlink(missing_ok=True)
        self.path.symlink_to(self.name)

    def unplug(self) -> None:
        os.close(self.master)
        self.path.unlink()

    def send(self, data: bytes) -> None:
        os.write(self.master, data)


@pytest.fixture
def device(tmp_path: Path) -> Iterator[Device]:
    device = Device(tmp_path / "port")
    yield device
    os.close(device.master)


Links = Callable[..., tuple[Link, Notes]]


def test_a_link_opens_configures_streams_and_stops(links: Links, device: Device) -> None:
    link, notes = links(str(device.path))
    until(lambda: link.state is State.CONFIGURING)
    assert os.read(device.master, 10) == b"go"
    device.send(b"boot text\r\n")
    until(lambda: notes.data == b"boot text\r\n")
    device.send(b"s?s")
    until(lambda: link.state is State.STREAMING)
    assert os.read(device.master, 10) == b"!"
    link.stop()
    assert notes.states == [
        State.OPENING, State.CONFIGURING, State.STREAMING, State.DISCONNECTED,
    ]  # fmt: skip
    assert link.num_bytes == len(b"boot text\r\ns?s")


def test_every_byte_value_comes_as_it_was_sent(links: Links, device: Device) -> None:
    _, notes = links(str(device.path))
    until(lambda: notes.connections)
    everything = bytes(range(256)) * 40
    for begin in range(0, len(everything), 1000):
        device.send(everything[begin : begin + 1000])
        until(lambda count=begin + 1000: len(notes.data) >= min(count, len(everything)))
    assert notes.data == everything


def test_unplugged_and_back_under_another_name(links: Links, device: Device) -> None:
    link, notes = links(str(device.path))
    until(lambda: notes.connections)
    device.send(b"s")
    until(lambda: link.state is State.STREAMING)
    first = device.name
    device.unplug()
    until(lambda: link.state is State.RECONNECTING)
    taken = os.openpty()  # so that the name is not given again
    until(lambda: "no such port" in link.message)
    device.plug_in()
    back = time.perf_counter()
    until(lambda: len(notes.connections) == 2)
    device.send(b"s")
    until(lambda: link.state is State.STREAMING)
    assert time.perf_counter() - back < 2.0
    assert device.name != first
    assert link.num_reconnects == 1
    assert link.message == ""
    for end in taken:
        os.close(end)


def test_the_device_is_followed_by_its_numbers(links: Links, device: Device) -> None:
    usb = PortInfo("?", "", 1, 2, "A")
    name = device.name
    _, notes = links(
        "/dev/ttyUSB0",
        device_of=lambda port: usb,
        name_of=lambda asked, known: device.name if known in (None, usb) else asked,
    )
    until(lambda: notes.connections == [name])
    device.unplug()
    device.plug_in()
    until(lambda: len(notes.connections) == 2)
    assert notes.connections[1] == device.name


def test_another_device_at_the_port_is_not_taken_for_the_sensors(
    links: Links, device: Device
) -> None:
    found = [PortInfo("?", "", 1, 2, "A")]
    link, notes = links(
        "/dev/ttyUSB0", device_of=lambda port: found[0], name_of=lambda asked, known: device.name
    )
    until(lambda: notes.connections)
    device.unplug()
    found[0] = PortInfo("?", "", 1, 2, "B")
    device.plug_in()
    until(lambda: "another device is plugged in there; plug A in again" in link.message)
    assert len(notes.connections) == 1


def test_a_port_that_only_its_name_would_tell_is_given_up(
    links: Links, device: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(link_module, "GIVE_UP_S", 0.4)
    link, notes = links(str(device.path))
    until(lambda: notes.connections)
    device.unplug()
    until(lambda: link.state is State.FAILED)
    device.plug_in()


def test_unknown_baud_rates_are_tried_in_turn(
    links: Links, device: Device, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(link_module, "TRY_BAUD_S", 0.2)
    bauds: list[int] = []

    def opened(port: str, baud: int) -> Any:
        bauds.append(baud)
        return open_port(port, baud)

    link, _ = links(str(device.path), baud=0, opener=opened)
    until(lambda: len(bauds) == 3)
    right = bauds[-1]

    def streams() -> bool:
        device.send(b"s" if link.baud == right else b"x")
        return link.state is State.STREAMING

    until(streams)
    time.sleep(0.5)
    assert (link.baud, bauds[-1]) == (right, right)
    assert bauds[:3] == list(link_module.USUAL_BAUDS[:3])


def test_silence_is_a_stall_and_then_another_try(links: Links, device: Device) -> None:
    link, notes = links(str(device.path))
    until(lambda: notes.connections)
    device.send(b"s")
    until(lambda: link.state is State.STALLED)
    assert "no data for 0.3 s" in link.message
    device.send(b"s")
    until(lambda: link.state is State.STREAMING)
    until(lambda: len(notes.connections) == 2)
    assert any("check that the device is on" in message for message in notes.messages)


def test_bytes_that_mean_nothing_raise_the_question(links: Links, device: Device) -> None:
    link, notes = links(str(device.path))
    until(lambda: notes.connections)

    def puzzled() -> bool:
        device.send(b"\x00\xff")
        return "check the protocol and the baud rate (115200)" in link.message

    until(puzzled)
    assert link.state is State.CONFIGURING


def test_the_text_of_a_boot_is_borne(links: Links, device: Device) -> None:
    link, notes = links(str(device.path))
    until(lambda: notes.connections)
    for _ in range(4):
        device.send(b"Initializing I2C device\r\n".replace(b"s", b"z"))
        time.sleep(0.1)
    device.send(b"s")
    until(lambda: link.state is State.STREAMING)
    assert notes.states == [State.OPENING, State.CONFIGURING, State.STREAMING]
    assert not any(notes.messages)


def test_a_port_that_never_opened_fails_with_a_message(links: Links, tmp_path: Path) -> None:
    link, notes = links(str(tmp_path / "nothing"))
    until(lambda: link.state is State.FAILED)
    assert "no such port" in link.message
    assert notes.states == [State.OPENING, State.FAILED]


def test_a_full_disk_fails_with_a_message(links: Links, device: Device) -> None:
    link, notes = links(str(device.path))
    until(lambda: notes.connections)
    notes.is_full = True
    device.send(b"s")
    until(lambda: link.state is State.FAILED)
    assert "No space left" in link.message


def test_a_busy_disk_does_not_make_the_wire_run_over(links: Links, device: Device) -> None:
    _, notes = links(str(device.path))
    until(lambda: notes.connections)
    notes.pause_s = 1.0
    os.set_blocking(device.master, False)
    everything = bytes(range(256)) * 1000  # four times what the system buffers
    for begin in range(0, len(everything), 1000):
        device.send(everything[begin : begin + 1000])
        time.sleep(0.002)
    until(lambda: len(notes.data) == len(everything))
    assert notes.data == everything


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_what_nobody_thought_of_is_told(links: Links) -> None:
    def opener(port: str, baud: int) -> Any:
        raise NotImplementedError("no such thing")

    link, _ = links("new://thing", opener=opener)
    until(lambda: link.state is State.FAILED)
    assert "no such thing" in link.message


def test_pyserials_loop(links: Links) -> None:
    _, notes = links("loop://")
    until(lambda: notes.data == b"go")


class Broken:
    """A port of which one call fails in a given way, as pyserial's do at an unplug."""

    def __init__(self, call: str, error: Exception) -> None:
        self.call, self.error = call, error
        self.is_closed = False

    def _do(self, call: str) -> None:
        if call == self.call:
            raise self.error

    @property
    def in_waiting(self) -> int:
        self._do("in_waiting")
        return 0

    def read(self, size: int) -> bytes:
        self._do("read")
        time.sleep(0.01)
        return b"?"

    def write(self, data: bytes) -> int:
        self._do("write")
        return len(data)

    def close(self) -> None:
        self.is_closed = True
        self._do("close")


ERRORS = [
    serial.SerialException("device reports readiness to read but returned no data"),
    OSError(5, "Input/output error"),
    TypeError("'NoneType' object cannot be interpreted as an integer"),
    termios.error(5, "Input/output error"),
]


@pytest.mark.parametrize("call", ["in_waiting", "read", "write"])
@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
def test_however_a_port_breaks_it_is_opened_again(
    links: Links, call: str, error: Exception
) -> None:
    broken, whole = Broken(call, error), Broken("", error)
    opened = iter([broken, PortError("/dev/x: no such port"), whole])

    def opener(port: str, baud: int) -> Broken:
        result = next(opened)
        if isinstance(result, Exception):
            raise result
        return result

    link, notes = links("/dev/x", opener=opener, device_of=lambda port: None)
    until(lambda: len(notes.connections) == 2)
    assert broken.is_closed
    assert State.RECONNECTING in notes.states
    until(lambda: link.state is State.CONFIGURING)


def test_a_port_that_cannot_even_be_closed_is_let_go(links: Links) -> None:
    broken = Broken("close", OSError(5, "Input/output error"))
    link, notes = links("/dev/x", opener=lambda port, baud: broken, device_of=lambda port: None)
    until(lambda: notes.connections)
    link.stop()
    assert link.state is State.DISCONNECTED


def test_stopping_does_not_wait_for_a_silent_device(links: Links, device: Device) -> None:
    link, notes = links(str(device.path))
    until(lambda: notes.connections)
    begin = time.perf_counter()
    link.stop()
    assert time.perf_counter() - begin < 2.0
    open_port(str(device.path), 115200).close()
