# SPDX-License-Identifier: GPL-3.0-or-later
"""A live reconstruction: a capture's samples, step by step into poses."""

from __future__ import annotations

import time
from collections import deque
from typing import Any, TextIO

import numpy as np

from .. import MotionDatabase, PoseEstimate, site_names
from ..calibration import Calibration, worn_as
from ..capture.client import CaptureClient
from ..capture.errors import CaptureError
from ..capture.live_readings import LiveReadings
from ..positions import position_header, position_row
from ..readings import Channels

_WINDOW = 250  # poses, for what is shown


class LiveSession:
    """Reconstructs what a capture's sensors read, as it comes."""

    def __init__(
        self,
        client: CaptureClient,
        status: dict[str, Any],
        database: MotionDatabase,
        method: str,
        preset: str,
        calibration: Calibration | None = None,
    ) -> None:
        self._client = client
        self._worn = worn_as(calibration, [str(sensor["site"]) for sensor in status["sensors"]])
        self.sites = self._worn.sites
        unknown = [site for site in self.sites if site not in site_names()]
        if unknown:
            raise CaptureError(f"sensor {unknown[0]!r} has no site; say with --sites where it is")
        self._has_up = [bool(sensor["has_gyroscope"]) for sensor in status["sensors"]]
        channels = Channels(self.sites, self._worn.places, self._has_up)
        self._reconstructor = channels.reconstructor(database, method=method, preset=preset)
        self._readings = LiveReadings(
            list(range(len(self.sites))),
            database.rate_hz,
            self._has_up,
            self._worn.gyroscope_biases,
        )
        self._joints = database.skeleton.names
        self._times: deque[float] = deque(maxlen=self._reconstructor.latency_frames + 1)
        self._file: TextIO | None = None
        self._begin_s: float | None = None
        self.num_poses = 0
        self.misfits: deque[float] = deque(maxlen=_WINDOW)
        self.latencies_s: deque[float] = deque(maxlen=_WINDOW)
        self.step_s: deque[float] = deque(maxlen=_WINDOW)

    def stream_to(self, file: TextIO) -> None:
        """Writes every pose's joint positions, heading frame, to a positions file as it comes."""
        self._file = file
        file.write(position_header(self._joints) + "\n")

    def advance(self) -> None:
        """Takes what has arrived and makes the poses that are due."""
        self._readings.add(self._client.read())
        for reading in self._readings.ready(time.monotonic()):
            begin = time.perf_counter()
            self._times.append(reading.time_s)
            estimate = self._reconstructor.step(self._worn.ideal(reading.values, self._has_up))
            self.step_s.append(time.perf_counter() - begin)
            if estimate is not None:
                self._take_up(self._times[0], estimate)
        if self._file is not None:
            self._file.flush()

    def summary(self) -> str:
        """One line on the whole session."""
        if not self.num_poses:
            return "no pose: some sensor never delivered"
        return (
            f"{self.num_poses} poses; of the last {len(self.misfits)}: mean misfit "
            f"{np.nanmean(self.misfits):.2f} m/s^2, from movement to pose "
            f"{1e3 * np.median(self.latencies_s):.0f} ms (worst "
            f"{1e3 * max(self.latencies_s):.0f} ms)"
        )

    def _take_up(self, time_s: float, estimate: PoseEstimate) -> None:
        self.num_poses += 1
        misfit = np.asarray(estimate.sensor_misfit_mps2)
        if np.isfinite(misfit).any():
            self.misfits.append(float(np.nanmean(misfit)))
        self.latencies_s.append(time.monotonic() - time_s)
        if self._begin_s is None:
            self._begin_s = time_s
        if self._file is not None:
            self._file.write(position_row(time_s - self._begin_s, estimate.positions) + "\n")
