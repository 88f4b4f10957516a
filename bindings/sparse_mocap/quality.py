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
import os
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ._core import (
    Clip,
    MotionDatabase,
    Reconstruction,
    standard_joint_names,
    store_section,
)
from .reconstruction import reconstruct
from .take import SensorRecord, Take

__all__ = ["Quality", "calibrate_quality", "quality_of"]

Floats = NDArray[np.float64]

SECTION, VERSION = "quality", 1
SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")

# Of 404 reconstructions of HDM05 and CMU clips, see calibrate_quality(): the logarithm of the error
# as a part of the mean pose's, by _measures().
_USUAL = (1.27, 0.69, 1.14, -1.09, -0.34, 0.35)
_BEST_QUALITY = -0.07  # what it is in best quality beside that
_TYPICAL_SPREAD_M, _TYPICAL_MISFIT_MPS2 = 0.06, 2.6

_UNLIKE_ADVICE = (
    "the motion database has nothing like this take: add clips of such movements, calibrate the "
    "sensors, or check where they are worn"
)
_ALIKE_ADVICE = (
    "several movements of the motion database fit the sensors alike: more sensors, sensors with "
    "gyroscopes, or clips of this performer help"
)

_NUM_JOINTS = len(standard_joint_names())  # those that are judged: no feet, toes and hands
_FAIR_FROM, _POOR_FROM = 0.65, 0.95  # of the mean pose's error: as many warnings as are due
_SECONDS_AROUND_S = 1.0  # a second is judged with what is so near to its middle
_HOP_FRAMES = 3  # a retrieved movement that goes on moves less in the database from frame to frame

_SHARE = 0.025  # of the database's frames that are reconstructed for a calibration
_LONGEST_S, _FEWEST_CLIPS = 5.0, 20
_SETTLES = slice(8, -4)  # frames of a clip in which its neighbours in a row of clips are not felt
_TRUST = 20.0  # how many reconstructions what is usual counts for


@dataclass(frozen=True)
class Quality:
    """What can be said of a reconstruction."""

    label: str
    """"good", "fair" or "poor"; poor: a pose held still is likely to be nearer to the truth."""
    share: float
    """The error that is expected, as a part of that of the mean pose held still."""
    second_labels: tuple[str, ...]
    """The same for each second."""
    is_unlike_the_database: bool
    """Whether it is poor because the sensors read what nothing in the database does."""
    advice: str
    """What would help; empty for a good one."""


@dataclass(frozen=True)
class _Calibration:
    coefficients: tuple[float, ...] = _USUAL
    spread_m: float = _TYPICAL_SPREAD_M
    """That is typical of clips of the database that are reconstructed from the others."""
    misfit_mps2: float = _TYPICAL_MISFIT_MPS2


