# SPDX-License-Identifier: GPL-3.0-or-later
"""A rolling raw log: keeps everything that is recorded, and the newest minutes of the rest.

While nothing is recorded, a new file is started whenever one is full, and the oldest is deleted.
Each file can be read on its own, because it repeats how each connection began: everything up to the
first sample, and what changed a sensor's name. There, devices describe the layout of their data.
"""

from __future__ import annotations

import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .raw_log import BEGUN, RawLogWriter, Record, log_path

__all__ = ["RollingLog"]

FULL_BYTES = 16 << 20
"""Size at which a file is full: five minutes of six sensors at 200 Hz."""
MOST_SPARE = 2
"""Number of full files kept while nothing is recorded."""
_LONGEST_BEGIN = 1 << 16


@dataclass
class _Begin:
    """How a link's connection began."""

    event: dict[str, Any]
    opened_ns: int
    records: list[Record] = field(default_factory=list)
    senders: set[str] = field(default_factory=set)
    """Senders whose first sample has arrived; "" for the bytes of a serial port."""
    num_bytes: int = 0


class RollingLog:
    """Appends to the raw log of a capture and deletes old files. Raises OSError."""

    def __init__(self, folder: Path, about: dict[str, Any]) -> None:
        """about: the event at the start of every file."""
        self._folder, self.about = folder, about
        self._writer = RawLogWriter(folder)
        self._writer.append_event(0, time.perf_counter_ns(), about)
        self._begins: dict[int, _Begin] = {}
        self._is_recorded = False
        self._is_due = False
        self._spare: deque[int] = deque()

    def append_event(self, link: int, event: dict[str, Any]) -> int:
        """Appends an event and returns its time."""
        now_ns = time.perf_counter_ns()
        self._writer.append_event(link, now_ns, event)
        if event["event"] == "connected":
            self._begins[link] = _Begin(event, now_ns)
        return now_ns

    def append(self, record: Record) -> None:
        """Appends bytes or a datagram of a link."""
        self._writer.append(record)

    def decoded(self, record: Record, sender: str, *, has_samples: bool, has_news: bool) -> None:
        """Tells whether the last record contained samples, or a new name of a sensor."""
        begin = self._begins.get(record.link)
        if begin is None or (sender in begin.senders and not has_news):
            return
        begin.num_bytes += len(record.payload)
        if begin.num_bytes <= _LONGEST_BEGIN:
            begin.records.append(record)
            if has_samples:
                begin.senders.add(sender)

    def begin_recording(self) -> None:
        """Keeps the existing files, and everything until the recording ends."""
        self._is_recorded = True
        self._spare.clear()

    def end_recording(self) -> None:
        """Starts a new file soon, so that the recorded one is complete."""
        self._is_due = True

    def roll_over(self) -> RawLogWriter | None:
        """Starts a new file if one is due; returns the old file's writer, for the caller to close.

        Must not be called while recording.
        """
        if not self._is_due and self._writer.num_bytes < FULL_BYTES:
            return None
        old, self._writer = self._writer, self._next()
        if not self._is_recorded:
            self._spare.append(old.number)
        self._is_recorded = self._is_due = False
        while len(self._spare) > MOST_SPARE:
            with suppress(OSError):  # on Windows, a file that is being read cannot be removed
                log_path(self._folder, self._spare[0]).unlink()
            self._spare.popleft()
        return old

    def sync(self) -> None:
        """Waits until everything is on disk."""
        self._writer.sync()

    def close(self) -> None:
        """Syncs and closes."""
        self._writer.close()

    def _next(self) -> RawLogWriter:
        writer = RawLogWriter(self._folder, self._writer.number + 1)
        try:
            self._repeat(writer)
        except OSError:
            writer.close()
            log_path(self._folder, writer.number).unlink()
            raise
        return writer

    def _repeat(self, writer: RawLogWriter) -> None:
        now_ns = time.perf_counter_ns()
        writer.append_event(0, now_ns, {**self.about, "is_later": True})
        for link, begin in self._begins.items():
            writer.append_event(link, begin.opened_ns, begin.event)
            for record in begin.records:
                writer.append(record)
        writer.append_event(0, now_ns, {"event": BEGUN})
