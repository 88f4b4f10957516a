# SPDX-License-Identifier: GPL-3.0-or-later
"""What a reconstruction says about itself: how late, how sure, and what it leans on."""

from __future__ import annotations

from collections import Counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import FILTER_REACH_S, GRAVITY_MPS2, Clip, MotionDatabase, Reconstruction, Reconstructor
from .take import Take

Floats = NDArray[np.float64]

LARGEST_MISFIT = 0.78
"""As a part of how much the readings vary.

Of HDM05 and CMU clips reconstructed from other people's or other motions, two in three of those
that came out worse than a constant pose are above it, and one in eight of the better ones.
"""

_FASTEST_RADPS = 15.0  # on median; nobody turns a limb so fast for long
_QUIET_MPS2 = 1.0  # readings that vary less than this fit anything


def latency_ms(reconstructor: Reconstructor, database: MotionDatabase) -> float:
    """Returns how late an online estimate is: the method's look-ahead and the filter's."""
    return 1000.0 * (reconstructor.latency_frames / database.rate_hz + FILTER_REACH_S)


def mean_misfit_mps2(solved: Reconstruction) -> float:
    """Returns how far retrieved readings are from measured ones, over sensors and frames."""
    return _mean(np.asarray(solved.sensor_misfit_mps2))


def relative_misfit(solved: Reconstruction, readings: Floats) -> float:
    """Returns the misfit as a part of how much the readings (T, S, 3) vary; 0 is a perfect fit."""
    variation: list[float] = []
    for sensor in np.moveaxis(readings, 1, 0):
        heard = sensor[np.isfinite(sensor).all(axis=1)]
        variation.extend(np.linalg.norm(heard - heard.mean(axis=0), axis=1) if len(heard) else ())
    return mean_misfit_mps2(solved) / max(float(np.mean(variation or [0.0])), _QUIET_MPS2)


def is_unlike_the_database(solved: Reconstruction, readings: Floats) -> bool:
    """Whether the database holds nothing like the performance, so that the result is a guess."""
    return relative_misfit(solved, readings) > LARGEST_MISFIT


def suspicions(take: Take) -> list[str]:
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


def report(
    database: MotionDatabase,
    sites: list[str],
    times_s: Floats,
    readings: Floats,
    solved: Reconstruction,
) -> dict[str, Any]:
    """Returns, as JSON has it, what the reconstruction says of the whole take and each frame."""
    names = [_full_name(clip) for clip in database.clips]
    leant_on = [names[index] for index in np.asarray(solved.clips).tolist()]
    misfit, spread = np.asarray(solved.sensor_misfit_mps2), np.asarray(solved.spread_m)
    frames = [
        {
            "time_s": round(time, 6),
            "misfit_mps2": [_rounded(value) for value in row],
            "spread_m": _rounded(float(np.mean(at))),
            "clip": clip,
        }
        for time, row, at, clip in zip(
            times_s.tolist(), misfit.tolist(), spread, leant_on, strict=True
        )
    ]
    return {
        "sites": sites,
        "relative_misfit": _rounded(relative_misfit(solved, readings)),
        "is_unlike_the_database": is_unlike_the_database(solved, readings),
        "mean_misfit_mps2": _rounded(_mean(misfit)),
        "mean_spread_m": _rounded(_mean(spread)),
        "clips": dict(Counter(leant_on).most_common()),
        "frames": frames,
    }


def _full_name(clip: Clip) -> str:
    copies = [" mirrored"] * clip.is_mirrored + [" reversed"] * clip.is_reversed
    copies += [f" at tempo {clip.tempo:g}"] * (clip.tempo != 1.0)
    return clip.name + "".join(copies)


def _mean(values: Floats) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.mean()) if finite.size else 0.0


def _rounded(value: float) -> float | None:
    return round(value, 4) if np.isfinite(value) else None