@dataclass(frozen=True)
class _Evidence:
    """What a reconstruction says of its frames."""

    spread_m: Floats
    """(T,) of the retrieved poses, RMS over the joints."""
    misfit_mps2: Floats
    """(T,) mean over the sensors."""
    frames: Floats
    """(T,) rows of the database that poses are closest to."""
    readings_vary_mps2: float
    poses_vary_m: float

    def part(self, rows: slice) -> _Evidence:
        return _Evidence(
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
    if not {"spread_m", "sensor_misfit_mps2", "database_frame"} <= set(solved.diagnostics):
        return None
    evidence = _evidence(solved, slice(None))
    calibration = _calibration_of(database)
    offset = _BEST_QUALITY if solved.latency_s is None else 0.0
    share = _share(evidence, calibration, offset)
    times_s = np.asarray(solved.readings.times_s)
    seconds = []
    for begin_s in np.arange(times_s[0], times_s[-1] + 1e-9, 1.0):
        near = np.flatnonzero(np.abs(times_s - begin_s - 0.5) <= _SECONDS_AROUND_S)
        part = evidence.part(slice(int(near[0]), int(near[-1]) + 1))
        seconds.append(_label(_share(part, calibration, offset)))
    label = _label(share)
    is_unlike = _is_unlike(evidence, calibration)
    advice = "" if label == "good" else _UNLIKE_ADVICE if is_unlike else _ALIKE_ADVICE
    return Quality(label, share, tuple(seconds), label == "poor" and is_unlike, advice)


def calibrate_quality(database: str | os.PathLike[str]) -> None:
    """Learns what good and poor reconstructions look like in a database, and keeps it there.

    A few of its clips are reconstructed thrice: without themselves, without their performers, and
    without their kinds of movement. Databases of a few clips are left alone. Raises FormatError and
    OSError.
    """
    opened = MotionDatabase(database)
    rows, logarithms, typical = [], [], []
    for kind, tests, excluded in _held_out(opened):
        for evidence, share in _reconstructed(opened, tests, excluded):
            rows.append(_measures(evidence))
            logarithms.append(np.log(share))
            if kind == "source":
                typical.append((evidence.spread_m.mean(), evidence.misfit_mps2.mean()))
    if not typical:
        return
    measures = np.array(rows)
    residuals = np.array(logarithms) - measures @ np.array(_USUAL)
    scatter = measures.T @ measures / len(measures)
    change = np.linalg.solve(
        measures.T @ measures + _TRUST * (scatter + 1e-6 * np.eye(len(_USUAL))),
        measures.T @ residuals,
    )
    spread_m, misfit_mps2 = np.median(typical, axis=0)
    found = {
        "coefficients": [float(value) for value in np.array(_USUAL) + change],
        "spread_m": float(spread_m),
        "misfit_mps2": float(misfit_mps2),
    }
    store_section(
        database,
        SECTION,
        {"calibration": json.dumps(found)},
        version=VERSION,
        rows=opened.rows_hash,
    )


def _calibration_of(database: MotionDatabase | None) -> _Calibration:
    found = None if database is None else database.section(SECTION, VERSION)
    if found is None:
        return _Calibration()
    told = json.loads(found["calibration"])
    return _Calibration(
        tuple(told["coefficients"]), float(told["spread_m"]), float(told["misfit_mps2"])
    )


def _evidence(solved: Reconstruction, rows: slice) -> _Evidence:
    told = solved.diagnostics
    force = np.asarray(solved.readings.specific_force)[rows]
    poses = np.asarray(solved.motion.joint_positions("heading"))[:, :_NUM_JOINTS][rows]
    misfit = np.asarray(told["sensor_misfit_mps2"])[rows]
    return _Evidence(
        np.sqrt((np.asarray(told["spread_m"])[rows] ** 2).mean(axis=1)),
        _known_mean(misfit, axis=1),
        np.asarray(told["database_frame"])[rows, 0],
        float(np.sqrt(_known_mean(((force - _known_mean(force, axis=0)) ** 2).sum(axis=-1)))),
        float(np.sqrt(((poses - poses.mean(axis=0)) ** 2).sum(axis=-1).mean())),
    )


def _known_mean(values: Floats, axis: int | None = None) -> Floats:
    """Returns the mean of what is known, 0 where nothing is."""
    is_known = np.isfinite(values)
    count = np.maximum(is_known.sum(axis=axis), 1)
    return np.asarray(np.where(is_known, values, 0.0).sum(axis=axis) / count)


def _measures(evidence: _Evidence) -> Floats:
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


def _share(evidence: _Evidence, calibration: _Calibration, offset: float) -> float:
    return float(np.exp(_measures(evidence) @ np.array(calibration.coefficients) + offset))


def _label(share: float) -> str:
    if share > _POOR_FROM:
        return "poor"
    return "good" if share < _FAIR_FROM else "fair"


def _is_unlike(evidence: _Evidence, calibration: _Calibration) -> bool:
    """Whether readings fit worse than is typical, rather than poses being in doubt."""
    misfit = float(evidence.misfit_mps2.mean()) / calibration.misfit_mps2
    spread = float(evidence.spread_m.mean()) / calibration.spread_m
    return misfit > max(1.0, spread)


def _held_out(database: MotionDatabase) -> list[tuple[str, list[int], list[int]]]:
    """Returns what is held out, clips to reconstruct, and the clips that are hidden then."""
    clips = database.clips
    originals = [
        i for i, c in enumerate(clips) if not (c.is_mirrored or c.is_reversed or c.tempo != 1.0)
    ]
    if len(originals) < _FEWEST_CLIPS:
        return []
    chance = np.random.default_rng(0)
    frames = _SHARE * database.num_frames / 3.0
    found = []
    for kind in ("source", "actor", "motion_class"):
        labels = [getattr(clip, kind) for clip in clips]
        names = sorted({labels[i] for i in originals})
        if len(names) < 2:
            continue
        hidden = set(chance.permutation(names)[: max(1, len(names) // 2)].tolist())
        tests: list[int] = []
        for i in chance.permutation([i for i in originals if labels[i] in hidden]).tolist():
            if sum(_length(database, clips[k]) for k in tests) < frames:
                tests.append(i)
        if kind == "source":
            hidden = {labels[i] for i in tests}
        excluded = [i for i, label in enumerate(labels) if label in hidden]
        if tests and len(excluded) < len(clips):
            found.append((kind, sorted(tests), excluded))
    return found


def _length(database: MotionDatabase, clip: Clip) -> int:
    return min(clip.end - clip.begin, round(_LONGEST_S * database.rate_hz))


def _reconstructed(
    database: MotionDatabase, tests: Sequence[int], excluded: Sequence[int]
) -> list[tuple[_Evidence, float]]:
    """Returns what is said of each clip, and its error as a part of the mean pose's.

    All are performed one after the other in one take, so that the database is prepared once.
    """
    lengths = [_length(database, database.clips[i]) for i in tests]
    rows = np.concatenate(
        [database.clips[i].begin + np.arange(n) for i, n in zip(tests, lengths, strict=True)]
    )
    forces, names = database.array("specific_force_end"), list(database.site_names)
    times_s = np.arange(len(rows)) / database.rate_hz
    columns = {site: 3 * names.index(site) for site in SITES}
    take = Take(
        {
            site: SensorRecord(times_s, forces[rows][:, at : at + 3].astype(float))
            for site, at in columns.items()
        }
    )
    solved = reconstruct(take, database, excluded_clips=excluded, use_gyroscopes=False)
    numbers = np.round(np.asarray(solved.readings.times_s) * database.rate_hz).astype(int)
    poses = np.asarray(solved.motion.joint_positions("heading"))[:, :_NUM_JOINTS]
    truth = database.array("positions")[rows].reshape(len(rows), -1, 3).astype(float)
    found, begin = [], 0
    for length in lengths:
        inner = range(begin, begin + length)[_SETTLES]
        at = np.flatnonzero((numbers >= inner.start) & (numbers < inner.stop))
        begin += length
        if len(at) < 2:
            continue
        wanted = truth[numbers[at]]
        mean = truth[inner.start : inner.stop].mean(axis=0)
        error, held = (_error_m(wanted, estimate) for estimate in (poses[at], mean))
        part = slice(int(at[0]), int(at[-1]) + 1)
        if error > 0.0 and held > 0.0:
            found.append((_evidence(solved, part), error / held))
    return found


def _error_m(truth: Floats, estimate: Floats) -> float:
    return float(np.sqrt(((truth - estimate) ** 2).sum(axis=-1).mean(axis=-1)).mean())
