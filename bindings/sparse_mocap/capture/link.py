# SPDX-License-Identifier: GPL-3.0-or-later
"""A link: one port, opened again whenever its device is unplugged.

One thread reads and adds time stamps, another writes and decodes what was read.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import StrEnum
from queue import Empty, SimpleQueue
from typing import Any, Protocol

from .config import LinkConfig
from .diagnosis import why_no_bytes, why_no_samples
from .drivers import KEEP_ALIVE_S, START_PAUSE_S
from .errors import LogError, PortError
from .ports import PORT_ERRORS, READ_TIMEOUT_S, PortInfo, device_at, open_port, port_of

__all__ = ["Arrived", "Link", "Sink", "State"]

FIRST_BACKOFF_S = 0.1
LONGEST_BACKOFF_S = 1.0
"""So that a recording continues within 2 s after plugging in again."""
STALL_S = 1.0
"""Without a sample for this long a link is stalled."""
REOPEN_S = 5.0
"""Without a byte for this long the port is opened again: some adapters hang without an error."""
UNDECODED_S = 2.0
"""Without a sample for this long the message says why, as far as the data shows it."""
USUAL_BAUDS = (115200, 9600, 57600, 38400, 230400, 460800, 921600, 19200)
TRY_BAUD_S = 1.5
"""How long each is tried when the baud rate is not known."""
GIVE_UP_S = 60.0
"""A port that is gone for so long and whose device cannot be recognised elsewhere has failed."""
_USUAL_KEEP_ALIVE_S = 1.0
_MAY_REST = ("slimevr",)
"""Drivers whose devices send nothing while they are still."""
_MOST_KEPT = 100  # reads, to explain why they give no samples
LONGEST_READ = 4096
MOST_WAITING = 10_000
"""Reads that may wait for a slow disk."""


class State(StrEnum):
    """What a link is doing."""

    DISCONNECTED = "disconnected"
    OPENING = "opening"
    CONFIGURING = "configuring"
    STREAMING = "streaming"
    STALLED = "stalled"
    RECONNECTING = "reconnecting"
    FAILED = "failed"


@dataclass(frozen=True)
class Arrived:
    """The result of some bytes."""

    num_samples: int = 0
    replies: tuple[bytes, ...] = ()
    """Answers that the protocol requires, and the start commands if the device restarted."""


class Sink(Protocol):
    """Receives the data of a link. Called from the link's thread."""

    def connected(self, link: int, port: str, device: str) -> tuple[bytes, ...]:
        """The port was opened; returns the start commands. device: its USB adapter's identity."""

    def keep_alive(self, link: int) -> tuple[bytes, ...]:
        """What must be sent to the device every second."""

    def arrived(self, link: int, arrival_ns: int, data: bytes, sender: str) -> Arrived:
        """Bytes arrived, or a datagram when there is a sender. Raises LogError."""

    def changed(self, link: int, state: State, message: str) -> None:
        """The link's state or message changed."""


