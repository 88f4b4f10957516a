# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes as part of a motion database: what real sensors measured while a motion was performed."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from . import _core
from .alignment import AlignmentError, aligned
from .calibration import Calibration
from .databases import add_to_database
from .mappings import to_standard
from .motion_files import read_options
from .reconstruction import sensor_recordings, used_sensors, with_locations
from .take import read_take

if TYPE_CHECKING:
    from typing import Unpack

    from ._core_database import _ImportOptions

__all__ = ["Pairing", "TaughtClip", "pair_take", "teach_database"]

AnyPath = str | os.PathLike[str]
Progress = Callable[[int, int, str], bool | None]

LEAST_CORRELATION = 0.8
"""Takes and motions that agree less are not of one performance."""
_LEAST_COVERAGE = 0.5
_LARGEST_RUNNER_UP = 0.95  # as a part of the correlation
_QUALITIES = ((0.95, "very good"), (0.88, "good"), (LEAST_CORRELATION, "fair"))
_TOLD = {
    "specific_force": "acceleration",
    "angular_velocity": "turning (no gyroscope)",
    "orientation": "orientation",
}


@dataclass(frozen=True)
class Pairing:
    """How a take fits a motion that was performed while it was recorded."""

    begin_s: float
    """When the motion begins, on the take's clock."""
    correlation: float
    """Of what the sensors measured with what virtual ones read, over all sensors; at most 1."""
    coverage: float
    """The part of the motion during which the take was recorded."""
    sensor_correlations: dict[str, float]
    """The same of each sensor alone."""

    @property
    def quality(self) -> str:
        """The correlation in words: very good, good or fair; poor where it is refused."""
        return next((word for least, word in _QUALITIES if self.correlation >= least), "poor")

    @property
    def line(self) -> str:
        """All this in one line."""
        share = "" if self.coverage > 0.995 else f", it covers {100 * self.coverage:.0f} % of it"
        return (
            f"the motion begins at {self.begin_s:.2f} s of the take{share}; their agreement is "
            f"{self.quality} ({self.correlation:.2f} of 1)"
        )


@dataclass(frozen=True)
class TaughtClip:
    """What became of a motion and its take."""

    pairing: Pairing
    report: _core.BuildReport
    """Of the import."""
    real: dict[str, list[str]]
    """By sensor location, the channels of which the database holds what was measured."""
    notes: list[str]
    """What stays virtual, a line each."""


def pair_take(
    motion: AnyPath,
    take: AnyPath,
    *,
    clap: tuple[float, float] | None = None,
    calibration: Calibration | None = None,
    positions_along_bone: Mapping[str, float] | None = None,
    use_gyroscopes: bool = True,
    by_hand: Mapping[str, str] | None = None,
    read: _core.ReadOptions | None = None,
    progress: Progress | None = None,
) -> tuple[Pairing, _core.PairedTake]:
    """Returns how a take file fits the motion file, and the take as a database takes it.

    clap: when, in the take's seconds, a clap or jump happened that the motion has too; it also
    synchronizes the sensors' clocks. Without one, the time is found by comparing what the sensors
    measured with what virtual ones read. calibration and positions_along_bone are as for
    reconstruct(); by_hand: the motion's joint by standard joint; read: what the file does not say
    (see read_options).

    Raises AlignmentError where take and motion are not of one performance, or several times fit,
    FormatError, MappingError, TakeError, ConfigError, Cancelled and OSError.
    """
    performed, _ = _core.read_motion(motion, read or read_options())
    found, _ = to_standard(performed, by_hand=dict(by_hand) if by_hand else None)
    recorded = with_locations(read_take(take), calibration)
    if clap is not None:
        recorded, _ = aligned(recorded, clap)
    sensors = used_sensors(recorded, calibration, positions_along_bone, use_gyroscopes)
    recordings = sensor_recordings(recorded)
    alignment = _core.align_take(found, recordings, sensors, event=clap, progress=progress)
    sites = [sensor.site for sensor in sensors]
    pairing = Pairing(
        alignment.begin_s,
        alignment.correlation,
        alignment.coverage,
        dict(zip(sites, alignment.sensor_correlations, strict=False)),
    )
    names = (Path(motion).name, Path(take).name)
    _refuse_poor(pairing, None if clap else alignment.runner_up, *names)
    digest = hashlib.sha256(Path(take).read_bytes()).hexdigest()
    return pairing, _core.PairedTake(
        names[1],
        digest,
        sensors,
        recordings,
        begin_s=alignment.begin_s,
        correlation=alignment.correlation,
    )


def _refuse_poor(pairing: Pairing, runner_up: float | None, motion: str, take: str) -> None:
    if pairing.coverage < _LEAST_COVERAGE:
        raise AlignmentError(
            f"{take} covers only {100 * pairing.coverage:.0f} % of {motion}: cut the motion to "
            "what was recorded, or record all of it"
        )
    if pairing.correlation < LEAST_CORRELATION:
        least = min(pairing.sensor_correlations.items(), key=lambda item: item[1])
        raise AlignmentError(
            f"{take} does not fit {motion}: what the sensors measured agrees with the motion by "
            f"{pairing.correlation:.2f}, at least {LEAST_CORRELATION} is needed; worst is "
            f"{least[0]} with {least[1]:.2f}: check that both show the same performance and that "
            "each sensor is named after where it was worn; if the sensors' clocks differ, clap "
            "once and say when"
        )
    if runner_up is not None and runner_up > _LARGEST_RUNNER_UP * pairing.correlation:
        raise AlignmentError(
            f"{motion} fits {take} at several times (by {pairing.correlation:.2f} and "
            f"{runner_up:.2f}), as when a movement repeats: clap or jump once in both and say when"
        )


def teach_database(
    database: AnyPath,
    motion: AnyPath,
    take: AnyPath,
    output: AnyPath | None = None,
    *,
    clap: tuple[float, float] | None = None,
    calibration: Calibration | None = None,
    positions_along_bone: Mapping[str, float] | None = None,
    use_gyroscopes: bool = True,
    **options: Unpack[_ImportOptions],
) -> TaughtClip:
    """Adds a motion file together with the take that sensors recorded during it.

    The motion's rows keep what the sensors measured, in place of what virtual ones read, so that
    takes of sensors that are worn alike find them. What the take lacks stays virtual.
    A motion that is in the database already is replaced. Further options are as for
    add_to_database(); errors as for it and for pair_take(), the database is untouched then.
    """
    pairing, paired = pair_take(
        motion,
        take,
        clap=clap,
        calibration=calibration,
        positions_along_bone=positions_along_bone,
        use_gyroscopes=use_gyroscopes,
        by_hand=options.get("by_hand"),
        read=options.get("read"),
        progress=options.get("progress"),
    )
    report = add_to_database(database, [motion], output, takes={motion: paired}, **options)
    opened = _core.MotionDatabase(database if output is None else output)
    held = next(
        clip.take
        for clip in opened.clips
        if clip.take is not None and clip.take.hash == paired.hash
    )
    real = dict(held.channels)
    return TaughtClip(pairing, report, real, _notes(real))


def _notes(real: Mapping[str, list[str]]) -> list[str]:
    """What stays virtual at the sensors' locations."""
    notes = []
    for channel, what in _TOLD.items():
        lacking = [site for site, channels in real.items() if channel not in channels]
        if lacking:
            notes.append(f"{what} stays virtual at {', '.join(lacking)}")
    return notes
