# SPDX-License-Identifier: GPL-3.0-or-later
"""A UDP socket with the interface of a serial port, for sensors that send over Wi-Fi."""

from __future__ import annotations

import socket
from contextlib import suppress
from urllib.parse import urlsplit

__all__ = ["UdpPort"]

SCHEME = "udp://"
_LONGEST_DATAGRAM = 65_536
_MOST_SENDERS = 64
"""Those that were silent for longest go first."""


class UdpPort:
    """Listens at ``udp://HOST:PORT``."""

    in_waiting = 0

    def __init__(self, url: str, timeout_s: float) -> None:
        address = urlsplit(url)
        if not address.hostname or not address.port:
            raise ValueError("is not udp://HOST:PORT, such as udp://0.0.0.0:6969")
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.settimeout(timeout_s)
            self._socket.bind((address.hostname, address.port))
        except BaseException:
            self._socket.close()
            raise
        self._senders: dict[str, tuple[str, int]] = {}
        self._answered: set[str] = set()
        self.sender = ""
        """Sender of the datagram that was just read; empty without one."""

    def read(self, size: int) -> bytes:
        """Returns a whole datagram, or nothing after the timeout."""
        try:
            data, address = self._socket.recvfrom(_LONGEST_DATAGRAM)
        except (TimeoutError, ConnectionResetError):
            # On Windows, reading reports that a datagram sent before was refused.
            self.sender = ""
            return b""
        self.sender = f"{address[0]}:{address[1]}"
        self._senders.pop(self.sender, None)
        if len(self._senders) >= _MOST_SENDERS:
            silent = next(iter(self._senders))
            self._senders.pop(silent)
            self._answered.discard(silent)
        self._senders[self.sender] = address
        return data

    def write(self, data: bytes) -> int:
        """Sends a datagram to every sender that was answered before; strangers get none."""
        for sender in tuple(self._answered):
            self.send_to(sender, data)
        return len(data)

    def send_to(self, receiver: str, data: bytes) -> None:
        """Sends a datagram to one of the senders; one that cannot be sent is lost, as on radio."""
        address = self._senders.get(receiver)
        if address is not None:
            self._answered.add(receiver)
            with suppress(OSError):  # a sender may be gone, or have had no port
                self._socket.sendto(data, address)

    def close(self) -> None:
        """Stops listening."""
        self._socket.close()
