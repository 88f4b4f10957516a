# SPDX-License-Identifier: GPL-3.0-or-later
"""The sample log: every decoded sample, in files that any number of clients can read.

The 8 bytes ``SMSAMPL1``, whose last is the version, are followed by records of SAMPLE,
little-endian and of equal size, so that a sample's number gives its offset, and an incomplete last
record is recognised by its size. After PER_FILE samples the log continues in the next file
(``samples.1.bin``, ...). A reader that was stalled continues where it stopped, unless that file was
deleted, as old ones are while nothing is recorded.
"""

from __future__ import annotations

import io
import os
import re
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .raw_log import check_magic

__all__ = ["SampleLogReader", "SampleLogWriter", "log_path"]

MAGIC = b"SMSAMPL1"
FILE_NAME = "samples.bin"
PER_FILE = 1 << 18
"""Samples in a file: three minutes and a half of six sensors at 200 Hz, 19 MB."""
MOST_SPARE = 2
"""Number of full files kept while nothing is recorded."""

SAMPLE = np.dtype(
    [
        ("arrival_ns", "<i8"),  # monotonic clock of the machine
        ("device_time_s", "<f8"),  # the device's clock, unwrapped; NaN: it has none
        ("counter", "<i8"),  # the device's packet counter, unwrapped; -1: it has none
        ("sensor", "<u2"),  # index into the capture's sensors
        ("flags", "<u2"),
        ("specific_force", "<f4", 3),  # m/s^2
        ("angular_velocity", "<f4", 3),  # rad/s
        ("orientation", "<f4", 4),  # R_world_sensor, w x y z
    ]
)
"""One sample of one sensor; NaN for quantities it does not send."""

Samples = NDArray[np.void]


def log_path(folder: Path, number: int) -> Path:
    """A log's file; they are numbered from 0."""
    return folder / (f"samples.{number}.bin" if number else FILE_NAME)


class SampleLogWriter:
    """Appends samples to a new log."""

    _file: io.FileIO

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self.num_samples = 0
        self._oldest = 0
        self._old: list[int] = []  # files that are not deleted yet
        self._begin_file(0)

    def append(self, samples: Samples) -> None:
        """Appends samples. Raises OSError, such as for a full disk."""
        while len(samples):
            number, at = divmod(self.num_samples, PER_FILE)
            if number > self._number:
                self._begin_file(number)
            part, samples = samples[: PER_FILE - at], samples[PER_FILE - at :]
            rest = memoryview(part.tobytes())
            while len(rest):
                rest = rest[self._file.write(rest) :]
            self.num_samples += len(part)

    def remove_old(self) -> None:
        """Deletes all but the newest full files, on Windows once nobody reads them any more."""
        self._old += range(self._oldest, self._number - MOST_SPARE)
        self._oldest = max(self._oldest, self._number - MOST_SPARE)
        for number in list(self._old):
            with suppress(OSError):
                log_path(self._folder, number).unlink(missing_ok=True)
                self._old.remove(number)

    def close(self) -> None:
        """Syncs and closes."""
        if not self._file.closed:
            os.fsync(self._file.fileno())
            self._file.close()

    def _begin_file(self, number: int) -> None:
        path = log_path(self._folder, number)
        file = open(path, "xb", buffering=0)  # noqa: SIM115
        file.write(MAGIC)
        if number:
            self._file.close()
        self._file, self._number = file, number


class SampleLogReader:
    """Reads a log from a given sample on, while it is being written."""

    _file: io.FileIO

    def __init__(self, folder: Path, position: int = 0) -> None:
        self._folder = folder
        self._number = -1
        self.position = position
        self._open(min(self._numbers(), default=0))

    @property
    def num_samples(self) -> int:
        """Number of complete samples so far."""
        number = max(self._numbers(), default=0)
        size = log_path(self._folder, number).stat().st_size - len(MAGIC)
        return number * PER_FILE + max(size, 0) // SAMPLE.itemsize

    def seek_end(self) -> None:
        """Skips to the end: only new samples are read."""
        self.position = self.num_samples

    def read(self, most: int = 100_000) -> Samples:
        """Returns the next samples, (N,) of SAMPLE; empty when there are no new ones.

        Samples in deleted files are skipped.
        """
        parts = [np.empty(0, SAMPLE)]
        while most > 0 and self._is_there():
            at = self.position % PER_FILE
            self._file.seek(len(MAGIC) + at * SAMPLE.itemsize)
            data = self._file.read(min(most, PER_FILE - at) * SAMPLE.itemsize)
            count = len(data) // SAMPLE.itemsize
            if not count:
                break
            parts.append(np.frombuffer(data, SAMPLE, count))
            self.position += count
            most -= count
        return np.concatenate(parts)

    def close(self) -> None:
        """Closes the file."""
        self._file.close()

    def _is_there(self) -> bool:
        """Opens the file of the next sample, or the one after it if that was deleted."""
        number = self.position // PER_FILE
        if number == self._number:
            return True
        numbers = self._numbers()
        if not numbers or number > max(numbers):
            return False
        try:
            self._open(min(there for there in numbers if there >= number))
        except (FileNotFoundError, ValueError):  # just deleted, or just created
            return False
        self.position = max(self.position, self._number * PER_FILE)
        return self._number >= number

    def _numbers(self) -> list[int]:
        found = [
            re.fullmatch(r"samples(?:\.(\d+))?\.bin", path.name)
            for path in self._folder.glob("samples*.bin")
        ]
        return [int(match[1] or 0) for match in found if match]

    def _open(self, number: int) -> None:
        path = log_path(self._folder, number)
        file = open(path, "rb", buffering=0)  # noqa: SIM115
        try:
            check_magic(path, file.read(len(MAGIC)), MAGIC, "sample log")
        except ValueError:
            file.close()
            raise
        if self._number >= 0:
            self._file.close()
        self._file, self._number = file, number
