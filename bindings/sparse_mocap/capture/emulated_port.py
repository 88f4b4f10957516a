# SPDX-License-Identifier: GPL-3.0-or-later
"""The ports of emulated devices: pseudo-terminals, or TCP ports on systems without them."""

from __future__ import annotations

import errno
import os
import select
import socket
from pathlib import Path
from typing import Protocol

from .errors import CaptureError

__all__ = ["EmulatedPort", "PseudoTerminal", "TcpPort"]

_HOST = "127.0.0.1"
_MOST_BYTES = 4096


class EmulatedPort(Protocol):
    """What an emulated device sends to and receives from."""

    def plug_in(self) -> str:
        """Creates the port and returns the name by which a host opens it."""

    def unplug(self) -> None:
        """Removes it."""

    @property
    def is_plugged_in(self) -> bool:
        """Whether it is there."""

    def is_open(self) -> bool:
        """Whether a host has it open."""

    def send(self, data: bytes) -> bool:
        """Sends what fits into the host's buffer; returns False when that was not all."""

    def received(self) -> bytes:
        """What the host sent."""


class PseudoTerminal:
    """A serial port as programs see it; with a symbolic link to it, if asked for."""

    def __init__(self, link_path: Path | None = None) -> None:
        self._link_path = link_path
        self._master = -1

    def plug_in(self) -> str:
        """Creates the pseudo-terminal in raw mode, so that nothing is echoed or changed."""
        import tty

        self._master, slave = os.openpty()
        tty.setraw(slave)
        path = os.ttyname(slave)
        os.close(slave)
        os.set_blocking(self._master, False)
        if self._link_path is not None:
            beside = self._link_path.with_name(f".{self._link_path.name}.{os.getpid()}")
            beside.symlink_to(path)
            beside.replace(self._link_path)
        return path

    def unplug(self) -> None:
        """Removes the pseudo-terminal."""
        if self._master >= 0:
            os.close(self._master)
            self._master = -1
        if self._link_path is not None:
            self._link_path.unlink(missing_ok=True)

    @property
    def is_plugged_in(self) -> bool:
        """Whether it is there."""
        return self._master >= 0

    def is_open(self) -> bool:
        """Whether a host has it open."""
        if self._master < 0:
            return False
        poller = select.poll()
        poller.register(self._master, 0)
        return not any(event & select.POLLHUP for _, event in poller.poll(0))

    def send(self, data: bytes) -> bool:
        """Sends what fits into the host's buffer; returns False when that was not all."""
        if not self.is_open():  # a closed port does not buffer
            return True
        try:
            return os.write(self._master, data) == len(data)
        except BlockingIOError:
            return False
        except OSError as error:
            if error.errno != errno.EIO:
                raise
            return False

    def received(self) -> bytes:
        """What the host sent."""
        try:
            return os.read(self._master, _MOST_BYTES)
        except (BlockingIOError, OSError):
            return b""


class TcpPort:
    """A TCP port of this machine, for one host at a time; its number stays when it is unplugged."""

    def __init__(self, link_path: Path | None = None) -> None:
        if link_path is not None:
            raise CaptureError(
                f"{link_path}: this system has no pseudo-terminals to link to; use the port's URL"
            )
        self._number = 0
        self._listener: socket.socket | None = None
        self._host: socket.socket | None = None

    def plug_in(self) -> str:
        """Starts to listen, and returns the URL."""
        self._listener = socket.create_server((_HOST, self._number), backlog=1)
        self._listener.setblocking(False)
        self._number = self._listener.getsockname()[1]
        return f"socket://{_HOST}:{self._number}"

    def unplug(self) -> None:
        """Ends the connection and the listening."""
        for one in (self._host, self._listener):
            if one is not None:
                one.close()
        self._host = self._listener = None

    @property
    def is_plugged_in(self) -> bool:
        """Whether it listens."""
        return self._listener is not None

    def is_open(self) -> bool:
        """Whether a host is connected."""
        if self._host is not None and not self._has_left(self._host):
            return True
        self._host = None
        if self._listener is None:
            return False
        try:
            self._host, _ = self._listener.accept()
        except OSError:
            return False
        self._host.setblocking(False)
        self._host.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return True

    def send(self, data: bytes) -> bool:
        """Sends what fits into the host's buffer; returns False when that was not all."""
        if not self.is_open() or self._host is None:
            return True
        try:
            return self._host.send(data) == len(data)
        except OSError:
            return False

    def received(self) -> bytes:
        """What the host sent."""
        try:
            return self._host.recv(_MOST_BYTES) if self._host is not None else b""
        except OSError:
            return b""

    @staticmethod
    def _has_left(host: socket.socket) -> bool:
        try:
            has_left = host.recv(1, socket.MSG_PEEK) == b""
        except BlockingIOError:
            return False
        except OSError:
            has_left = True
        if has_left:
            host.close()
        return has_left
