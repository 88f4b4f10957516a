# SPDX-License-Identifier: GPL-3.0-or-later
"""From the samples of a capture to the newest pose."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .core import core
from .errors import InputError
from .match import odd_sensor
from .methods import MethodChoice

LARGEST_BACKLOG = 15
"""If more readings than this are waiting, only the newest is used."""
_NUM_POSES = 250  # that figures are averaged over


@dataclass(frozen=True)
class Pose:
    """One pose on the standard skeleton, in the core's axes."""

    number: int
    rotations: NDArray[np.float64]  # (J, 4) w x y z, the root's in the world
    root_position: NDArray[np.float64]  # (3,) m
    time_s: float
    """When the sensors read it, on the machine's monotonic clock."""
    spread_m: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    """(J,) how far the retrieved poses deviate; (0,) where the method tells nothing."""
    contacts: tuple[float, ...] = ()
    """How certain it is that the left and the right foot stand."""
    latent: NDArray[np.float64] = field(default_factory=lambda: np.empty(0))
    """(D,) where it is in the latent space of its type of motion; (0,) where there is none."""
    motion_type: int = 0
    """Number of that type."""


@dataclass(frozen=True)
class Quality:
    """How the last poses came out; 0 before there are any."""

    num_poses: int = 0
    num_skipped: int = 0
    """Readings that came faster than poses could be made of them."""
    match: str = ""
    """How near to the performance the poses are likely to be: good, fair or poor."""
    latency_s: float = 0.0
    """Median time from the sensors' reading to the pose."""
    worst_latency_s: float = 0.0
    """Of 99 in 100 poses."""
    advice: str = ""
    """What would help to a better match; empty when it is good."""
    odd_sensor: str = ""
    """The location of a sensor that fits far worse than the others; empty without one."""


class LivePoses:
    """Reconstructs poses from samples as they come; use it from one thread."""

    def __init__(
        self,
        motions: Any,
        sensors: dict[int, str],
        channels: list[list[str]],
        choice: MethodChoice,
        calibration: Any = None,
        devices: dict[int, str] | None = None,
    ) -> None:
        """sensors: the location of each sensor of the capture, by its number there.

        channels: what each measures. calibration: sparse_mocap.calibration.Calibration; None: the
        sensors are worn in the default orientation. devices: their identities, by number.
        """
        known = core().site_names()
        for site in sensors.values() if calibration is None else ():
            if site not in known:
                raise InputError(f'Unknown sensor location "{site}": enter where it is worn')
        self._reconstructor = core().LiveReconstructor(
            sensors,
            channels,
            motions,
            **choice.arguments(),
            calibration=calibration,
            devices=devices,
            largest_backlog=LARGEST_BACKLOG,
        )
        used = [sensor.channels for sensor in self._reconstructor.sensors]
        self._match = core().report.LiveMatch(_NUM_POSES, motions, used)
        self.latencies_s: deque[float] = deque(maxlen=_NUM_POSES)
        self._misfits: deque[NDArray[np.float64]] = deque(maxlen=_NUM_POSES)
        self._num_poses = 0

    def advance(self, samples: Any) -> Pose | None:
        """Add samples, and return the newest pose that is due, None when none is."""
        self._reconstructor.push(samples)
        pose = None
        for estimate in self._reconstructor.advance(time.perf_counter()):
            pose = self._pose(estimate)
        return pose

    @property
    def last_reading_s(self) -> float:
        """When the last reading was that any sensor was in, on the machine's monotonic clock."""
        return float(self._reconstructor.last_reading_s)

    @property
    def notes(self) -> tuple[str, ...]:
        """What the method says of the performance so far, a line each."""
        return tuple(self._reconstructor.notes)

    def quality(self) -> Quality:
        """How the last poses came out."""
        num_skipped = self._reconstructor.num_skipped
        if not self.latencies_s:
            return Quality(num_skipped=num_skipped)
        middle, worst = np.quantile(self.latencies_s, [0.5, 0.99])
        sites = [sensor.site for sensor in self._reconstructor.sensors]
        return Quality(
            self._num_poses,
            num_skipped,
            self._match.match,
            float(middle),
            float(worst),
            self._match.advice,
            odd_sensor(sites, np.array(self._misfits)) if self._misfits else "",
        )

    def _pose(self, estimate: Any) -> Pose:
        self._num_poses += 1
        self._match.add(estimate)
        if "sensor_misfit_mps2" in estimate.diagnostics:
            self._misfits.append(np.array(estimate.diagnostics["sensor_misfit_mps2"]))
        self.latencies_s.append(time.perf_counter() - estimate.time_s)
        return Pose(
            self._num_poses,
            np.array(estimate.rotations),
            np.array(estimate.root_position),
            estimate.time_s,
            np.array(estimate.diagnostics.get("spread_m", ())),
            tuple(float(contact) for contact in estimate.contacts),
            np.array(estimate.diagnostics.get("latent", ())),
            int(estimate.diagnostics.get("motion_type", (0,))[0]),
        )
