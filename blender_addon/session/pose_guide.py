# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration by poses: the performer imitates shown poses, which shows how trackers sit."""

from __future__ import annotations

import re
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .calibrating import Calibrated
from .core import capture, core
from .errors import InputError
from .job import Cancelled, Job, Progress
from .live import ANSWER_WITHIN_S, LiveSession, answer_of
from .names import shown_site
from .new_files import free_path, stamp

CALIBRATING_BY_POSES = "Calibrating by poses"
_POLL_S = 0.05
_SETTLE_S = 0.3
"""By then the samples from a pose's end have arrived."""
_MOST_ATTEMPTS = 3
"""At a pose, before the calibration is given up."""


@dataclass(frozen=True)
class Times:
    """How long the performer has, in seconds."""

    ready_s: float = 5.0
    """To take a pose."""
    hold_s: float = 3.0
    """To hold it."""


TIMES = Times()

POSE_TEXTS = {
    "arms_out": "Arms out to the sides, stand upright, palms down",
    "arms_forward": "Arms forward, stand upright, palms down",
    "arms_up": "Arms straight up, stand upright, palms outward",
    "elbows_bent": "Elbows bent, upper arms at the sides, forearms level and forward",
    "bow": "Bow by 45 degrees, back and knees straight, arms along the body",
    "left_knee_up": "Left knee up, thigh level, right arm forward, left arm out",
    "right_knee_up": "Right knee up, thigh level, left arm forward, right arm out",
    "lean_left": "Lean to the left, at the waist, arms stretched out from the chest",
}
"""What to do; how to do it follows after the first comma."""
READY = "Get ready"
HOLD = "Hold still"
MISSED = "The last pose was {degrees} degrees off"
MIRRORED = "As in a mirror"
FROM_RIGHT = "From your right"


@dataclass
class Shown:
    """What the performer is shown now."""

    pose: str = ""
    is_held: bool = False
    seconds: float = 0.0
    missed_deg: float | None = None
    """How far the last pose was from the one shown."""
    problem: str = ""
    """Why this pose is to be taken again."""


shown = Shown()


def points_of(pose: str) -> tuple[NDArray[np.float64], tuple[int, ...]]:
    """The joints of a medium body in a pose, (21, 3) m with y up and x to its left, and parents."""
    sparse_mocap = core()
    for name, _, rotations in sparse_mocap.pose_calibration.calibration_poses():
        if name == pose:
            skeleton = sparse_mocap.body_of_height(1.75).skeleton
            motion = sparse_mocap.Motion(skeleton, 1.0, np.zeros((1, 3)), rotations[None])
            return np.asarray(motion.joint_positions("world")[0]), tuple(skeleton.parents)
    raise KeyError(pose)


