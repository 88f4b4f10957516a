# SPDX-License-Identifier: GPL-3.0-or-later
"""The serial ports of this machine and the captures that are running, listed on a thread."""

from __future__ import annotations

import threading
import time
from dataclasses import dataclass, field
from typing import Any

from .core import capture, core
from .errors import one_line

SCAN_INTERVAL_S = 10.0
"""Longer than the time after which an idle capture ends: a scan connects to it and resets that."""


@dataclass(frozen=True)
class RunningCapture:
    """A capture process that is running."""

    session: Any  # sparse_mocap.capture.session.Session
    recording_s: float | None
    """How long it has been recording; None when it is not recording."""

    @property
    def pid(self) -> int:
        """The process id."""
        return int(self.session.pid)

    @property
    def text(self) -> str:
        """One line for the animator."""
        ports = ", ".join(self.session.ports) or "sensors"
        if self.recording_s is None:
            return f"{ports}: already connected in the background"
        return f"{ports}: recording in the background for {self.recording_s:.0f} s"


@dataclass(frozen=True)
class ScanResult:
    """What one scan found."""

    ports: tuple[Any, ...] = ()  # sparse_mocap.capture.PortInfo
    drivers: tuple[str, ...] = ()
    driver_help: dict[str, str] = field(default_factory=dict)
    """What each driver is for, and its options with their defaults; several lines."""
    captures: tuple[RunningCapture, ...] = ()
    error: str = ""


class PortScanner:
    """Scans on a thread; the newest result is always available without waiting."""

    def __init__(self) -> None:
        self.result = ScanResult()
        self._thread: threading.Thread | None = None
        self._scanned_s = float("-inf")

    @property
    def is_scanning(self) -> bool:
        """Whether a scan is running."""
        return self._thread is not None and self._thread.is_alive()

    def latest(self) -> ScanResult:
        """The newest result, without waiting; starts another scan when it is old."""
        if time.perf_counter() - self._scanned_s > SCAN_INTERVAL_S:
            self.scan()
        return self.result

    def scan(self) -> None:
        """Start a scan on a thread, unless one is running."""
        if self.is_scanning:
            return
        self._scanned_s = time.perf_counter()
        self._thread = threading.Thread(target=self._scan, name="Sparse Mocap: ports", daemon=True)
        self._thread.start()

    def wait(self, seconds: float) -> None:
        """Wait at most this long for the running scan."""
        if self._thread is not None:
            self._thread.join(seconds)

    def _scan(self) -> None:
        try:
            module = capture()
            names = tuple(module.drivers.driver_names())
            self.result = ScanResult(
                tuple(module.available_ports()),
                names,
                {name: _help_of(module, name) for name in names},
                tuple(_running(module, session) for session in module.CaptureClient.running()),
            )
        except Exception as error:  # shown in the panel
            self.result = ScanResult(error=one_line(error))


def _running(module: Any, session: Any) -> RunningCapture:
    try:
        with module.CaptureClient(session) as client:
            recording = client.status()["recording"]
    except module.CaptureError:  # it has ended, or does not answer
        recording = None
    return RunningCapture(session, None if recording is None else float(recording["seconds"]))


def _help_of(module: Any, driver: str) -> str:
    options = core().driver_options(driver)
    lines = [module.driver_guide.GUIDES[driver].devices]
    lines += [f"{name}={default}: {what}" for name, (default, what) in options.items()]
    return "\n".join(lines)


port_scanner = PortScanner()
