# SPDX-License-Identifier: GPL-3.0-or-later
"""Opened files, cached for the panels and operators that use them."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from .errors import InputError, one_line

T = TypeVar("T")


@dataclass(frozen=True)
class Entry(Generic[T]):
    """A file with its time stamp: opened, failed to open (error), or still opening (neither)."""

    path: str
    stamp: tuple[int, int]
    value: T | None = None
    error: str = ""

    @property
    def is_opening(self) -> bool:
        """Whether the file is still being read."""
        return self.value is None and not self.error


class FileCache(Generic[T]):
    """Caches the last opened file of a kind; opens it again when it has changed on disk."""

    def __init__(self, what: str, load: Callable[[str], T]) -> None:
        self._what = what
        self._load = load
        self._lock = threading.Lock()
        self._entry: Entry[T] | None = None
        self._threads: list[threading.Thread] = []

    def get(self, path: str) -> T:
        """The opened file. Raises InputError, OSError or FormatError."""
        stamp = self._stamp(path)
        entry = self._entry
        if entry is not None and (entry.path, entry.stamp) == (path, stamp):
            opened = entry.value
            if opened is not None:
                return opened
        value = self._load(path)
        self._store(Entry(path, stamp, value))
        return value

    def peek(self, path: str) -> Entry[T]:
        """The file's entry without waiting; opens the file on a thread when it is not cached."""
        try:
            stamp = self._stamp(path)
        except (InputError, OSError) as error:
            return Entry(path, (0, 0), error=one_line(error))
        with self._lock:
            entry = self._entry
            if entry is not None and (entry.path, entry.stamp) == (path, stamp):
                return entry
            opening: Entry[T] = Entry(path, stamp)
            self._entry = opening
            self._threads = [thread for thread in self._threads if thread.is_alive()]
            thread = threading.Thread(target=self._open, args=(opening,), daemon=True)
            self._threads.append(thread)
            thread.start()
        return opening

    def wait(self, seconds: float) -> None:
        """Wait at most this long for files being opened."""
        for thread in self._threads:
            thread.join(seconds)

    def forget(self) -> None:
        """Drop the cached file."""
        self._store(None)

    def close(self) -> None:
        """Drop the cached file and wait for files being opened."""
        self.forget()
        for thread in self._threads:
            thread.join()

    def _open(self, opening: Entry[T]) -> None:
        try:
            opened = Entry(opening.path, opening.stamp, self._load(opening.path))
        except BaseException as error:  # shown in the panel
            opened = Entry(opening.path, opening.stamp, error=one_line(error))
        with self._lock:
            if self._entry is opening:
                self._entry = opened

    def _store(self, entry: Entry[T] | None) -> None:
        with self._lock:
            self._entry = entry

    def _stamp(self, path: str) -> tuple[int, int]:
        if not path:
            raise InputError(f"Choose a {self._what} first")
        if "\0" in path:
            raise InputError(
                f"The path of the {self._what} contains an invalid character: choose the file again"
            )
        if os.path.isdir(path):
            raise InputError(f"{path} is a folder: choose a {self._what} file")
        status = os.stat(path)
        return status.st_mtime_ns, status.st_size
