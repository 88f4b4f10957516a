# SPDX-License-Identifier: GPL-3.0-or-later
"""The server in the capture process: answers clients and ends the process when it is not needed.

Samples do not pass through here: clients read the sample log, so a slow client loses nothing. What
one client does, or sends, ends that client's connection at most.
"""

from __future__ import annotations

import hmac
import json
import os
import secrets
import selectors
import socket
import time
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any

from .channel import listening
from .errors import CaptureError
from .recorder import Recorder
from .session import Session, SessionFile

__all__ = ["Server"]

TICK_S = 0.5
GREETING_TIMEOUT_S = 2.0
"""A client that has not sent the token by then is dropped."""
MOST_STRANGERS = 64
"""Clients that have not sent the token yet; the one that waits longest goes for the next."""
MOST_CLIENTS = 32
_LONGEST_GREETING = 256
_LONGEST_REQUEST = 1 << 16
_MOST_BRACKETS = 16  # a request is one flat object


@dataclass(eq=False)
class _Client:
    socket: socket.socket
    since_s: float
    pending: bytearray = field(default_factory=bytearray)
    is_known: bool = False
    """It has sent the token."""
    is_attached: bool = False


class Server:
    """Serves a recorder's clients until the capture ends."""

    def __init__(self, recorder: Recorder) -> None:
        self._recorder = recorder
        self._token = secrets.token_hex(16)
        self._file = SessionFile()
        self._listener, self._address = listening(self._file.path)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._listener, selectors.EVENT_READ)
        self._clients: list[_Client] = []
        self.must_end = False

    def session(self) -> Session:
        """The content of the session file."""
        config = self._recorder.config
        return Session(
            os.getpid(),
            self._address,
            self._token,
            str(self._recorder.folder),
            time.time(),
            tuple(link.port for link in config.links),
        )

    def run(self) -> None:
        """Serves until a client requests the end, or without clients and recordings."""
        self._file.write(self.session())
        next_tick = last_needed = time.perf_counter()
        try:
            while not self.must_end:
                for key, _ in self._selector.select(max(0.0, next_tick - time.perf_counter())):
                    self._serve(key)
                now = time.perf_counter()
                if now >= next_tick:
                    self._recorder.tick()
                    self._drop_strangers(now)
                    next_tick = now + TICK_S
                if self._is_needed():
                    last_needed = now
                elif now - last_needed > self._recorder.config.linger_s:
                    return
        finally:
            self._close()

    def _is_needed(self) -> bool:
        return self._recorder.recording is not None or any(
            client.is_attached for client in self._clients
        )

    def _serve(self, key: selectors.SelectorKey) -> None:
        if key.fileobj is self._listener:
            self._accept()
            return
        client: _Client = key.data
        if client not in self._clients:  # dropped meanwhile
            return
        try:
            self._receive(client)
        except Exception:  # whatever a client sends must not end the capture
            self._drop(client)

    def _receive(self, client: _Client) -> None:
        data = client.socket.recv(1 << 16)
        client.pending += data
        longest = _LONGEST_REQUEST if client.is_known else _LONGEST_GREETING
        if not data or len(client.pending) > longest:
            raise ConnectionResetError
        while b"\n" in client.pending:
            line, _, rest = bytes(client.pending).partition(b"\n")
            client.pending = bytearray(rest)
            answer = self._answer(client, line) if client.is_known else self._greet(client, line)
            client.socket.sendall(json.dumps(answer).encode() + b"\n")

    def _accept(self) -> None:
        with suppress(BlockingIOError):
            while True:
                try:
                    accepted, _ = self._listener.accept()
                except BlockingIOError:
                    raise
                except OSError:
                    return
                self._add(accepted)

    def _add(self, accepted: socket.socket) -> None:
        accepted.settimeout(1.0)  # answers are short; a client that does not read them is dropped
        strangers = [client for client in self._clients if not client.is_known]
        if len(strangers) >= MOST_STRANGERS:
            self._drop(strangers[0])
        client = _Client(accepted, time.perf_counter())
        self._clients.append(client)
        self._selector.register(accepted, selectors.EVENT_READ, client)

    def _drop(self, client: _Client) -> None:
        self._clients.remove(client)
        self._selector.unregister(client.socket)
        client.socket.close()

    def _drop_strangers(self, now_s: float) -> None:
        for client in list(self._clients):
            if not client.is_known and now_s - client.since_s > GREETING_TIMEOUT_S:
                self._drop(client)

    def _greet(self, client: _Client, line: bytes) -> dict[str, Any]:
        if not hmac.compare_digest(line, self._token.encode()):
            raise ConnectionRefusedError("wrong token")
        if sum(other.is_known for other in self._clients) >= MOST_CLIENTS:
            raise ConnectionRefusedError("too many clients")
        client.is_known = client.is_attached = True
        return {"pid": os.getpid(), "folder": str(self._recorder.folder)}

    def _answer(self, client: _Client, line: bytes) -> dict[str, Any]:
        if line.count(b"[") + line.count(b"{") > _MOST_BRACKETS:
            raise ConnectionResetError("no request")
        request = json.loads(line)
        what = str(request["do"])
        try:
            return self._asked(client, what, request)
        except CaptureError as error:
            return {"error": str(error)}

    def _asked(self, client: _Client, what: str, request: dict[str, Any]) -> dict[str, Any]:
        if what == "status":
            return self._recorder.status()
        if what == "record":
            seconds = request.get("seconds")
            return self._recorder.start_recording(None if seconds is None else float(seconds))
        if what == "stop_recording":
            self._recorder.stop_recording()
            return {}
        if what == "leave":
            return self._left(client)
        if what == "saved":
            self._recorder.tell_saved(int(request["number"]))
            return {}
        if what == "sites":
            self._recorder.set_sites(_texts(request["site_of"]))
            return {}
        if what == "stop":
            self.must_end = True
            return {}
        return {"error": f"unknown request {what!r}"}

    def _left(self, client: _Client) -> dict[str, Any]:
        client.is_attached = False
        self.must_end = not self._is_needed()
        return {"ends": self.must_end, "is_removed": self._recorder.may_be_removed}

    def _close(self) -> None:
        for client in list(self._clients):
            self._drop(client)
        self._selector.close()
        self._listener.close()
        self._file.remove()


def _texts(value: Any) -> dict[str, str]:
    return {str(name): str(text) for name, text in dict(value).items()}