def views_of(points: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Joints (J, 3) of points_of() as they are drawn, (J, 2) m to the right and up, by view.

    In a mirror the performer's left is at the left.
    """
    return {
        MIRRORED: np.stack([-points[:, 0], points[:, 1]], axis=1),
        FROM_RIGHT: np.stack([points[:, 2], points[:, 1]], axis=1),
    }


def with_shown_names(text: str) -> str:
    """The text with sites and poses called as the panel and the viewport call them."""
    shown_names = {site: shown_site(site) for site in core().site_names()}
    shown_names |= {pose: f'"{told.partition(", ")[0]}"' for pose, told in POSE_TEXTS.items()}
    return re.sub(r"\w+", lambda word: shown_names.get(word[0], word[0]), text)


def pose_guide_job(session: LiveSession, folder: Path, times: Times | None = None) -> Job:
    """The job that guides the performer through all poses and calibrates the trackers.

    Its result is a Calibrated. Raises InputError.
    """
    times = times or TIMES
    if session.state.recording is not None:
        raise InputError("A recording is running: stop it before you calibrate")
    capture()

    def work(progress: Progress) -> Calibrated:
        try:
            found = _guided(session, times, progress)
        finally:
            _show(Shown())
        folder.mkdir(parents=True, exist_ok=True)
        path = free_path(folder / f"calibration-{stamp()}.json")
        core().calibration_file.write_calibration(path, found.calibration)
        return Calibrated(str(path), found.calibration, tuple(found.notes))

    return Job(CALIBRATING_BY_POSES, work)


def _guided(session: LiveSession, times: Times, progress: Progress) -> Any:
    """Show one pose after the other; the calibration from all of them."""
    module = core().pose_calibration
    guide = _Guide(times, progress, len(module.calibration_poses()))
    takes: list[Any] = []
    found = None
    for name, _, _ in module.calibration_poses():
        shown_now = Shown(name, missed_deg=found.missed_deg[-1][1] if found is not None else None)
        for attempt in range(_MOST_ATTEMPTS):
            guide.wait(shown_now, times.ready_s)
            takes.append((name, _held(session, guide, name, times.hold_s)))
            try:
                found = _calibrated(takes, times.hold_s)
                break
            except core().calibration.CalibrationError as error:
                problem = with_shown_names(str(error))
                if attempt == _MOST_ATTEMPTS - 1:
                    raise InputError(problem) from error
                takes.pop()
                shown_now = Shown(name, problem=problem)
    return found


def _calibrated(takes: list[tuple[str, Any]], hold_s: float) -> Any:
    """The calibration from the poses so far, each with its recording."""
    begin_ns = takes[0][1].begin_ns
    poses = []
    for name, recorded in takes:
        begin_s = recorded.take.begin_s + 1e-9 * (recorded.begin_ns - begin_ns)
        poses.append((name, (begin_s, begin_s + hold_s)))
    joined = _joined([recorded for _, recorded in takes])
    return core().pose_calibration.calibrate_by_poses(joined, poses)


def _held(session: LiveSession, guide: _Guide, pose: str, hold_s: float) -> Any:
    """What the trackers said while a pose was held."""
    answer_of(session.record(hold_s + ANSWER_WITHIN_S), ANSWER_WITHIN_S)
    try:
        guide.wait(Shown(pose, is_held=True), hold_s)
        time.sleep(_SETTLE_S)
    finally:
        logs, number = answer_of(session.stop_recording(), ANSWER_WITHIN_S)
    return capture().recording_to_take(logs, number)


def _joined(takes: list[Any]) -> Any:
    """Recordings of the same sensors as one take, on the clock of the first."""
    names = [name for name in takes[0].take.sensors if all(name in t.take.sensors for t in takes)]
    if not names:
        raise InputError(
            "No tracker sent data in all poses: check the trackers and calibrate again"
        )
    sensors = {}
    for name in names:
        parts = [recorded.take.sensors[name] for recorded in takes]
        shifts = [1e-9 * (recorded.begin_ns - takes[0].begin_ns) for recorded in takes]
        sensors[name] = replace(
            parts[0],
            times_s=np.concatenate([p.times_s + s for p, s in zip(parts, shifts, strict=True)]),
            specific_force=np.concatenate([p.specific_force for p in parts]),
            angular_velocity=_together([p.angular_velocity for p in parts]),
            orientation=_together([p.orientation for p in parts]),
            position=_together([p.position for p in parts]),
        )
    return core().Take(sensors, takes[0].take.comments)


def _together(parts: list[Any]) -> Any:
    return None if any(part is None for part in parts) else np.concatenate(parts)


class _Guide:
    """Counts down by a schedule that calculations do not delay, and reports it as progress."""

    def __init__(self, times: Times, progress: Progress, num_poses: int) -> None:
        self._progress = progress
        self._total_ms = round(1e3 * num_poses * (times.ready_s + times.hold_s))
        self._begin_s = self._end_s = time.perf_counter()

    def wait(self, what: Shown, seconds: float) -> None:
        """Show it for the next so many seconds. Raises Cancelled."""
        now_s = time.perf_counter()
        if self._end_s + seconds <= now_s:  # a calculation took longer than the time to get ready
            self._end_s = now_s
        self._end_s += seconds
        while (left_s := self._end_s - time.perf_counter()) > 0.0:
            _show(replace(what, seconds=left_s))
            done_ms = round(1e3 * (self._end_s - left_s - self._begin_s))
            text = POSE_TEXTS[what.pose]
            if not self._progress(min(done_ms, self._total_ms), self._total_ms, text):
                raise Cancelled("Cancelled")
            time.sleep(_POLL_S)


def _show(what: Shown) -> None:
    global shown
    shown = what
