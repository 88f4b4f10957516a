# SPDX-License-Identifier: GPL-3.0-or-later
"""Reconstructs poses live from the samples of a capture."""

from __future__ import annotations

import time
from collections import deque
from typing import Any, TextIO

import numpy as np

from .. import LiveReconstructor, MotionDatabase, PoseEstimate
from ..calibration import Calibration
from ..capture.client import CaptureClient
from ..capture.errors import CaptureError
from ..positions import num_written, position_header, position_row
from ..readings import measured_channels
from ..report import LiveMatch
from .options import MethodChoice

__all__ = ["LiveSession"]

_NUM_POSES = 250  # the match and the delays are over the last poses


class LiveSession:
    """Reconstructs poses live from the samples of a capture."""

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
        used = {i: sensor for i, sensor in enumerate(status["sensors"]) if _is_used(sensor)}
        if not used:
            raise CaptureError(
                "no sensor has a sensor location; give it with --site NAME=SITE, see the names "
                "above"
            )
        channels = [measured_channels(sensor) for sensor in used.values()]
        self._reconstructor = LiveReconstructor(
            {number: str(sensor["site"]) for number, sensor in used.items()},
            channels,
            database,
            method=choice.method,
            preset=choice.preset,
            options=choice.options,
            calibration=calibration,
            devices={number: str(sensor["identity"]) for number, sensor in used.items()},
            model=model,
            body=body,
        )
        self._file: TextIO | None = None
        self._num_written = 0  # joints
        self._begin_s: float | None = None
        used_channels = [sensor.channels for sensor in self._reconstructor.sensors]
        self._live_match = LiveMatch(_NUM_POSES, database, used_channels)
        self.num_poses = 0
        self.latencies_s: deque[float] = deque(maxlen=_NUM_POSES)
        self.step_s: deque[float] = deque(maxlen=_NUM_POSES)

    def stream_to(self, file: TextIO, extremities: bool = False) -> None:
        """Writes the joint positions of each new pose, in the heading frame, to this file."""
        self._file = file
        names = self._reconstructor.skeleton.names
        self._num_written = num_written(names, extremities)
        file.write(position_header(names[: self._num_written]) + "\n")

    def advance(self) -> None:
        """Reads the samples that have arrived and reconstructs the poses that are due."""
        self._reconstructor.push(self._client.read())
        begin = time.perf_counter()
        estimates = self._reconstructor.advance(time.perf_counter())
        for estimate in estimates:
            self.step_s.append((time.perf_counter() - begin) / len(estimates))
            self._add_pose(estimate)
        if self._file is not None:
            self._file.flush()

    @property
    def match(self) -> str:
        """How well the sensors match the motion database; empty before there are poses."""
        return self._live_match.match

    @property
    def advice(self) -> str:
        """What would help to a better match; empty when it is good."""
        return self._live_match.advice

    def summary(self) -> str:
        """A summary of the session in one line."""
        if not self.num_poses:
            return "no poses: not all sensors sent data"
        return (
            f"{self.num_poses} poses; sensors match the motion database: {self.match}; delay "
            f"from movement to pose {1e3 * np.median(self.latencies_s):.0f} ms (worst "
            f"{1e3 * max(self.latencies_s):.0f} ms)" + (f"\n{self.advice}" if self.advice else "")
        )

    def _add_pose(self, estimate: PoseEstimate) -> None:
        self.num_poses += 1
        self._live_match.add(estimate)
        self.latencies_s.append(time.perf_counter() - estimate.time_s)
        if self._begin_s is None:
            self._begin_s = estimate.time_s
        if self._file is not None:
            positions = estimate.positions[: self._num_written]
            row = position_row(estimate.time_s - self._begin_s, positions)
            self._file.write(row + "\n")


def _is_used(sensor: dict[str, Any]) -> bool:
    return bool(sensor["site"]) and not sensor["is_replaced"]
