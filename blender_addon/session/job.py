# SPDX-License-Identifier: GPL-3.0-or-later
"""Long calls on a worker thread, with progress and cancel. At most one at a time."""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from .errors import InputError

Progress = Callable[[int, int, str], bool]
"""Called with steps done, total steps and the current item; returns False to cancel."""

_JOIN_TIMEOUT_S = 10.0
_NICENESS = 5

_current: Job | None = None


class Cancelled(Exception):
    """The animator cancelled."""


class Job:
    """A long call: work(progress) on a worker thread, and its result."""

    def __init__(self, label: str, work: Callable[[Progress], Any]) -> None:
        self.label = label
        self.what = ""
        self.fraction = 0.0
        self._work = work
        self._stop = threading.Event()
        self._result: Any = None
        self._error: BaseException | None = None
        self._listener: Callable[[], None] | None = None
        self._thread = threading.Thread(target=self._run_beside, name=f"Sparse Mocap: {label}")
        self._thread.daemon = True  # Blender may quit meanwhile

    @property
    def is_running(self) -> bool:
        """Whether the worker thread is running."""
        return self._thread.is_alive()

    @property
    def is_cancelled(self) -> bool:
        """Whether the job was cancelled."""
        return self._stop.is_set()

    @property
    def text(self) -> str:
        """One line for the progress bar, without the percentage."""
        return f"{self.label}: {self.what}" if self.what else self.label

    def start(self) -> None:
        """Start the worker thread. Raises InputError while another job is running."""
        _occupy(self)
        self._thread.start()

    def run(self, listener: Callable[[], None] | None = None) -> Any:
        """Do the work on this thread and return its result; calls the listener at each progress."""
        _occupy(self)
        self._listener = listener
        self._run()
        return self.result()

    def cancel(self) -> None:
        """Ask the work to stop at its next progress."""
        self._stop.set()

    def join(self) -> None:
        """Wait for the worker thread."""
        if self._thread.is_alive():
            self._thread.join(_JOIN_TIMEOUT_S)

    def result(self) -> Any:
        """The result; raises the work's exception, or Cancelled when it was cancelled."""
        if self._error is None:
            return self._result
        if self._stop.is_set():
            raise Cancelled("Cancelled") from self._error
        raise self._error

    def _run_beside(self) -> None:
        _step_back()
        self._run()

    def _run(self) -> None:
        try:
            self._result = self._work(self._on_progress)
        except BaseException as error:  # raised again by result()
            self._error = error
        finally:
            _release(self)

    def _on_progress(self, done: int, total: int, what: str = "") -> bool:
        self.fraction = min(max(done / total, 0.0), 1.0) if total > 0 else 0.0
        self.what = what
        if self._listener is not None:
            self._listener()
        return not self._stop.is_set()


def _step_back() -> None:
    """Let the window be drawn before this thread, and those it starts, go on computing."""
    if sys.platform != "linux":  # only there threads have priorities that others inherit
        return
    with suppress(OSError):
        own = os.getpriority(os.PRIO_PROCESS, 0)
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), own + _NICENESS)


def current() -> Job | None:
    """The running job."""
    return _current


def cancel_current() -> None:
    """Cancel the running job, if any, and wait for it."""
    job = _current
    if job is not None:
        job.cancel()
        job.join()


def _occupy(job: Job) -> None:
    global _current
    if _current is not None:
        raise InputError(f"{_current.label} is still running: wait or cancel it first")
    _current = job


def _release(job: Job) -> None:
    global _current
    if _current is job:
        _current = None
