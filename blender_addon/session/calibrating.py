# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration: the performer makes guided movements, which show how the sensors are worn."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .core import capture, core
from .errors import InputError
from .file_cache import FileCache
from .job import Cancelled, Job, Progress
from .live import ANSWER_WITHIN_S, LiveSession, answer_of
from .new_files import free_path, stamp

CALIBRATING = "Calibrating"
_POLL_S = 0.05
_SETTLE_S = 0.5
"""By then the samples from a phase's end have arrived."""


@dataclass(frozen=True)
class Phase:
    """A step of the guided movements."""

    name: str
    """"stand", a guided movement's name, or empty while the performer gets ready for the next."""
    text: str
    """What to do; how to do it follows after the first comma."""
    seconds: float


PHASES = (
    Phase("", "Get ready, you will stand still with your arms hanging", 5.0),
    Phase("stand", "Stand still, arms hanging, palms at the thighs", 3.0),
    Phase("", "Next: elbows, bend both five times, thumbs forward", 4.0),
    Phase("bend_elbows", "Bend both elbows, five times, thumbs forward, upper arms still", 8.0),
    Phase("", "Next: squats, five times on the spot", 4.0),
    Phase("squat", "Squat, five times, heels on the ground", 10.0),
)


@dataclass(frozen=True)
class Calibrated:
    """A new calibration and its file."""

    path: str
    calibration: Any  # sparse_mocap.calibration.Calibration
    notes: tuple[str, ...]


def calibrating_job(
    session: LiveSession, folder: Path, height_m: float, phases: tuple[Phase, ...] = ()
) -> Job:
    """The job that guides the performer and calibrates the sensors; its result is a Calibrated.

    The sensors are recorded meanwhile. phases: PHASES when empty. Raises InputError.
    """
    module = capture()
    phases = phases or PHASES
    if session.state.recording is not None:
        raise InputError("A recording is running: stop it before you calibrate")

    def work(progress: Progress) -> Calibrated:
        total_s = sum(phase.seconds for phase in phases)
        answer_of(session.record(total_s + ANSWER_WITHIN_S), ANSWER_WITHIN_S)
        try:
            begin_s = time.perf_counter()
            _guide(phases, begin_s, progress)
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


def _guide(phases: tuple[Phase, ...], begin_s: float, progress: Progress) -> None:
    """Report the current phase as progress until all are done. Raises Cancelled."""
    total_ms = round(1e3 * sum(phase.seconds for phase in phases))
    end_s = begin_s
    for phase in phases:
        end_s += phase.seconds
        while (now_s := time.perf_counter()) < end_s:
            what = f"{phase.text}: {math.ceil(end_s - now_s)}"
            if not progress(min(round(1e3 * (now_s - begin_s)), total_ms), total_ms, what):
                raise Cancelled("Cancelled")
            time.sleep(_POLL_S)
    time.sleep(_SETTLE_S)


def _steps(phases: tuple[Phase, ...], begin_s: float) -> Any:
    """The phases' spans; begin_s: start of the first phase in take time."""
    spans = []
    for phase in phases:
        spans.append((phase.name, (begin_s, begin_s + phase.seconds)))
        begin_s += phase.seconds
    (stand,) = (span for name, span in spans if name == "stand")
    moves = tuple((name, span) for name, span in spans if name not in ("", "stand"))
    return core().calibration.Steps(stand, moves)


def calibration_at(path: str) -> Any:
    """The calibration in the file; None when the path is empty.

    Raises InputError, OSError or FormatError.
    """
    return calibrations.get(path) if path else None


calibrations: FileCache[Any] = FileCache(
    "calibration", lambda path: core().calibration_file.read_calibration(path)
)
