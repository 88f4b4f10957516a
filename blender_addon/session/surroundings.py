# SPDX-License-Identifier: GPL-3.0-or-later
"""What sensors could be reached by: the serial ports, and the captures that go on already."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from typing import Any

from .core import capture
from .errors import one_line

LOOK_AGAIN_S = 10.0
"""Longer than a capture lingers, which a look at it would otherwise keep alive."""


@dataclass(frozen=True)
class Found:
    """A capture that goes on."""

    session: Any  # sparse_mocap.capture.session.Session
    recording_s: float | None
    """For how long it has been recording; None when it does not."""

    @property
    def pid(self) -> int:
        """Of its process."""
        return int(self.session.pid)

    @property
    def text(self) -> str:
        """One line for the animator."""
        ports = ", ".join(self.session.ports) or "sensors"
        if self.recording_s is None:
            return f"A capture of {ports} goes on"
        return f"A recording of {ports} goes on, since {self.recording_s:.0f} s"


@dataclass(frozen=True)
class View:
    """What was found by one look."""

    ports: tuple[Any, ...] = ()  # sparse_mocap.capture.PortInfo
    drivers: tuple[str, ...] = ()
    captures: tuple[Found, ...] = ()
    error: str = ""


class Surroundings:
    """Looks around on a thread; what it saw last is had at once."""

    def __init__(self) -> None:
        self.view = View()
        self._thread: threading.Thread | None = None
        self._looked_s = float("-inf")

    @property
    def is_looking(self) -> bool:
        """Whether a look is being taken."""
        return self._thread is not None and self._thread.is_alive()

    def peek(self) -> View:
        """What is known at once; a new look is taken meanwhile when the last is old."""
        if time.monotonic() - self._looked_s > LOOK_AGAIN_S:
            self.look()
        return self.view

    def look(self) -> None:
        """Take a look now, on a thread."""
        if self.is_looking:
            return
        self._looked_s = time.monotonic()
        self._thread = threading.Thread(target=self._look, name="Sparse Mocap: ports", daemon=True)
        self._thread.start()

    def wait(self, seconds: float) -> None:
        """Give the look that long."""
        if self._thread is not None:
            self._thread.join(seconds)

    def _look(self) -> None:
        try:
            module = capture()
            self.view = View(
                tuple(module.available_ports()),
                tuple(module.drivers.driver_names()),
                tuple(_found(module, session) for session in module.CaptureClient.running()),
            )
        except Exception as error:  # shown in the panel
            self.view = View(error=one_line(error))


def _found(module: Any, session: Any) -> Found:
    try:
        with module.CaptureClient(session) as client:
            recording = client.status()["recording"]
    except module.CaptureError:  # it ended meanwhile, or is held
        recording = None
    return Found(session, None if recording is None else float(recording["seconds"]))


surroundings = Surroundings()
