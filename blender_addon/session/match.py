# SPDX-License-Identifier: GPL-3.0-or-later
"""How near to the performance a result is likely to be, where it is poor, and what would help."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .core import core

Floats = NDArray[np.float64]

POOR = "poor"
ODD_SENSOR = "Check the sensor at {site}: it fits far worse than the others"

_ODD_RATIO, _ODD_MPS2 = 2.5, 4.0
"""A sensor is odd whose misfit is so many times the median of the others', and at least that.

Of 55 clips of HDM05, one of each performer and kind, each left out of the database, 5 have one as
they are: a wrist, where arms circle or throw. With the axes of the right wrist's sensor exchanged,
36 have that one and 2 another.
"""


@dataclass(frozen=True)
class Match:
    """What a result says of itself."""

    label: str = ""
    """good, fair or poor."""
    seconds: tuple[str, ...] = ()
    """The same for each second; empty from a method that does not tell."""
    is_guess: bool = False
    """Whether the database has nothing like the take."""
    advice: str = ""
    """What would help; empty for a good one."""
    odd_sensor: str = ""
    """The location of a sensor that fits far worse than the others; empty without one."""


def match_of(solved: Any, database: Any) -> Match:
    """What a sparse_mocap.Reconstruction from a motion database says of itself."""
    sparse_mocap = core()
    odd = ""
    told = solved.diagnostics.get("sensor_misfit_mps2")
    if told is not None:
        odd = odd_sensor(list(solved.readings.sites), np.asarray(told))
    quality = sparse_mocap.quality.quality_of(solved, database)
    if quality is None:
        label = str(sparse_mocap.report.match(solved, database))
        return Match(label, advice=advice_for(label), odd_sensor=odd)
    advice = advice_for(quality.label, quality.advice)
    is_guess = quality.is_unlike_the_database
    return Match(quality.label, tuple(quality.second_labels), is_guess, advice, odd)


def advice_for(label: str, known: str = "") -> str:
    """What to do about a match as a sentence; empty when it is good.

    known: what the core says of it; without that it is what usually helps.
    """
    if known:
        return known[0].upper() + known[1:]
    if label == POOR:
        return (
            "Poor match: calibrate the sensors, check where they are worn, "
            "or add clips of such movements to the database"
        )
    if label == "fair":
        return "Fair match: calibrating the sensors, or more clips of such movements, may help"
    return ""


def odd_sensor(sites: Sequence[str], misfits_mps2: Floats) -> str:
    """The sensor whose readings fit far worse than those of the others; empty without one.

    misfits_mps2 (T, S): how far each is from what it reads in the retrieved motions, NaN where
    unknown.
    """
    sums = np.nansum(misfits_mps2, axis=0)
    means = sums / np.maximum(np.isfinite(misfits_mps2).sum(axis=0), 1)
    if len(means) < 3:  # which of two is wrong cannot be told
        return ""
    worst = int(np.argmax(means))
    usual = float(np.median(np.delete(means, worst)))
    is_odd = means[worst] >= max(_ODD_MPS2, _ODD_RATIO * usual)
    return sites[worst] if is_odd else ""


def poor_parts(seconds: Sequence[str]) -> list[tuple[int, int]]:
    """Where the match is poor: from and to, in s from the take's beginning."""
    parts, begin = [], 0
    for label, group in groupby(seconds):
        end = begin + len(list(group))
        if label == POOR:
            parts.append((begin, end))
        begin = end
    return parts
