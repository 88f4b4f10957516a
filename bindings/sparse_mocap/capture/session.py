# SPDX-License-Identifier: GPL-3.0-or-later
"""Session files: how clients find a running capture.

The address of a capture's control channel is in ``capture-<pid>.json``, in a folder that only the
user can read, with a token that a client must send. The capture keeps the file locked as long as
it runs; one that is not locked was left by a capture that was killed.
"""

from __future__ import annotations

import json
import os
import stat
import time
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from . import channel
from .errors import CaptureError
from .file_lock import lock, release
from .runtime_folder import FOLDER_VARIABLE, runtime_folder

__all__ = [
    "FOLDER_VARIABLE",
    "Connection",
    "Session",
    "SessionFile",
    "read_session",
    "runtime_folder",
    "session_path",
    "sessions",
]

ANSWER_TIMEOUT_S = 5.0
_LONGEST_LINE = 1 << 20
_WRITTEN_WITHIN_S = 10.0
_NO_FOLLOW = getattr(os, "O_NOFOLLOW", 0)


@dataclass(frozen=True)
class Session:
    """A capture that can be attached to."""

    pid: int
    address: str
    """Of its control channel."""
    token: str
    folder: str
    """The folder of its logs."""
    unix_s: float
    """When it started."""
    ports: tuple[str, ...] = ()


class Connection:
    """A connection for requests and answers, each one line of JSON. Raises OSError."""

    def __init__(self, session: Session) -> None:
        """Attaches."""
        self._socket = channel.connected(session.address, ANSWER_TIMEOUT_S)
        self._file = self._socket.makefile("rb")
        try:
            self._socket.sendall(session.token.encode() + b"\n")
            if self._answer().get("pid") != session.pid:
                raise ConnectionRefusedError("this is not the capture of the session file")
        except BaseException:
            self.close()
            raise

    def ask(self, request: str, **arguments: Any) -> dict[str, Any]:
        """Sends a request and returns the answer. Raises CaptureError when that is an error."""
        self._socket.sendall(json.dumps({"do": request, **arguments}).encode() + b"\n")
        return self._answer()

    def _answer(self) -> dict[str, Any]:
        line = self._file.readline(_LONGEST_LINE)
        if not line.endswith(b"\n"):
            raise ConnectionResetError("the capture closed the connection")
        answer = json.loads(line)
        if not isinstance(answer, dict):
            return {}
        if "error" in answer:
            raise CaptureError(str(answer["error"]))
        return answer

    def close(self) -> None:
        """Detaches."""
        with suppress(OSError):
            self._file.close()
            self._socket.close()


class SessionFile:
    """The session file of the process itself, locked until it is removed."""

    def __init__(self) -> None:
        self.path = session_path(os.getpid())
        # One of this process id was left by a process that has ended.
        self.path.unlink(missing_ok=True)
        channel.remove(self.path)
        flags = os.O_RDWR | os.O_CREAT | os.O_EXCL | _NO_FOLLOW
        self._file = os.open(self.path, flags, 0o600)
        lock(self._file)

    def write(self, session: Session) -> None:
        """Writes the session for clients to read."""
        os.write(self._file, json.dumps(asdict(session)).encode())

    def remove(self) -> None:
        """Removes the file and the control channel's."""
        os.close(self._file)
        channel.remove(self.path)
        self.path.unlink(missing_ok=True)


def session_path(pid: int) -> Path:
    """The session file of the capture with that process id."""
    return runtime_folder() / f"capture-{pid}.json"


def read_session(path: Path) -> Session | None:
    """Reads a session file of this user; None when it is not complete (yet)."""
    try:
        file = os.open(path, os.O_RDONLY | _NO_FOLLOW)
        try:
            if not _is_own_file(file):
                return None
            value = json.loads(os.read(file, _LONGEST_LINE))
        finally:
            os.close(file)
        return Session(**{**value, "ports": tuple(value["ports"])})
    except (OSError, ValueError, TypeError, KeyError, RecursionError):
        return None


def sessions() -> list[Session]:
    """The running captures, oldest first; removes the files of those that were killed."""
    found = []
    for path in sorted(runtime_folder().glob("capture-*.json")):
        session = read_session(path)
        if _is_locked(path):
            found += [session] if session is not None else []
            continue
        with suppress(OSError):
            if session is not None or time.time() - path.stat().st_mtime > _WRITTEN_WITHIN_S:
                channel.remove(path)
                path.unlink()
    return sorted(found, key=lambda session: session.unix_s)


def _is_own_file(file: int) -> bool:
    found = os.fstat(file)
    is_own = not hasattr(os, "getuid") or found.st_uid == os.getuid()
    return is_own and stat.S_ISREG(found.st_mode)


def _is_locked(path: Path) -> bool:
    try:
        file = os.open(path, os.O_RDWR | _NO_FOLLOW)
    except OSError:
        return False
    try:
        if not lock(file):
            return True
        release(file)
        return False
    finally:
        os.close(file)
