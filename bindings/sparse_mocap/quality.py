# SPDX-License-Identifier: GPL-3.0-or-later
"""How good a reconstruction is likely to be: good, fair or poor, for a take and each second of it.

A reconstruction is poor when a pose held still, the mean one, would be nearer to the truth. That is
foreseen from how far the retrieved poses lie apart, how far their readings are from the measured
ones, how often the retrieved movement changes, and how much readings and poses vary. What these
mean is learned from a database itself: some of its clips are reconstructed from the others, without
their performers, and without their kinds of movement.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._core import MotionDatabase, PoseEstimate, Reconstruction, standard_joint_names

__all__ = [
    "Evidence",
    "JudgedFrame",
    "Quality",
    "evidence_of",
    "judged",
    "judged_frame",
    "measures_of",
    "quality_of",
]

Floats = NDArray[np.float64]

SECTION, VERSION = "quality", 1

# Of 404 reconstructions of HDM05 and CMU clips, see quality_calibration: the logarithm of the error
# as a part of the mean pose's, by measures_of().
USUAL = (1.27, 0.69, 1.14, -1.09, -0.34, 0.35)
# What is added in best quality, and where most sensors have gyroscopes or orientations: measured on
# every second of HDM05's test clips.
_BEST_QUALITY, _GYROSCOPES, _ORIENTATIONS = -0.07, -0.1, -0.28
_TYPICAL_SPREAD_M, _TYPICAL_MISFIT_MPS2 = 0.06, 2.6

_UNLIKE_ADVICE = (
    "the motion database has nothing like this take: add clips of such movements, calibrate the "
    "sensors, or check where they are worn"
)
_ALIKE_ADVICE = (
    "several movements of the motion database fit the sensors alike: more sensors, sensors with "
    "gyroscopes, or clips of this performer help"
)

NUM_JOINTS = len(standard_joint_names())  # those that are judged: no feet, toes and hands
_FAIR_FROM, _POOR_FROM = 0.65, 0.95  # of the mean pose's error: as many warnings as are due
_SECONDS_AROUND_S = 1.0  # a second is judged with what is so near to its middle
_NEEDED = frozenset({"spread_m", "sensor_misfit_mps2", "database_frame"})
_HOP_FRAMES = 3  # a retrieved movement that goes on moves less in the database from frame to frame


@dataclass(frozen=True)
class Quality:
    """What can be said of a reconstruction."""

    label: str
    """"good", "fair" or "poor"; poor: a pose held still is likely to be nearer to the truth."""
    share: float
    """The error that is expected, as a part of that of the mean pose held still."""
    second_labels: tuple[str, ...]
    """The same for each second; empty for live poses."""
    is_unlike_the_database: bool
    """Whether it is poor because the sensors read what nothing in the database does."""
    advice: str
    """What would help; empty for a good one."""


@dataclass(frozen=True)
class _Calibration:
    coefficients: tuple[float, ...] = USUAL
    spread_m: float = _TYPICAL_SPREAD_M
    """That is typical of clips of the database that are reconstructed from the others."""
    misfit_mps2: float = _TYPICAL_MISFIT_MPS2


@dataclass(frozen=True)
class Evidence:
    """What a reconstruction says of its frames."""

    spread_m: Floats
    """(T,) of the retrieved poses, RMS over the joints."""
    misfit_mps2: Floats
    """(T,) mean over the sensors."""
    frames: Floats
    """(T,) rows of the database that poses are closest to."""
    readings_vary_mps2: float
    poses_vary_m: float

    def part(self, rows: slice) -> Evidence:
        """Returns what is said of some of the frames; what varies stays the whole's."""
        return Evidence(
            self.spread_m[rows],
            self.misfit_mps2[rows],
            self.frames[rows],
            self.readings_vary_mps2,
            self.poses_vary_m,
        )


def quality_of(solved: Reconstruction, database: MotionDatabase | None = None) -> Quality | None:
    """Returns how good it is likely to be; None for a method that retrieves nothing.

    The database is the one that it was made from.
    """
    if not _NEEDED.issubset(solved.diagnostics):
        return None
    evidence = evidence_of(solved, slice(None))
    calibration = _calibration_of(database)
    offset = _offset(solved.readings.channels)
    if solved.latency_s is None:
        offset += _BEST_QUALITY
    times_s = np.asarray(solved.readings.times_s)
    seconds = []
    for begin_s in np.arange(times_s[0], times_s[-1] + 1e-9, 1.0):
        near = np.flatnonzero(np.abs(times_s - begin_s - 0.5) <= _SECONDS_AROUND_S)
        part = evidence.part(slice(int(near[0]), int(near[-1]) + 1))
        seconds.append(_label(_share(part, calibration, offset)))
    return _quality(evidence, calibration, offset, tuple(seconds))


class JudgedFrame(NamedTuple):
    """What a live pose says of itself."""

    spread_m: float
    misfit_mps2: float
    database_frame: float
    specific_force: Floats
    """(S, 3) m/s^2 that the sensors measured."""
    positions: Floats
    """(21, 3) m in the heading frame."""


