# SPDX-License-Identifier: GPL-3.0-or-later
"""Serial ports: list them, open one, and find it again after it was unplugged."""

from __future__ import annotations

import errno
import os
import re
import sys
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass
from typing import Any

import serial
from serial.tools import list_ports

from .errors import PortError
from .tcp_port import TCP_SCHEME, TcpConnection
from .udp_port import SCHEME, UdpPort

__all__ = ["PortInfo", "available_ports", "device_at", "is_url", "open_port", "port_of"]

try:
    import termios

    _TERMIOS_ERRORS: tuple[type[Exception], ...] = (termios.error,)
except ImportError:  # not on Windows
    _TERMIOS_ERRORS = ()

PORT_ERRORS: tuple[type[Exception], ...] = (
    OSError,  # SerialException is one
    TypeError,  # read() of a port that another thread closed
    AttributeError,  # the same on Windows
    ValueError,  # the same of a socket
    *_TERMIOS_ERRORS,  # flush() and others after unplugging
)
"""What pyserial raises when a device is unplugged, depending on the call."""

READ_TIMEOUT_S = 0.1


@dataclass(frozen=True)
class PortInfo:
    """A serial port and the device behind it, as far as the system knows."""

    port: str
    description: str = ""
    vendor_id: int | None = None
    product_id: int | None = None
    serial_number: str | None = None
    manufacturer: str | None = None
    product: str | None = None
    location: str | None = None

    def is_same_device(self, other: PortInfo) -> bool:
        """Whether it is the same USB device, by serial number or else by USB location."""
        if self.vendor_id is None or (self.vendor_id, self.product_id) != (
            other.vendor_id,
            other.product_id,
        ):
            return False
        if self.serial_number or other.serial_number:
            return self.serial_number == other.serial_number
        return self.location == other.location

    @property
    def identity(self) -> str:
        """What tells the device from others wherever it is plugged in; else where that is."""
        if self.serial_number:
            return self.serial_number
        if self.vendor_id is None:
            return ""
        return f"{self.vendor_id:04x}:{self.product_id or 0:04x} at {self.location}"

    def as_json(self) -> dict[str, Any]:
        """As a JSON object."""
        return asdict(self)


def available_ports() -> list[PortInfo]:
    """The system's serial ports, those of USB devices first."""
    found = [
        PortInfo(
            port.device,
            "" if port.description in (None, "n/a") else port.description,
            port.vid,
            port.pid,
            port.serial_number,
            port.manufacturer,
            port.product,
            port.location,
        )
        for port in list_ports.comports()
    ]
    return sorted(found, key=lambda port: (port.vendor_id is None, port.port))


def device_at(
    port: str, ports: Callable[[], Iterable[PortInfo]] = available_ports
) -> PortInfo | None:
    """The USB device of a port; None for URLs, pseudo-terminals and unknown ports."""
    if is_url(port):
        return None
    real = os.path.realpath(port)
    for info in ports():
        if info.vendor_id is not None and real in (info.port, os.path.realpath(info.port)):
            return info
    return None


def port_of(
    port: str, device: PortInfo | None, ports: Callable[[], Iterable[PortInfo]] = available_ports
) -> str:
    """The current port name of the device, which may change when it is plugged in again."""
    if device is None:
        return port
    return next((info.port for info in ports() if info.is_same_device(device)), port)


def is_url(port: str) -> bool:
    """Whether the port is a URL."""
    return "://" in port


def open_port(port: str, baud: int) -> Any:
    """Opens a port, pyserial URL or udp://HOST:PORT exclusively. Raises PortError."""
    try:
        if port.startswith(SCHEME):
            return UdpPort(port, READ_TIMEOUT_S)
        if port.startswith(TCP_SCHEME):
            return TcpConnection(port, READ_TIMEOUT_S)
        return serial.serial_for_url(
            port, baudrate=baud, timeout=READ_TIMEOUT_S, exclusive=True,
            write_timeout=None if port.startswith("rfc2217://") else 1.0,  # it knows none
        )  # fmt: skip
    except PORT_ERRORS as error:
        raise PortError(_explained(port, error)) from error


def _explained(port: str, error: Exception) -> str:
    number, text = _error_number(error), str(error)
    if number in (errno.EACCES, errno.EPERM) or "PermissionError" in text:
        if sys.platform == "win32":
            return f"{port}: access denied; close other programs that use the port"
        return (
            f"{port}: permission denied; add yourself to the port's group "
            "(sudo usermod -a -G dialout $USER), then log out and in"
        )
    if number in (errno.ENOENT, errno.ENODEV, errno.ENXIO) or "FileNotFoundError" in text:
        return f"{port}: no such port; plug the device in (`sparse-mocap ports` lists all ports)"
    if number in (errno.EBUSY, errno.EAGAIN, errno.EADDRINUSE):
        return f"{port}: in use by another program; close that program"
    if number in (errno.ENOTTY, errno.EISDIR, errno.EINVAL):
        return f"{port}: not a serial port; `sparse-mocap ports` lists them"
    if number == errno.ECONNREFUSED:
        return f"{port}: connection refused; start the server for this port"
    return f"{port}: {' '.join(text.split()) or type(error).__name__}"


def _error_number(error: Exception) -> int | None:
    """The error's errno, which pyserial often has only in the message."""
    number = getattr(error, "errno", None)
    # What Windows' sockets report is an errno there; its other numbers are not.
    found = re.search(r"\[Errno (-?\d+)\]|\[WinError (1\d{4})\]|: \((\d+), '", str(error))
    if number is None and found:
        number = int(found[found.lastindex or 0])
    return number
