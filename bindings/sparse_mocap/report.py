# SPDX-License-Identifier: GPL-3.0-or-later
"""What a reconstruction says about itself: how well sensors match, and which clips were used."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._core import GRAVITY_MPS2, Clip, MotionDatabase, PoseEstimate, Reconstruction
from .quality import JudgedFrame, Quality, judged, judged_frame, quality_of
from .take import Take

Floats = NDArray[np.float64]

__all__ = [
    "LiveMatch",
    "match",
    "match_of",
    "mean_misfit_mps2",
    "report",
    "unit_warnings",
]

GOOD_BELOW_MPS2, FAIR_BELOW_MPS2 = 2.5, 4.5
"""Limits of the misfit, the mean distance between retrieved and measured readings, where a method
tells nothing else.

Of 143 HDM05 clips reconstructed from databases with the performer, without, or without such
movements, those below the first had a median error of 8 cm and one in 30 was worse than a constant
pose; those between 11 cm and 10 in 52; those above 17 cm and 42 in 61.
"""

_JUDGED_EVERY = 10  # live poses
_FASTEST_RADPS = 15.0  # on median; nobody turns a limb so fast for long


def mean_misfit_mps2(solved: Reconstruction) -> float:
    """Returns how far retrieved readings are from measured ones, over sensors and frames."""
    return _mean(_diagnostic(solved, "sensor_misfit_mps2"))


def match_of(misfit_mps2: float) -> str:
    """Returns how well sensors match the motion database: "good", "fair" or "poor"."""
    if misfit_mps2 >= FAIR_BELOW_MPS2:
        return "poor"
    return "good" if misfit_mps2 < GOOD_BELOW_MPS2 else "fair"


def match(solved: Reconstruction, database: MotionDatabase | None = None) -> str:
    """Returns how good a take is likely to be, as quality_of() says, by the database it is from.

    For methods that tell nothing but the misfit it is match_of() that.
    """
    quality = quality_of(solved, database)
    return match_of(mean_misfit_mps2(solved)) if quality is None else quality.label


class LiveMatch:
    """How good the last live poses are likely to be, by the same measure as a take's match."""

    def __init__(
        self,
        num_poses: int = 250,
        database: MotionDatabase | None = None,
        channels: Sequence[Sequence[str]] = (),
    ) -> None:
        """Takes how many poses are judged together, and the database that they are made from.

        channels are those of each sensor.
        """
        self._database, self._channels = database, channels
        self._misfits: deque[float] = deque(maxlen=num_poses)
        self._frames: deque[JudgedFrame] = deque(maxlen=num_poses)
        self._quality: Quality | None = None
        self._num_new = 0

    def add(self, estimate: PoseEstimate) -> None:
        """Takes what the method says of a pose."""
        misfit = np.asarray(estimate.diagnostics.get("sensor_misfit_mps2", ()))
        if np.isfinite(misfit).any():
            self._misfits.append(float(np.nanmean(misfit)))
        frame = judged_frame(estimate)
        if frame is not None:
            self._frames.append(frame)
            self._num_new += 1

    @property
    def quality(self) -> Quality | None:
        """What is judged anew after some poses; None for methods that tell nothing but the misfit.

        Also None before there are poses.
        """
        if self._frames and (self._quality is None or self._num_new >= _JUDGED_EVERY):
            self._quality = judged(self._frames, self._database, self._channels)
            self._num_new = 0
        return self._quality

    @property
    def match(self) -> str:
        """Good, fair or poor, by the same measure as of a take; empty before there are poses."""
        if not self._misfits:
            return ""
        quality = self.quality
        return match_of(float(np.mean(self._misfits))) if quality is None else quality.label

    @property
    def advice(self) -> str:
        """What would help; empty for a good match, and for methods that tell only the misfit."""
        quality = self.quality
        return "" if quality is None else quality.advice


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
    quality = quality_of(solved, database)
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
        "match": match(solved, database),
        "quality": None if quality is None else _told(quality),
        "is_unlike_the_database": quality is not None and quality.is_unlike_the_database,
        "mean_misfit_mps2": _rounded(_mean(misfit)),
        "mean_spread_m": _rounded(_mean(spread)),
        "clips": dict(Counter(name for name in clips if name is not None).most_common()),
        "frames": frames,
    }


def _told(quality: Quality) -> dict[str, Any]:
    return {
        "expected_share_of_mean_pose_error": _rounded(quality.share),
        "seconds": list(quality.second_labels),
        "advice": quality.advice,
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
