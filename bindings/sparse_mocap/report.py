# SPDX-License-Identifier: GPL-3.0-or-later
"""What a reconstruction says about itself: how well sensors match, and which clips were used."""

from __future__ import annotations

from collections import Counter, deque
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._core import GRAVITY_MPS2, Clip, MotionDatabase, PoseEstimate, Reconstruction
from .take import Take

Floats = NDArray[np.float64]

__all__ = [
    "LARGEST_MISFIT",
    "LiveMatch",
    "is_unlike_the_database",
    "match",
    "match_of",
    "mean_misfit_mps2",
    "relative_misfit",
    "report",
    "unit_warnings",
]

GOOD_BELOW_MPS2, FAIR_BELOW_MPS2 = 2.5, 4.5
"""Limits of the misfit, the mean distance between retrieved and measured readings.

Of 143 HDM05 clips reconstructed from databases with the performer, without, or without such
movements, those below the first had a median error of 8 cm and one in 30 was worse than a constant
pose; those between 11 cm and 10 in 52; those above 17 cm and 42 in 61.
"""

LARGEST_MISFIT = 0.78
"""As a part of how much the readings vary; beyond it the match is poor.

Of HDM05 and CMU clips reconstructed from other people's or other motions, two in three of those
that came out worse than a constant pose are above it, and one in eight of the better ones.
"""

_FASTEST_RADPS = 15.0  # on median; nobody turns a limb so fast for long
_QUIET_MPS2 = 1.0  # readings that vary less than this match anything


def mean_misfit_mps2(solved: Reconstruction) -> float:
    """Returns how far retrieved readings are from measured ones, over sensors and frames."""
    return _mean(_diagnostic(solved, "sensor_misfit_mps2"))


def relative_misfit(solved: Reconstruction) -> float:
    """Returns the misfit as a part of how much the readings vary; 0 is a perfect match."""
    variation: list[float] = []
    for sensor in np.moveaxis(np.asarray(solved.readings.specific_force), 1, 0):
        measured = sensor[np.isfinite(sensor).all(axis=1)]
        variation.extend(
            np.linalg.norm(measured - measured.mean(axis=0), axis=1) if len(measured) else ()
        )
    return mean_misfit_mps2(solved) / max(float(np.mean(variation or [0.0])), _QUIET_MPS2)


def match_of(misfit_mps2: float) -> str:
    """Returns how well sensors match the motion database: "good", "fair" or "poor"."""
    if misfit_mps2 >= FAIR_BELOW_MPS2:
        return "poor"
    return "good" if misfit_mps2 < GOOD_BELOW_MPS2 else "fair"


def match(solved: Reconstruction) -> str:
    """Returns how well the sensors of a take match: "poor" where the result is a guess."""
    return "poor" if is_unlike_the_database(solved) else match_of(mean_misfit_mps2(solved))


class LiveMatch:
    """How well sensors match the motion database while they are live."""

    def __init__(self, num_poses: int = 250) -> None:
        """Takes how many poses are averaged."""
        self._misfits: deque[float] = deque(maxlen=num_poses)

    def add(self, estimate: PoseEstimate) -> None:
        """Takes what the method says of a pose."""
        misfit = np.asarray(estimate.diagnostics.get("sensor_misfit_mps2", ()))
        if np.isfinite(misfit).any():
            self._misfits.append(float(np.nanmean(misfit)))

    @property
    def match(self) -> str:
        """How well they match, as match_of() says; empty before there are poses."""
        return match_of(float(np.mean(self._misfits))) if self._misfits else ""


def is_unlike_the_database(solved: Reconstruction) -> bool:
    """Whether the database has nothing like the performance, so that the result is a guess."""
    return relative_misfit(solved) > LARGEST_MISFIT


def unit_warnings(take: Take) -> list[str]:
    """Returns a line for each sensor whose readings can hardly be in m/s^2 and rad/s."""
    lines = []
    for site, record in take.sensors.items():
        size = float(np.median(np.linalg.norm(record.specific_force, axis=1)))
        if not 0.6 * GRAVITY_MPS2 < size < 10 * GRAVITY_MPS2:
            lines.append(
                f"{site} reads {size:.2f} m/s^2 on median, where gravity alone is "
                f"{GRAVITY_MPS2:.2f}; ax,ay,az are in m/s^2 and include gravity"
            )
        elif np.ptp(record.specific_force, axis=0).max() == 0:
            lines.append(f"{site} always reads the same")
        if record.angular_velocity is not None:
            turn = float(np.median(np.linalg.norm(record.angular_velocity, axis=1)))
            if turn > _FASTEST_RADPS:
                lines.append(
                    f"{site} turns at {turn:.0f} rad/s on median; gx,gy,gz are in rad/s, and "
                    "--no-gyroscopes leaves them out"
                )
    return lines


def report(solved: Reconstruction, database: MotionDatabase | None) -> dict[str, Any]:
    """Returns, as JSON has it, what the reconstruction says of the whole take and each frame."""
    misfit = _diagnostic(solved, "sensor_misfit_mps2")
    spread = _diagnostic(solved, "spread_m")
    clips = _clip_names(solved, database)
    relative = relative_misfit(solved)
    frames = [
        {
            "time_s": round(time, 6),
            "misfit_mps2": [_rounded(value) for value in row],
            "spread_m": _rounded(_mean(at)),
            "clip": clip,
        }
        for time, row, at, clip in zip(
            solved.readings.times_s.tolist(), misfit.tolist(), spread, clips, strict=True
        )
    ]
    return {
        "sites": solved.readings.sites,
        "match": match(solved),
        "relative_misfit": _rounded(relative),
        "is_unlike_the_database": is_unlike_the_database(solved),
        "mean_misfit_mps2": _rounded(_mean(misfit)),
        "mean_spread_m": _rounded(_mean(spread)),
        "clips": dict(Counter(name for name in clips if name is not None).most_common()),
        "frames": frames,
    }


def _clip_names(solved: Reconstruction, database: MotionDatabase | None) -> list[str | None]:
    if database is None or "clip" not in solved.diagnostics:
        return [None] * len(solved.readings)
    names = [_full_name(clip) for clip in database.clips]
    return [names[int(index)] for index in solved.diagnostics["clip"][:, 0]]


def _full_name(clip: Clip) -> str:
    copies = [" mirrored"] * clip.is_mirrored + [" reversed"] * clip.is_reversed
    copies += [f" at tempo {clip.tempo:g}"] * (clip.tempo != 1.0)
    return clip.name + "".join(copies)


def _diagnostic(solved: Reconstruction, name: str) -> Floats:
    """Returns what the method says by that name, (T, N); (T, 0) when it says nothing."""
    told = solved.diagnostics.get(name)
    return np.empty((len(solved.readings), 0)) if told is None else np.asarray(told)


def _mean(values: Floats) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if finite.size else 0.0


def _rounded(value: float) -> float | None:
    return round(value, 4) if np.isfinite(value) else None