def judged_frame(estimate: PoseEstimate) -> JudgedFrame | None:
    """Returns what a live pose says of itself; None for a method that retrieves nothing."""
    told = estimate.diagnostics
    if not {*_NEEDED, "specific_force_mps2"}.issubset(told):
        return None
    return JudgedFrame(
        float(np.sqrt((told["spread_m"] ** 2).mean())),
        float(_known_mean(told["sensor_misfit_mps2"])),
        float(told["database_frame"][0]),
        told["specific_force_mps2"].reshape(-1, 3),
        estimate.positions[:NUM_JOINTS],
    )


def judged(
    frames: Sequence[JudgedFrame],
    database: MotionDatabase | None = None,
    channels: Sequence[Sequence[str]] = (),
) -> Quality:
    """Returns how good successive live poses are likely to be, by the same measure as a take.

    channels are those of each sensor.
    """
    evidence = _evidence(
        np.array([frame.spread_m for frame in frames]),
        np.array([frame.misfit_mps2 for frame in frames]),
        np.array([frame.database_frame for frame in frames]),
        np.array([frame.specific_force for frame in frames]),
        np.array([frame.positions for frame in frames]),
    )
    return _quality(evidence, _calibration_of(database), _offset(channels), ())


def _offset(channels: Sequence[Sequence[str]]) -> float:
    """By what most of the sensors say: orientations, or turn rates, or forces alone."""
    most = 0.5 * len(channels)
    if sum("orientation" in of_sensor for of_sensor in channels) > most:
        return _ORIENTATIONS
    return _GYROSCOPES if sum("angular_velocity" in own for own in channels) > most else 0.0


def _quality(
    evidence: Evidence, calibration: _Calibration, offset: float, seconds: tuple[str, ...]
) -> Quality:
    share = _share(evidence, calibration, offset)
    label, is_unlike = _label(share), _is_unlike(evidence, calibration)
    advice = "" if label == "good" else _UNLIKE_ADVICE if is_unlike else _ALIKE_ADVICE
    return Quality(label, share, seconds, label == "poor" and is_unlike, advice)


def _calibration_of(database: MotionDatabase | None) -> _Calibration:
    found = None if database is None else database.section(SECTION, VERSION)
    if found is None:
        return _Calibration()
    told = json.loads(found["calibration"])
    return _Calibration(
        tuple(told["coefficients"]), float(told["spread_m"]), float(told["misfit_mps2"])
    )


def evidence_of(solved: Reconstruction, rows: slice) -> Evidence:
    """Returns what a reconstruction says of these frames."""
    told = solved.diagnostics
    return _evidence(
        np.sqrt((np.asarray(told["spread_m"])[rows] ** 2).mean(axis=1)),
        _known_mean(np.asarray(told["sensor_misfit_mps2"])[rows], axis=1),
        np.asarray(told["database_frame"])[rows, 0],
        np.asarray(solved.readings.specific_force)[rows],
        np.asarray(solved.motion.joint_positions("heading"))[:, :NUM_JOINTS][rows],
    )


def _evidence(
    spread_m: Floats, misfit_mps2: Floats, frames: Floats, force: Floats, poses: Floats
) -> Evidence:
    return Evidence(
        spread_m,
        misfit_mps2,
        frames,
        float(np.sqrt(_known_mean(((force - _known_mean(force, axis=0)) ** 2).sum(axis=-1)))),
        float(np.sqrt(((poses - poses.mean(axis=0)) ** 2).sum(axis=-1).mean())),
    )


def _known_mean(values: Floats, axis: int | None = None) -> Floats:
    """Returns the mean of what is known, 0 where nothing is."""
    is_known = np.isfinite(values)
    count = np.maximum(is_known.sum(axis=axis), 1)
    return np.asarray(np.where(is_known, values, 0.0).sum(axis=axis) / count)


def measures_of(evidence: Evidence) -> Floats:
    """Returns what the logarithm of the error is linear in."""
    moves = np.abs(np.diff(evidence.frames))
    return np.array(
        [
            1.0,
            np.log(max(float(np.sqrt((evidence.spread_m**2).mean())), 1e-3)),
            np.log(max(float(evidence.misfit_mps2.mean()), 0.05)),
            np.log(max(evidence.readings_vary_mps2, 0.3)),
            np.log(max(evidence.poses_vary_m, 0.01)),
            float((moves > _HOP_FRAMES).mean()) if len(moves) else 0.0,
        ]
    )


def _share(evidence: Evidence, calibration: _Calibration, offset: float) -> float:
    return float(np.exp(measures_of(evidence) @ np.array(calibration.coefficients) + offset))


def _label(share: float) -> str:
    if share > _POOR_FROM:
        return "poor"
    return "good" if share < _FAIR_FROM else "fair"


def _is_unlike(evidence: Evidence, calibration: _Calibration) -> bool:
    """Whether readings fit worse than is typical, rather than poses being in doubt."""
    misfit = float(evidence.misfit_mps2.mean()) / calibration.misfit_mps2
    spread = float(evidence.spread_m.mean()) / calibration.spread_m
    return misfit > max(1.0, spread)
