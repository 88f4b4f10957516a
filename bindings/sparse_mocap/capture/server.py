# SPDX-License-Identifier: GPL-3.0-or-later
"""The server in the capture process: answers clients and ends the process when it is not needed.

Samples do not pass through here: clients read the sample log, so a slow client loses nothing.
"""

from __future__ import annotations

import hmac
import json
import os
import secrets
import selectors
import socket
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .recorder import Recorder
from .session import Session, write_session

__all__ = ["Server"]

TICK_S = 0.5
_LONGEST_REQUEST = 1 << 16
_MOST_CLIENTS = 32


@dataclass(eq=False)
class _Client:
    socket: socket.socket
    pending: bytearray = field(default_factory=bytearray)
    is_known: bool = False


class Server:
    """Serves a recorder's clients until the capture ends."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder
        self._token = secrets.token_hex(16)
        self._listener = socket.create_server(("127.0.0.1", 0), backlog=_MOST_CLIENTS)
        self._listener.setblocking(False)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._clients: set[_Client] = set()
        self.must_end = False

    def session(self) -> Session:
        """The content of the session file."""
        config = self._recorder.config
        return Session(
            os.getpid(),
            self._listener.getsockname()[1],
            self._token,
            str(self._recorder.folder),
            time.time(),
            tuple(link.port for link in config.links),
        )

    def run(self) -> None:
        """Serves until a client requests the end, or without clients and recordings."""
        path: Path = write_session(self.session())
        next_tick = last_needed = time.perf_counter()
        try:
            while not self.must_end:
                for key, _ in self._selector.select(max(0.0, next_tick - time.perf_counter())):
                    self._serve(key)
                now = time.perf_counter()
                if now >= next_tick:
                    self._recorder.tick()
                    next_tick = now + TICK_S
                if self._is_needed():
                    last_needed = now
                elif now - last_needed > self._recorder.config.linger_s:
                    return
        finally:
            path.unlink(missing_ok=True)
            self._close()

    def _is_needed(self) -> bool:
        return self._recorder.recording is not None or any(
            client.is_known for client in self._clients
        )

    def _serve(self, key: selectors.SelectorKey) -> None:
        if key.fileobj is self._listener:
            self._accept()
            return
        client: _Client = key.data
        try:
            data = client.socket.recv(1 << 16)
            client.pending += data
            if not data or len(client.pending) > _LONGEST_REQUEST:
                raise ConnectionResetError
            while b"\n" in client.pending:
                line, _, rest = bytes(client.pending).partition(b"\n")
                client.pending = bytearray(rest)
                answer = json.dumps(self._answer(client, line)).encode() + b"\n"
                client.socket.sendall(answer)
        except OSError:
            self._drop(client)

    def _accept(self) -> None:
        try:
            accepted, _ = self._listener.accept()
        except OSError:
            return
        if len(self._clients) >= _MOST_CLIENTS:
            accepted.close()
            return
        accepted.settimeout(1.0)  # answers are short; a client that does not read them is dropped
        client = _Client(accepted)
        self._clients.add(client)
        self._selector.register(accepted, selectors.EVENT_READ, client)

    def _drop(self, client: _Client) -> None:
        self._clients.discard(client)
        self._selector.unregister(client.socket)
        client.socket.close()

    def _answer(self, client: _Client, line: bytes) -> dict[str, Any]:
        try:
            request = json.loads(line)
            what = str(request["do"])
        except (ValueError, KeyError, TypeError):
            raise ConnectionResetError("no request") from None
        is_greeting = what in ("attach", "peek")
        if is_greeting and hmac.compare_digest(str(request.get("token")), self._token):
            client.is_known = what == "attach"
            return {"pid": os.getpid(), "folder": str(self._recorder.folder)}
        if not client.is_known:
            raise ConnectionRefusedError("wrong token")
        return self._known_answer(client, what, request)

    def _known_answer(self, client: _Client, what: str, request: dict[str, Any]) -> dict[str, Any]:
        if what == "status":
            return self._recorder.status()
        if what == "record":
            seconds = request.get("seconds")
            return self._recorder.start_recording(None if seconds is None else float(seconds))
        if what == "stop_recording":
            self._recorder.stop_recording()
            return {}
        if what == "leave":
            return self._left(client, is_kept=bool(request.get("is_kept")))
        if what == "stop":
            self.must_end = True
            return {}
        return {"error": f"unknown request {what!r}"}

    def _left(self, client: _Client, *, is_kept: bool) -> dict[str, Any]:
        client.is_known = False
        if is_kept:
            self._recorder.may_be_removed = True
        self.must_end = not self._is_needed()
        return {"ends": self.must_end}

    def _close(self) -> None:
        for client in list(self._clients):
            self._drop(client)
        self._selector.close()
        self._listener.close()
