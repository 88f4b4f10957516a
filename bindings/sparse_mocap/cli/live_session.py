# SPDX-License-Identifier: GPL-3.0-or-later
"""A live reconstruction: a capture's samples, step by step into poses."""

from __future__ import annotations

import time
from collections import deque
from typing import Any, TextIO

import numpy as np

from .. import LiveReconstructor, MotionDatabase, PoseEstimate, site_names
from ..calibration import Calibration, sensor_inputs
from ..capture.client import CaptureClient
from ..capture.errors import CaptureError
from ..positions import position_header, position_row
from ..readings import measured_channels
from ..report import LiveMatch
from .options import MethodChoice

__all__ = ["LiveSession"]

_NUM_POSES = 250  # that figures are averaged over


class LiveSession:
    """Reconstructs what a capture's sensors measure, as it comes."""

    def __init__(
        self,
        client: CaptureClient,
        status: dict[str, Any],
        database: MotionDatabase | None,
        choice: MethodChoice,
        calibration: Calibration | None = None,
        model: Any = None,
        body: Any = None,
    ) -> None:
        self._client = client
        names = [str(sensor["site"]) for sensor in status["sensors"]]
        channels = [measured_channels(sensor) for sensor in status["sensors"]]
        self.sites = _sites(calibration, names)
        self._reconstructor = LiveReconstructor(
            dict(enumerate(names)),
            channels,
            database,
            method=choice.method,
            preset=choice.preset,
            options=choice.options,
            calibration=calibration,
            model=model,
            body=body,
        )
        self._file: TextIO | None = None
        self._begin_s: float | None = None
        self._live_match = LiveMatch(_NUM_POSES)
        self.num_poses = 0
        self.latencies_s: deque[float] = deque(maxlen=_NUM_POSES)
        self.step_s: deque[float] = deque(maxlen=_NUM_POSES)

    def stream_to(self, file: TextIO) -> None:
        """Writes every pose's joint positions, heading frame, to a positions file as it comes."""
        self._file = file
        file.write(position_header(self._reconstructor.skeleton.names) + "\n")

    def advance(self) -> None:
        """Takes what has arrived and makes the poses that are due."""
        self._reconstructor.push(self._client.read())
        begin = time.perf_counter()
        estimates = self._reconstructor.advance(time.monotonic())
        for estimate in estimates:
            self.step_s.append((time.perf_counter() - begin) / len(estimates))
            self._add_pose(estimate)
        if self._file is not None:
            self._file.flush()

    @property
    def match(self) -> str:
        """How well the sensors match the motion database; empty before there are poses."""
        return self._live_match.match

    def summary(self) -> str:
        """One line on the whole session."""
        if not self.num_poses:
            return "no pose: not every sensor delivered data"
        return (
            f"{self.num_poses} poses; sensors match the motion database: {self.match}; from "
            f"movement to pose {1e3 * np.median(self.latencies_s):.0f} ms (worst "
            f"{1e3 * max(self.latencies_s):.0f} ms)"
        )

    def _add_pose(self, estimate: PoseEstimate) -> None:
        self.num_poses += 1
        self._live_match.add(estimate)
        self.latencies_s.append(time.monotonic() - estimate.time_s)
        if self._begin_s is None:
            self._begin_s = estimate.time_s
        if self._file is not None:
            row = position_row(estimate.time_s - self._begin_s, estimate.positions)
            self._file.write(row + "\n")


def _sites(calibration: Calibration | None, names: list[str]) -> list[str]:
    """Returns where sensors of these names are worn. Raises CaptureError for an unknown one."""
    if calibration is not None:
        return [sensor.site for sensor in sensor_inputs(calibration, names, [()] * len(names))]
    for name in names:
        if name not in site_names():
            raise CaptureError(
                f"unknown sensor location {name!r}; say with --sites where the sensor is worn"
            )
    return names
