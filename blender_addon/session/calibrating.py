# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration: the performer is led through movements that tell how the sensors are worn."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .core import capture, core
from .errors import InputError
from .job import Cancelled, Job, Progress
from .live import ANSWER_WITHIN_S, LiveSession, answer_of
from .new_files import free_path, stamp
from .opened import Shelf

CALIBRATING = "Calibrating"
_NAP_S = 0.05
_SETTLE_S = 0.5
"""What was read at a phase's end has arrived by then."""


@dataclass(frozen=True)
class Phase:
    """Something that the performer does for a while."""

    name: str
    """"stand", a guided movement's name, or empty while the performer gets ready for the next."""
    text: str
    """What to do, and after the first comma how."""
    seconds: float


PHASES = (
    Phase("", "Get ready, to stand still with hanging arms", 5.0),
    Phase("stand", "Stand still, arms hanging, palms at the thighs", 3.0),
    Phase("", "Next: elbows, bend both five times with the thumbs forward", 4.0),
    Phase("bend_elbows", "Bend both elbows, five times, thumbs forward, upper arms still", 8.0),
    Phase("", "Next: squats, five of them on the spot", 4.0),
    Phase("squat", "Squat, five times, heels on the ground", 10.0),
)


@dataclass(frozen=True)
class Calibrated:
    """A calibration that was made and where it is kept."""

    path: str
    calibration: Any  # sparse_mocap.calibration.Calibration
    notes: tuple[str, ...]


def calibrating_job(
    session: LiveSession, folder: Path, height_m: float, phases: tuple[Phase, ...] = ()
) -> Job:
    """The job that leads the performer and calibrates the session's sensors; gives a Calibrated.

    What the sensors read is recorded meanwhile. phases: PHASES when there are none. Raises
    InputError.
    """
    module = capture()
    phases = phases or PHASES
    if session.state.recording is not None:
        raise InputError("A recording goes on: stop it before you calibrate")

    def work(progress: Progress) -> Calibrated:
        total_s = sum(phase.seconds for phase in phases)
        answer_of(session.record(total_s + ANSWER_WITHIN_S), ANSWER_WITHIN_S)
        try:
            begin_s = time.monotonic()
            _lead(phases, begin_s, progress)
        finally:
            logs, number = answer_of(session.stop_recording(), ANSWER_WITHIN_S)
        recorded = module.recording_to_take(logs, number)
        steps = _steps(phases, begin_s - recorded.begin_ns * 1e-9)
        found = core().calibration.calibrate(recorded.take, steps, height_m=height_m)
        folder.mkdir(parents=True, exist_ok=True)
        path = free_path(folder / f"calibration-{stamp()}.json")
        core().calibration_file.write_calibration(path, found)
        return Calibrated(str(path), found, tuple(found.notes))

    return Job(CALIBRATING, work)


def _lead(phases: tuple[Phase, ...], begin_s: float, progress: Progress) -> None:
    """Says what to do until all is done. Raises Cancelled."""
    total_ms = round(1e3 * sum(phase.seconds for phase in phases))
    end_s = begin_s
    for phase in phases:
        end_s += phase.seconds
        while (now_s := time.monotonic()) < end_s:
            told = f"{phase.text}: {end_s - now_s:.0f}"
            if not progress(min(round(1e3 * (now_s - begin_s)), total_ms), total_ms, told):
                raise Cancelled("Cancelled")
            time.sleep(_NAP_S)
    time.sleep(_SETTLE_S)


def _steps(phases: tuple[Phase, ...], begin_s: float) -> Any:
    """The phases' spans; begin_s is when the first began, on the take's clock."""
    spans = []
    for phase in phases:
        spans.append((phase.name, (begin_s, begin_s + phase.seconds)))
        begin_s += phase.seconds
    (stand,) = (span for name, span in spans if name == "stand")
    moves = tuple((name, span) for name, span in spans if name not in ("", "stand"))
    return core().calibration.Steps(stand, moves)


def calibration_at(path: str) -> Any:
    """The calibration in the file, None when the path is empty.

    Raises InputError, OSError or what the file is at fault for.
    """
    return calibrations.get(path) if path else None


calibrations: Shelf[Any] = Shelf(
    "calibration", lambda path: core().calibration_file.read_calibration(path)
)
