# SPDX-License-Identifier: GPL-3.0-or-later
"""Long calls on a worker thread, with progress and cancel. At most one at a time."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from .errors import InputError

Progress = Callable[[int, int, str], bool]
"""Called with what is done, the total and what is being done; False asks to stop."""

_JOIN_TIMEOUT_S = 10.0

_current: Job | None = None


class Cancelled(Exception):
    """The animator asked to stop."""


class Job:
    """One long call. It gets a Progress; what it returns is the result."""

    def __init__(self, label: str, work: Callable[[Progress], Any]) -> None:
        self.label = label
        self.what = ""
        self.fraction = 0.0
        self._work = work
        self._stop = threading.Event()
        self._result: Any = None
        self._error: BaseException | None = None
        self._listener: Callable[[], None] | None = None
        self._thread = threading.Thread(target=self._run, name=f"Sparse Mocap: {label}")
        self._thread.daemon = True  # Blender may quit meanwhile

    @property
    def is_running(self) -> bool:
        """Whether the worker thread is at work."""
        return self._thread.is_alive()

    @property
    def is_cancelled(self) -> bool:
        """Whether the job was asked to stop."""
        return self._stop.is_set()

    @property
    def text(self) -> str:
        """One line for the progress bar, without the percentage."""
        return f"{self.label}: {self.what}" if self.what else self.label

    def start(self) -> None:
        """Begin on the worker thread. Raises InputError while another job runs."""
        _occupy(self)
        self._thread.start()

    def run(self, listener: Callable[[], None] | None = None) -> Any:
        """Do the work here and now and return its result; the listener hears each progress."""
        _occupy(self)
        self._listener = listener
        self._run()
        return self.result()

    def cancel(self) -> None:
        """Ask to stop; the work ends at its next progress."""
        self._stop.set()

    def join(self) -> None:
        """Wait for the worker thread to end."""
        if self._thread.is_alive():
            self._thread.join(_JOIN_TIMEOUT_S)

    def result(self) -> Any:
        """What the work returned; raises what it raised, and Cancelled if it was stopped."""
        if self._error is None:
            return self._result
        if self._stop.is_set():
            raise Cancelled("Cancelled") from self._error
        raise self._error

    def _run(self) -> None:
        try:
            self._result = self._work(self._on_progress)
        except BaseException as error:  # handed over to whoever asks for the result
            self._error = error
        finally:
            _release(self)

    def _on_progress(self, done: int, total: int, what: str = "") -> bool:
        self.fraction = min(max(done / total, 0.0), 1.0) if total > 0 else 0.0
        self.what = what
        if self._listener is not None:
            self._listener()
        return not self._stop.is_set()


def current() -> Job | None:
    """The job at work."""
    return _current


def cancel_current() -> None:
    """Stop the job at work, if any, and wait for its end."""
    job = _current
    if job is not None:
        job.cancel()
        job.join()


def _occupy(job: Job) -> None:
    global _current
    if _current is not None:
        raise InputError(f"{_current.label} is still at work: wait for it or cancel it first")
    _current = job


def _release(job: Job) -> None:
    global _current
    if _current is job:
        _current = None
