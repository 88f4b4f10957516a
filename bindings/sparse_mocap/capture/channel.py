# SPDX-License-Identifier: GPL-3.0-or-later
"""The control channel of a capture: a socket that no other user can use.

It is a Unix socket in the user's runtime folder. Where Python has none, as on Windows, or where the
folder's path is too long for one, it is a TCP socket on the loopback interface, which other users
can reach; what keeps them out is the session's token, the first line that a client must send. Both
kinds ask for it.
"""

from __future__ import annotations

import socket
from contextlib import suppress
from pathlib import Path

__all__ = ["connected", "listening", "remove"]

_BACKLOG = 128
_UNIX, _TCP = "unix:", "tcp:"
_ENDING = ".sock"


def listening(path: Path) -> tuple[socket.socket, str]:
    """Returns a listening socket, which does not block, and its address. Raises OSError.

    path: the session file; a Unix socket is put beside it.
    """
    listener = _unix_listener(path.with_suffix(_ENDING))
    address = f"{_UNIX}{path.with_suffix(_ENDING)}"
    if listener is None:
        listener = socket.create_server(("127.0.0.1", 0), backlog=_BACKLOG)
        address = f"{_TCP}{listener.getsockname()[1]}"
    listener.setblocking(False)
    return listener, address


def connected(address: str, timeout_s: float) -> socket.socket:
    """Returns a socket that is connected to an address of listening. Raises OSError, ValueError."""
    if address.startswith(_TCP):
        return socket.create_connection(("127.0.0.1", int(address[len(_TCP) :])), timeout_s)
    connection = socket.socket(socket.AF_UNIX)
    try:
        connection.settimeout(timeout_s)
        connection.connect(address.removeprefix(_UNIX))
    except BaseException:
        connection.close()
        raise
    return connection


def remove(path: Path) -> None:
    """Removes what a listener with this session file left in the folder."""
    with suppress(OSError):
        path.with_suffix(_ENDING).unlink()


def _unix_listener(path: Path) -> socket.socket | None:
    if not hasattr(socket, "AF_UNIX"):
        return None
    listener = socket.socket(socket.AF_UNIX)
    try:
        listener.bind(str(path))
        path.chmod(0o600)
        listener.listen(_BACKLOG)
    except OSError:  # the path is too long, or the file system has no sockets
        listener.close()
        return None
    return listener
