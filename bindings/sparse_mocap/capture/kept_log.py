# SPDX-License-Identifier: GPL-3.0-or-later
"""The raw log of a capture that may go on for days: what is recorded stays, of the rest the newest.

While nothing is recorded the log goes on in a new file whenever one is full, and the oldest is
given up. A file is read alone by what it repeats: how each connection began, up to the first sample
and whatever changed a sensor's name, for there devices tell how their data are laid out.
"""

from __future__ import annotations

import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .raw_log import BEGUN, RawLogWriter, Record, log_path

__all__ = ["KeptLog"]

FULL_BYTES = 16 << 20
"""A file beyond this is full: five minutes of six sensors at 200 Hz."""
MOST_SPARE = 2
"""So many full files are kept of what nobody records."""
_LONGEST_BEGIN = 1 << 16


@dataclass
class _Begin:
    """How a link's connection began."""

    event: dict[str, Any]
    opened_ns: int
    records: list[Record] = field(default_factory=list)
    heard: set[str] = field(default_factory=set)
    """The senders of samples; all bytes of a port have one, ""."""
    num_bytes: int = 0


class KeptLog:
    """Appends to the raw log of a capture and gives up what nobody needs. Raises OSError."""

    def __init__(self, folder: Path, about: dict[str, Any]) -> None:
        """Takes the event that every file begins with."""
        self._folder, self._about = folder, about
        self._writer = RawLogWriter(folder)
        self._writer.append_event(0, time.monotonic_ns(), about)
        self._begins: dict[int, _Begin] = {}
        self._is_needed = False
        self._is_due = False
        self._spare: deque[int] = deque()

    def append_event(self, link: int, event: dict[str, Any]) -> int:
        """Appends an event and returns its time."""
        now_ns = time.monotonic_ns()
        self._writer.append_event(link, now_ns, event)
        if event["event"] == "connected":
            self._begins[link] = _Begin(event, now_ns)
        return now_ns

    def append(self, record: Record) -> None:
        """Appends bytes or a datagram of a link."""
        self._writer.append(record)

    def learnt(self, record: Record, sender: str, *, has_samples: bool, has_news: bool) -> None:
        """What became of the record appended last: samples, or another name of a sensor."""
        begin = self._begins.get(record.link)
        if begin is None or (sender in begin.heard and not has_news):
            return
        begin.num_bytes += len(record.payload)
        if begin.num_bytes <= _LONGEST_BEGIN:
            begin.records.append(record)
            if has_samples:
                begin.heard.add(sender)

    def keep(self) -> None:
        """A recording begins: what is there by now stays, and all until it ends."""
        self._is_needed = True
        self._spare.clear()

    def release(self) -> None:
        """The recording has ended."""
        self._is_due = True

    def go_on(self) -> RawLogWriter | None:
        """Begins a new file when that is due; returns the old one's writer, which is to be closed.

        Not to be called while something is recorded.
        """
        if not self._is_due and self._writer.num_bytes < FULL_BYTES:
            return None
        old, self._writer = self._writer, self._next()
        if not self._is_needed:
            self._spare.append(old.number)
        self._is_needed = self._is_due = False
        while len(self._spare) > MOST_SPARE:
            with suppress(OSError):  # somebody reads it, where that forbids to remove it
                log_path(self._folder, self._spare[0]).unlink()
            self._spare.popleft()
        return old

    def sync(self) -> None:
        """Waits until the disk has what was appended."""
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
        now_ns = time.monotonic_ns()
        writer.append_event(0, now_ns, {**self._about, "is_later": True})
        for link, begin in self._begins.items():
            writer.append_event(link, begin.opened_ns, begin.event)
            for record in begin.records:
                writer.append(record)
        writer.append_event(0, now_ns, {"event": BEGUN})
