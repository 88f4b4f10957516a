# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that were opened, kept for the panels and the steps that need them."""

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
    """One file as it was at one time: still opening (neither), opened, or not to be opened."""

    path: str
    stamp: tuple[int, int]
    value: T | None = None
    error: str = ""

    @property
    def is_opening(self) -> bool:
        """Whether the file is still being read."""
        return self.value is None and not self.error


class Shelf(Generic[T]):
    """The one file of a kind that is in use; a changed file is opened anew."""

    def __init__(self, what: str, load: Callable[[str], T]) -> None:
        self._what = what
        self._load = load
        self._lock = threading.Lock()
        self._entry: Entry[T] | None = None
        self._threads: list[threading.Thread] = []

    def get(self, path: str) -> T:
        """The opened file. Raises InputError, OSError or what the file is at fault for."""
        stamp = self._stamp(path)
        entry = self._entry
        if entry is not None and (entry.path, entry.stamp) == (path, stamp):
            opened = entry.value
            if opened is not None:
                return opened
        value = self._load(path)
        self._keep(Entry(path, stamp, value))
        return value

    def peek(self, path: str) -> Entry[T]:
        """What is known of the file at once; an unknown one is opened on a thread meanwhile."""
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
        """Give what is being opened that long."""
        for thread in self._threads:
            thread.join(seconds)

    def forget(self) -> None:
        """Let go of the file."""
        self._keep(None)

    def close(self) -> None:
        """Let go of the file and wait for what is still being opened."""
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

    def _keep(self, entry: Entry[T] | None) -> None:
        with self._lock:
            self._entry = entry

    def _stamp(self, path: str) -> tuple[int, int]:
        if not path:
            raise InputError(f"No {self._what} is chosen yet")
        if "\0" in path:
            raise InputError(f"The name of the {self._what} has a character that no file can have")
        if os.path.isdir(path):
            raise InputError(f"{path} is a folder: choose a {self._what} file")
        status = os.stat(path)
        return status.st_mtime_ns, status.st_size