@dataclass
class Link:
    """Reads a port in a thread of its own until it is stopped.

    A port that cannot be opened at first fails with a message. One that was open before is opened
    again until that succeeds; its device is found by its serial number, whatever the port's name.
    """

    index: int
    config: LinkConfig
    sink: Sink
    opener: Callable[[str, int], Any] = open_port
    device_of: Callable[[str], PortInfo | None] = device_at
    name_of: Callable[[str, PortInfo | None], str] = port_of

    state: State = State.DISCONNECTED
    message: str = ""
    opened_as: str = ""
    baud: int = 0
    """The speed that is used or tried."""
    num_bytes: int = 0
    num_reconnects: int = 0
    _device: PortInfo | None = None
    _was_open: bool = False
    _has_streamed: bool = False
    _num_tried: int = 0
    _next_reason_s: float = 0.0
    _kept: deque[bytes] = field(default_factory=lambda: deque(maxlen=_MOST_KEPT))
    _stop: threading.Event = field(default_factory=threading.Event)
    _thread: threading.Thread | None = None

    def start(self) -> None:
        """Starts the thread."""
        self._thread = threading.Thread(target=self._run, name=f"link-{self.index}", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """Stops the thread, which closes the port, and waits for it."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join(timeout=10.0)

    def _run(self) -> None:
        backoff_s, gone_since_s = FIRST_BACKOFF_S, None
        while not self._stop.is_set():
            try:
                port = self._opened()
                gone_since_s = None
                reason = self._handled(port)
                backoff_s = FIRST_BACKOFF_S
            except PortError as error:
                reason = str(error)
                gone_since_s = gone_since_s or time.perf_counter()
                if not self._was_open or self._is_lost(time.perf_counter() - gone_since_s):
                    return self._enter(State.FAILED, reason)
            except LogError as error:
                return self._enter(State.FAILED, str(error))
            except Exception as error:
                # No other thread waits for this one: report the error here.
                self._enter(State.FAILED, f"{self.config.port}: {error!r}")
                raise
            if not self._stop.is_set():
                self._enter(State.RECONNECTING, reason)
                self._stop.wait(backoff_s)
                backoff_s = min(2 * backoff_s, LONGEST_BACKOFF_S)
        return self._enter(State.DISCONNECTED)

    def _opened(self) -> Any:
        if not self._was_open:
            self._enter(State.OPENING)
        name = self.name_of(self.config.port, self._device)
        self.baud = self.config.baud or USUAL_BAUDS[self._num_tried % len(USUAL_BAUDS)]
        found = self.device_of(name)
        if (
            self._device is not None
            and found is not None
            and not found.is_same_device(self._device)
        ):
            raise PortError(
                f"{name}: another device is plugged in there; plug {self._device.identity} in again"
            )
        port = self.opener(name, self.baud)
        self.num_reconnects += self._was_open
        self._was_open, self.opened_as = True, name
        self._device = found or self._device
        return port

    def _is_lost(self, gone_s: float) -> bool:
        """Whether waiting for the port is in vain: only its name would tell its return."""
        return self._device is None and "://" not in self.config.port and gone_s > GIVE_UP_S

    def _handled(self, port: Any) -> str:
        """Handles an open port and returns why it was closed."""
        try:
            self._enter(State.CONFIGURING)
            self._kept.clear()
            self._write(
                port,
                self.sink.connected(
                    self.index, self.opened_as, self._device.identity if self._device else ""
                ),
            )
            return self._read(port)
        except PORT_ERRORS as error:
            return f"{self.opened_as}: the connection was lost ({_short(error)}); plug it in again"
        finally:
            _close(port)

    def _read(self, port: Any) -> str:
        inbox: SimpleQueue[_Item | Exception] = SimpleQueue()
        is_over = threading.Event()
        reader = threading.Thread(target=_fetch, args=(port, inbox, is_over), daemon=True)
        reader.start()
        try:
            reason = self._handle(port, inbox)
        finally:
            is_over.set()
            reader.join()  # a port must not be closed under a read
        while isinstance(item := _next(inbox, 0.0), _Item):
            self.sink.arrived(self.index, item.arrival_ns, item.data, item.sender)
        return reason

    def _handle(self, port: Any, inbox: SimpleQueue[_Item | Exception]) -> str:
        keep_alive_s = KEEP_ALIVE_S.get(self.config.driver, _USUAL_KEEP_ALIVE_S)
        timeout_s = min(READ_TIMEOUT_S, keep_alive_s)
        opened_s = time.perf_counter()
        last_byte_s = last_sample_s = last_keep_alive_s = opened_s
        while not self._stop.is_set():
            item = _next(inbox, timeout_s)
            if isinstance(item, Exception):
                raise item
            if item is not None:
                last_byte_s = item.arrival_ns * 1e-9
                if self._take(port, item):
                    last_sample_s = last_byte_s
            now_s = last_byte_s if item is not None else time.perf_counter()
            if now_s - last_keep_alive_s > keep_alive_s:
                last_keep_alive_s = now_s
                self._write(port, self.sink.keep_alive(self.index))
            if self._must_try_next_baud(now_s - opened_s):
                return f"{self.opened_as}: no samples at {self.baud} baud; trying another rate"
            if now_s - last_byte_s > REOPEN_S and not self._is_socket:
                return f"{self.opened_as}: {why_no_bytes(self.config)}"
            self._report_silence(now_s - last_byte_s, now_s - last_sample_s)
        return ""

    def _take(self, port: Any, item: _Item) -> bool:
        """Passes on what was read; returns whether there were samples in it."""
        self.num_bytes += len(item.data)
        came = self.sink.arrived(self.index, item.arrival_ns, item.data, item.sender)
        self._write(port, came.replies, item.sender)
        if not came.num_samples:
            self._kept.append(item.data)
            return False
        self._kept.clear()
        self._has_streamed = True
        self._enter(State.STREAMING)
        return True

    @property
    def _is_socket(self) -> bool:
        """A socket cannot hang as an adapter does, so there is no use in opening it again."""
        return self.config.port.startswith("udp://")

    def _must_try_next_baud(self, open_s: float) -> bool:
        if self.config.baud or self._has_streamed or open_s < TRY_BAUD_S:
            return False
        self._num_tried += 1
        return True

    def _report_silence(self, without_byte_s: float, without_sample_s: float) -> None:
        if without_sample_s < STALL_S or (self._has_streamed and self.config.driver in _MAY_REST):
            return
        if self.state is State.STREAMING:
            self._enter(State.STALLED, f"{self.opened_as}: no data for {STALL_S:g} s")
        elif without_sample_s > UNDECODED_S and time.perf_counter() > self._next_reason_s:
            self._next_reason_s = time.perf_counter() + 1.0
            why = (
                why_no_samples(replace(self.config, baud=self.baud), list(self._kept))
                if self._kept and without_byte_s < UNDECODED_S
                else why_no_bytes(self.config)
            )
            self._enter(self.state, f"{self.opened_as}: {why}")

    def _write(self, port: Any, packets: tuple[bytes, ...], receiver: str = "") -> None:
        pause_s = START_PAUSE_S.get(self.config.driver, 0.0)
        for index, packet in enumerate(packets):
            if pause_s and index:
                self._stop.wait(pause_s)
            if receiver:
                port.send_to(receiver, packet)
            else:
                port.write(packet)

    def _enter(self, state: State, message: str = "") -> None:
        if (state, message) != (self.state, self.message):
            self.state, self.message = state, message
            self.sink.changed(self.index, state, message)


@dataclass(frozen=True)
class _Item:
    arrival_ns: int
    data: bytes
    sender: str
    """Of a datagram."""


def _fetch(port: Any, inbox: SimpleQueue[_Item | Exception], is_over: threading.Event) -> None:
    """Only reads, so that nothing is lost while the disk is busy for a second."""
    try:
        while not is_over.is_set():
            data = port.read(max(1, min(port.in_waiting, LONGEST_READ)))
            # rfc2217:// may know of one byte at a time.
            while data and len(data) < LONGEST_READ and (waiting := port.in_waiting):
                data += port.read(min(waiting, LONGEST_READ - len(data)))
            if data:
                inbox.put(_Item(time.perf_counter_ns(), data, getattr(port, "sender", "")))
            while inbox.qsize() > MOST_WAITING and not is_over.wait(0.01):
                pass
    except PORT_ERRORS as error:
        inbox.put(error)


def _next(
    inbox: SimpleQueue[_Item | Exception], timeout_s: float = READ_TIMEOUT_S
) -> _Item | Exception | None:
    try:
        return inbox.get(timeout=timeout_s)
    except Empty:
        return None


def _close(port: Any) -> None:
    try:
        port.close()
    except PORT_ERRORS:  # the device is gone
        return


def _short(error: Exception) -> str:
    text = " ".join(str(error).split())
    return text if len(text) < 120 else type(error).__name__
