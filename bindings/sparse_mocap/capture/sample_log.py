# SPDX-License-Identifier: GPL-3.0-or-later
"""The sample log: every decoded sample, in a file that any number of readers follow.

Behind the 8 bytes ``SMSAMPL1`` stand records of SAMPLE, little-endian and all of one size, so that
a sample's number is its place and a torn last record is cut by counting. After PER_FILE samples the
log goes on in the next file (``samples.1.bin``, ...). A reader that was stalled goes on where it
was; while nothing is recorded, though, the oldest files are given up.
"""

from __future__ import annotations

import io
import os
import re
from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

__all__ = ["SampleLogReader", "SampleLogWriter", "log_path"]

MAGIC = b"SMSAMPL1"
FILE_NAME = "samples.bin"
PER_FILE = 1 << 18
"""Samples in a file: three minutes and a half of six sensors at 200 Hz, 19 MB."""
MOST_SPARE = 2
"""So many full files are kept of what nobody records."""

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
"""What a sensor read; NaN where it did not say."""

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

    def give_up(self) -> None:
        """Removes what is older than the newest full files."""
        while self._oldest < self._number - MOST_SPARE:
            with suppress(OSError):  # somebody reads it, where that forbids to remove it
                log_path(self._folder, self._oldest).unlink()
            self._oldest += 1

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
    """Follows a log from a sample on."""

    _file: io.FileIO

    def __init__(self, folder: Path, position: int = 0) -> None:
        self._folder = folder
        self._number = -1
        self.position = position
        self._open(min(self._numbers(), default=0))

    @property
    def num_samples(self) -> int:
        """How many whole samples there are by now."""
        number = max(self._numbers(), default=0)
        size = log_path(self._folder, number).stat().st_size - len(MAGIC)
        return number * PER_FILE + max(size, 0) // SAMPLE.itemsize

    def seek_end(self) -> None:
        """Goes on with what comes from now on."""
        self.position = self.num_samples

    def read(self, most: int = 100_000) -> Samples:
        """Returns the next samples, (N,) of SAMPLE, none when there are no more yet.

        Those that were given up meanwhile are passed over.
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
        """Opens the file of the next sample, or of the oldest that is left when it was given up."""
        number = self.position // PER_FILE
        if number == self._number:
            return True
        numbers = self._numbers()
        if not numbers or number > max(numbers):
            return False
        try:
            self._open(number if number in numbers else min(numbers))
        except (FileNotFoundError, ValueError):  # given up, or begun, just now
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
        if file.read(len(MAGIC)) != MAGIC:
            file.close()
            raise ValueError(f"{path}: is no sample log of a capture")
        if self._number >= 0:
            self._file.close()
        self._file, self._number = file, number
