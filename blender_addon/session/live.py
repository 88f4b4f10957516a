# SPDX-License-Identifier: GPL-3.0-or-later
"""Attached to the real sensors: a worker thread that follows a capture and makes poses of it."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass, field, replace
from queue import SimpleQueue
from typing import Any

from .database import Database
from .errors import InputError, one_line
from .live_poses import LivePoses, Pose, Quality

STOP_WITHIN_S = 1.0
ANSWER_WITHIN_S = 10.0
_NAP_S = 0.005
_STATUS_S = 0.25


@dataclass(frozen=True)
class LiveState:
    """All that the panel shows of a session; a new one now and then."""

    is_connected: bool = False
    error: str = ""
    """Why the session ended; one line."""
    warning: str = ""
    """Why there are no poses though live is on."""
    links: tuple[dict[str, Any], ...] = ()
    """As the capture's status has them: state, message, counters."""
    sensors: tuple[dict[str, Any], ...] = ()
    """As the capture's status has them: name, site, rate_hz, state, missing."""
    recording: dict[str, Any] | None = None
    is_live: bool = False
    quality: Quality = field(default_factory=Quality)
    num_dropped: int = 0
    """Poses that were made and never shown, since newer ones came first."""


class LiveSession:
    """A capture's client on a thread of its own. All methods return at once or within a second."""

    def __init__(self, connect: Callable[[], Any], label: str) -> None:
        """connect: makes the CaptureClient."""
        self.label = label
        self._connect = connect
        self._requests: SimpleQueue[tuple[Callable[[Any], Any], Future[Any]]] = SimpleQueue()
        self._stop = threading.Event()
        self._lock = threading.Lock()
        self._state = LiveState()
        self._pose: Pose | None = None
        self._is_pose_new = False
        self._wanted: tuple[Database, str, Any] | None = None
        self._made_for: tuple[Database, str, Any] | None = None
        self._poses: LivePoses | None = None
        self._worn: dict[int, str] = {}
        self._with_gyroscope: frozenset[int] = frozenset()
        self._thread = threading.Thread(target=self._run, name="Sparse Mocap: live", daemon=True)

    @property
    def state(self) -> LiveState:
        """How things are, at once."""
        return self._state

    @property
    def is_running(self) -> bool:
        """Whether the session goes on."""
        return self._thread.is_alive()

    def start(self) -> None:
        """Begin; what goes wrong is in the state."""
        self._thread.start()

    def close(self) -> bool:
        """End the session and return whether its thread ended in time; a recording goes on."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join(STOP_WITHIN_S)
        return not self._thread.is_alive()

    def go_live(self, database: Database, preset: str, calibration: Any = None) -> None:
        """Make poses from now on. calibration: as LivePoses takes it."""
        self._wanted = (database, preset, calibration)

    def use_calibration(self, calibration: Any) -> None:
        """Make poses with another calibration, if poses are being made."""
        if self._wanted is not None:
            self._wanted = (*self._wanted[:2], calibration)

    def leave_live(self) -> None:
        """Make no more poses."""
        self._wanted = None

    @property
    def is_live_wanted(self) -> bool:
        """Whether poses are to be made."""
        return self._wanted is not None

    def newest_pose(self) -> Pose | None:
        """The newest pose, None when it was asked for already."""
        with self._lock:
            pose, is_new = self._pose, self._is_pose_new
            self._is_pose_new = False
        return pose if is_new else None

    def record(self, seconds: float | None = None) -> Future[Any]:
        """Begin to record, for so long or until it is stopped."""
        return self._ask(lambda client: client.record(seconds))

    def stop_recording(self) -> Future[Any]:
        """End the recording; the result is the capture's folder and the recording's number."""

        def stop(client: Any) -> tuple[Any, int]:
            recording = client.status()["recording"]
            if recording is None:
                raise InputError("Nothing is being recorded: press Record first")
            client.stop_recording()
            return client.folder, int(recording["number"])

        return self._ask(stop)

    def _ask(self, request: Callable[[Any], Any]) -> Future[Any]:
        future: Future[Any] = Future()
        if not self._state.is_connected or not self.is_running:
            future.set_exception(InputError("No sensors are connected: press Connect first"))
        else:
            self._requests.put((request, future))
        return future

    def _run(self) -> None:
        client = None
        try:
            client = self._connect()
            self._follow(client)
        except Exception as error:  # shown in the panel
            self._tell(error=one_line_of(error))
        finally:
            if client is not None:
                self._let_go(client)
            self._tell(is_connected=False, is_live=False)
            while not self._requests.empty():
                self._requests.get()[1].set_exception(InputError("The sensors were disconnected"))

    def _follow(self, client: Any) -> None:
        next_status_s = 0.0
        while not self._stop.is_set():
            while not self._requests.empty():
                _answer(*self._requests.get(), client)
                next_status_s = 0.0
            if time.monotonic() >= next_status_s:
                self._take_up(client.status())
                next_status_s = time.monotonic() + _STATUS_S
            self._advance(client.read())
            self._stop.wait(_NAP_S)

    def _take_up(self, status: dict[str, Any]) -> None:
        for link in status["links"]:
            if link["state"] == "failed":
                raise InputError(link["message"] or f"{link['port']}: failed")
        worn = {i: sensor["site"] for i, sensor in enumerate(status["sensors"])}
        turned = frozenset(
            i for i, sensor in enumerate(status["sensors"]) if sensor["has_gyroscope"]
        )
        is_settled = (worn, turned) == (self._worn, self._with_gyroscope)
        self._worn, self._with_gyroscope = worn, turned
        wanted = self._wanted
        if not is_settled or wanted is not self._made_for:
            self._poses = None
        if wanted is not None and self._poses is None and worn and is_settled:
            self._made_for = wanted
            self._begin_poses(*wanted)
        self._tell(
            is_connected=True,
            links=tuple(status["links"]),
            sensors=tuple(status["sensors"]),
            recording=status["recording"],
            is_live=self._poses is not None,
            quality=self._poses.quality() if self._poses else Quality(),
        )

    def _begin_poses(self, database: Database, preset: str, calibration: Any) -> None:
        try:
            self._poses = LivePoses(
                database.motions, self._worn, preset, calibration, self._with_gyroscope
            )
            self._tell(warning="", num_dropped=0)
        except Exception as error:  # sensors may get places, or others may come
            self._tell(warning=one_line_of(error))

    def _advance(self, samples: Any) -> None:
        if self._poses is None:
            return
        pose = self._poses.advance(samples)
        if pose is None:
            return
        with self._lock:
            num_dropped = self._state.num_dropped + self._is_pose_new
            self._pose, self._is_pose_new = pose, True
        if num_dropped != self._state.num_dropped:
            self._tell(num_dropped=num_dropped)

    def _let_go(self, client: Any) -> None:
        """The capture ends, unless it records or others are attached to it."""
        with suppress(Exception):  # it may be gone already
            client.leave()
        client.close()

    def _tell(self, **changes: Any) -> None:
        """Only ever called by the session's thread."""
        self._state = replace(self._state, **changes)


def answer_of(future: Future[Any], seconds: float) -> Any:
    """The answer to a request. Raises what went wrong, InputError when there is none in time."""
    try:
        return future.result(seconds)
    except TimeoutError as error:
        raise InputError("The capture does not answer: disconnect and attach again") from error


def _answer(request: Callable[[Any], Any], future: Future[Any], client: Any) -> None:
    try:
        future.set_result(request(client))
    except Exception as error:  # for whoever waits for the answer
        future.set_exception(error)


def one_line_of(error: BaseException) -> str:
    """As one_line; a capture's errors are written for the user already."""
    if type(error).__module__.endswith("capture.errors"):
        return " ".join(str(error).split())
    return one_line(error)


_current: LiveSession | None = None


def current() -> LiveSession | None:
    """The session, also one that ended by itself."""
    return _current


def begin(session: LiveSession) -> None:
    """Start the session in the place of another. Raises InputError while that goes on."""
    global _current
    if _current is not None and _current.is_running:
        raise InputError(f"{_current.label} is connected: press Disconnect first")
    _current = session
    session.start()


def end() -> None:
    """End the session, if there is one; a recording goes on without it."""
    global _current
    session, _current = _current, None
    if session is not None:
        session.close()
