# SPDX-License-Identifier: GPL-3.0-or-later
"""The sample log: every decoded sample, in a file that any number of readers follow.

Behind the 8 bytes ``SMSAMPL1`` stand records of SAMPLE, little-endian and all of one size, so that
a sample's number is its place in the file and a torn last record is cut by counting. A reader that
was stalled goes on where it was: nothing is dropped for its sake.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

MAGIC = b"SMSAMPL1"
FILE_NAME = "samples.bin"

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


class SampleLogWriter:
    """Appends samples to a new log."""

    def __init__(self, folder: Path) -> None:
        self._file = open(folder / FILE_NAME, "xb", buffering=0)  # noqa: SIM115
        self._file.write(MAGIC)
        self.num_samples = 0

    def append(self, samples: Samples) -> None:
        """Appends samples. Raises OSError, such as for a full disk."""
        rest = memoryview(samples.tobytes())
        while len(rest):
            rest = rest[self._file.write(rest) :]
        self.num_samples += len(samples)

    def close(self) -> None:
        """Syncs and closes."""
        if not self._file.closed:
            os.fsync(self._file.fileno())
            self._file.close()


class SampleLogReader:
    """Follows a log from a sample on."""

    def __init__(self, folder: Path, position: int = 0) -> None:
        self._file = open(folder / FILE_NAME, "rb", buffering=0)  # noqa: SIM115
        if self._file.read(len(MAGIC)) != MAGIC:
            self._file.close()
            raise ValueError(f"{folder / FILE_NAME}: is no sample log of a capture")
        self.position = position

    @property
    def num_samples(self) -> int:
        """How many whole samples are in the file by now."""
        return (os.fstat(self._file.fileno()).st_size - len(MAGIC)) // SAMPLE.itemsize

    def seek_end(self) -> None:
        """Goes on with what comes from now on."""
        self.position = self.num_samples

    def read(self, most: int = 100_000) -> Samples:
        """Returns the next samples, (N,) of SAMPLE, none when there are no more yet."""
        wanted = min(self.num_samples - self.position, most)
        if wanted <= 0:
            return np.empty(0, SAMPLE)
        self._file.seek(len(MAGIC) + self.position * SAMPLE.itemsize)
        data = self._file.read(wanted * SAMPLE.itemsize)
        samples = np.frombuffer(data[: len(data) // SAMPLE.itemsize * SAMPLE.itemsize], SAMPLE)
        self.position += len(samples)
        return samples

    def close(self) -> None:
        """Closes the file."""
        self._file.close()
