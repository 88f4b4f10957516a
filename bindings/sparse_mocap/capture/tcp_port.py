# SPDX-License-Identifier: GPL-3.0-or-later
"""A TCP connection with the interface of a serial port, for sensors behind a serial server.

pyserial's own tells only whether there is something to read, so that it must be read byte by byte.
"""

from __future__ import annotations

import select
import socket
from urllib.parse import urlsplit

import serial

__all__ = ["TCP_SCHEME", "TcpConnection"]

TCP_SCHEME = "socket://"
_CONNECT_TIMEOUT_S = 5.0
_MOST_BYTES = 65_536


class TcpConnection:
    """Connected to ``socket://HOST:PORT``."""

    def __init__(self, url: str, timeout_s: float) -> None:
        address = urlsplit(url)
        if not address.hostname or not address.port:
            raise ValueError("is not socket://HOST:PORT, such as socket://192.168.1.20:4001")
        self._socket = socket.create_connection(
            (address.hostname, address.port), _CONNECT_TIMEOUT_S
        )
        self._socket.settimeout(timeout_s)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    @property
    def in_waiting(self) -> int:
        """More than 0 if something can be read at once, and no less than what that is."""
        readable, _, _ = select.select([self._socket], [], [], 0)
        return _MOST_BYTES if readable else 0

    def read(self, size: int) -> bytes:
        """Returns up to so many bytes, or none after the timeout.

        Raises SerialException when the other end is gone.
        """
        try:
            data = self._socket.recv(size)
        except TimeoutError:
            return b""
        if not data:
            raise serial.SerialException("the other end closed the connection")
        return data

    def write(self, data: bytes) -> int:
        """Sends everything."""
        self._socket.sendall(data)
        return len(data)

    def close(self) -> None:
        """Ends the connection."""
        self._socket.close()
