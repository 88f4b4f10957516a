# SPDX-License-Identifier: GPL-3.0-or-later
"""Session files: how clients find a running capture.

A capture listens on a local TCP port. The port is in ``capture-<pid>.json``, in a folder that only
the user can read, with a token that a client must send. A file left by a capture that has ended is
recognised because nothing answers on its port, or something that does not know the token.
"""

from __future__ import annotations

import json
import os
import socket
import tempfile
import time
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ..files import write_text

__all__ = [
    "Connection",
    "Session",
    "read_session",
    "runtime_folder",
    "session_path",
    "sessions",
    "write_session",
]

FOLDER_VARIABLE = "SPARSE_MOCAP_RUNTIME"
ANSWER_TIMEOUT_S = 5.0
_LONGEST_LINE = 1 << 20
_WRITTEN_WITHIN_S = 10.0


@dataclass(frozen=True)
class Session:
    """A capture that can be attached to."""

    pid: int
    tcp_port: int
    token: str
    folder: str
    """The folder of its logs."""
    unix_s: float
    """When it started."""
    ports: tuple[str, ...] = ()


class Connection:
    """A connection for requests and answers, each one line of JSON. Raises OSError."""

    def __init__(self, session: Session, greeting: str = "attach") -> None:
        """Attaches, or only checks that the capture is alive ("peek")."""
        self._socket = socket.create_connection(("127.0.0.1", session.tcp_port), ANSWER_TIMEOUT_S)
        self._file = self._socket.makefile("rb")
        try:
            if self.ask(greeting, token=session.token).get("pid") != session.pid:
                raise ConnectionRefusedError("this is not the capture of the session file")
        except BaseException:
            self.close()
            raise

    def ask(self, request: str, **arguments: Any) -> dict[str, Any]:
        """Sends a request and returns the answer."""
        self._socket.sendall(json.dumps({"do": request, **arguments}).encode() + b"\n")
        line = self._file.readline(_LONGEST_LINE)
        if not line.endswith(b"\n"):
            raise ConnectionResetError("the capture closed the connection")
        answer = json.loads(line)
        return answer if isinstance(answer, dict) else {}

    def close(self) -> None:
        """Detaches."""
        with suppress(OSError):
            self._file.close()
            self._socket.close()


def runtime_folder() -> Path:
    """The user's folder of session files, created if needed."""
    named = os.environ.get(FOLDER_VARIABLE)
    if named:
        folder = Path(named)
    elif os.environ.get("XDG_RUNTIME_DIR"):
        folder = Path(os.environ["XDG_RUNTIME_DIR"]) / "sparse-mocap"
    else:
        user = str(os.getuid()) if hasattr(os, "getuid") else "user"
        folder = Path(tempfile.gettempdir()) / f"sparse-mocap-{user}"
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    if hasattr(os, "getuid") and folder.stat().st_uid != os.getuid():
        raise PermissionError(13, "Belongs to another user", str(folder))
    return folder


def session_path(pid: int) -> Path:
    """The session file of the capture with that process id."""
    return runtime_folder() / f"capture-{pid}.json"


def write_session(session: Session) -> Path:
    """Writes a session file that only the user can read."""
    path = session_path(session.pid)
    path.touch(mode=0o600)
    write_text(path, json.dumps(asdict(session)))
    return path


def read_session(path: Path) -> Session | None:
    """Reads a session file; None when it is not complete (yet)."""
    try:
        value = json.loads(path.read_text(encoding="utf-8"))
        return Session(**{**value, "ports": tuple(value["ports"])})
    except (OSError, ValueError, TypeError, KeyError):
        return None


def sessions() -> list[Session]:
    """The running captures, oldest first; removes the files of those that have ended."""
    found = []
    for path in sorted(runtime_folder().glob("capture-*.json")):
        session = read_session(path)
        if session is not None and _is_alive(session):
            found.append(session)
            continue
        with suppress(OSError):
            if session is not None or time.time() - path.stat().st_mtime > _WRITTEN_WITHIN_S:
                path.unlink()
    return sorted(found, key=lambda session: session.unix_s)


def _is_alive(session: Session) -> bool:
    try:
        Connection(session, "peek").close()
    except TimeoutError:  # it listens but is busy or suspended
        return True
    except (OSError, ValueError):
        return False
    return True
