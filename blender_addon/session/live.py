# SPDX-License-Identifier: GPL-3.0-or-later
"""A live session with real sensors: a worker thread reads a capture and reconstructs poses."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass, field, replace
from queue import SimpleQueue
from typing import Any

from .core import capture as capture_module
from .core import core
from .database import Database
from .errors import InputError, one_line
from .live_poses import LivePoses, Pose, Quality
from .methods import MethodChoice

STOP_WITHIN_S = 1.0
ANSWER_WITHIN_S = 10.0
_POLL_S = 0.005
_STATUS_S = 0.25
NO_READINGS_S = 0.7
"""The panel says so within a second."""
NO_SITES = "Choose where the sensors are worn: no sensor has a sensor location"


@dataclass(frozen=True)
class LiveState:
    """What the panel shows of a session; replaced as a whole."""

    is_connected: bool = False
    error: str = ""
    """Why the session ended; one line."""
    warning: str = ""
    """Why the live preview has no poses."""
    links: tuple[dict[str, Any], ...] = ()
    """From the capture's status: state, message, counters."""
    sensors: tuple[dict[str, Any], ...] = ()
    """From the capture's status: identity, name, site, rate_hz, state, missing, battery."""
    notes: tuple[str, ...] = ()
    """What is wrong with where the sensors are worn, and what the method says; one line each."""
    shaking: str = ""
    """The site for which the sensor that is shaken is being looked for."""
    no_readings: str = ""
    """Why the live preview has had no readings for a second; empty while it has some."""
    recording: dict[str, Any] | None = None
    is_live: bool = False
    quality: Quality = field(default_factory=Quality)
    num_dropped: int = 0
    """Poses that were replaced by newer ones before they were shown."""


class LiveSession:
    """A capture client on its own thread. All methods return at once or within a second."""

    def __init__(self, connect: Callable[[], Any], label: str) -> None:
        """connect: creates the CaptureClient."""
        self.label = label
        self._connect = connect
        self._requests: SimpleQueue[tuple[Callable[[Any], Any], Future[Any]]] = SimpleQueue()
        self._stop = threading.Event()
        self._lock = threading.Lock()
        self._state = LiveState()
        self._pose: Pose | None = None
        self._is_pose_new = False
        self._wanted: tuple[Database | None, MethodChoice, Any] | None = None
        self._active: tuple[Database | None, MethodChoice, Any] | None = None
        self._refused: tuple[Database | None, MethodChoice, Any] | None = None
        self._poses: LivePoses | None = None
        self._begun_s = 0.0
        self._shaking: tuple[str, Any] | None = None
        self._sites: dict[int, str] = {}
        self._identities: dict[int, str] = {}
        self._channels: list[list[str]] = []
        self._thread = threading.Thread(target=self._run, name="Sparse Mocap: live", daemon=True)

    @property
    def state(self) -> LiveState:
        """The current state, without waiting."""
        return self._state

    @property
    def is_running(self) -> bool:
        """Whether the session is running."""
        return self._thread.is_alive()

    def start(self) -> None:
        """Start the thread; errors are in the state."""
        self._thread.start()

    def close(self) -> bool:
        """End the session; returns whether its thread ended in time. A recording continues."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join(STOP_WITHIN_S)
        return not self._thread.is_alive()

    def go_live(
        self, database: Database | None, choice: MethodChoice, calibration: Any = None
    ) -> None:
        """Start the live preview. calibration: as for LivePoses.

        database: None for methods that need none.
        """
        self._wanted = (database, choice, calibration)

    def use_calibration(self, calibration: Any) -> None:
        """Use another calibration in a running live preview."""
        if self._wanted is not None:
            self._wanted = (*self._wanted[:2], calibration)

    def leave_live(self) -> None:
        """Stop the live preview."""
        self._wanted = None

    @property
    def is_live_wanted(self) -> bool:
        """Whether the live preview is on."""
        return self._wanted is not None

    def newest_pose(self) -> Pose | None:
        """The newest pose; None when it was returned before."""
        with self._lock:
            pose, is_new = self._pose, self._is_pose_new
            self._is_pose_new = False
        return pose if is_new else None

    def record(self, seconds: float | None = None) -> Future[Any]:
        """Start recording, for this long or until stopped."""
        return self._ask(lambda client: client.record(seconds))

    def stop_recording(self) -> Future[Any]:
        """Stop recording; the result is the capture's folder and the recording's number."""

        def stop(client: Any) -> tuple[Any, int]:
            recording = client.status()["recording"]
            if recording is None:
                raise InputError("Nothing is being recorded: press Record first")
            client.stop_recording()
            return client.folder, int(recording["number"])

        return self._ask(stop)

    def set_site(self, identity: str, site: str) -> Future[Any]:
        """Say where a sensor is worn, now and whenever it is connected; an empty site: nowhere."""

        def change(client: Any) -> None:
            client.set_sites({identity: site})
            _remember({identity: site})

        return self._ask(change)

    def find_by_shaking(self, site: str) -> Future[Any]:
        """The sensor that is shaken next is the one at this site; an empty site: stop looking."""

        def change(client: Any) -> None:
            finder = capture_module().shaking.ShakeFinder() if site else None
            self._shaking = (site, finder) if site else None

        return self._ask(change)

    def tell_saved(self, number: int) -> Future[Any]:
        """Say that a recording was saved, so that the capture need not keep it."""
        return self._ask(lambda client: client.tell_saved(number))

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
            self._update(error=one_line(error))
        finally:
            if client is not None:
                self._leave(client)
            self._update(is_connected=False, is_live=False)
            while not self._requests.empty():
                self._requests.get()[1].set_exception(InputError("The sensors were disconnected"))

    def _follow(self, client: Any) -> None:
        next_status_s = 0.0
        while not self._stop.is_set():
            while not self._requests.empty():
                _answer(*self._requests.get(), client)
                next_status_s = 0.0
            if time.perf_counter() >= next_status_s:
                self._apply_status(client.status())
                next_status_s = time.perf_counter() + _STATUS_S
            samples = client.read()
            self._look_for_shaking(client, samples)
            self._advance(samples)
            self._stop.wait(_POLL_S)

    def _apply_status(self, status: dict[str, Any]) -> None:
        for link in status["links"]:
            if link["state"] == "failed":
                raise InputError(link["message"] or f"{link['port']}: cannot be used")
        used = {
            number: sensor
            for number, sensor in enumerate(status["sensors"])
            if sensor["site"] and not sensor["is_replaced"]
        }
        sites = {number: str(sensor["site"]) for number, sensor in used.items()}
        channels = [core().readings.measured_channels(sensor) for sensor in used.values()]
        is_settled = (sites, channels) == (self._sites, self._channels)
        self._sites, self._channels = sites, channels
        self._identities = {number: str(sensor["identity"]) for number, sensor in used.items()}
        wanted = self._wanted
        if not is_settled or wanted is not self._active:
            self._poses = None
        is_refused = wanted is self._refused and is_settled
        if wanted is not None and self._poses is None and sites and is_settled and not is_refused:
            self._active, self._refused = wanted, None
            self._begin_poses(*wanted)
        self._update(
            is_connected=True,
            links=tuple(status["links"]),
            sensors=tuple(s for s in status["sensors"] if not s["is_replaced"]),
            notes=(*status["notes"], *(self._poses.notes if self._poses else ())),
            shaking=self._shaking[0] if self._shaking else "",
            no_readings=self._why_no_readings(status),
            recording=status["recording"],
            is_live=self._poses is not None,
            quality=self._poses.quality() if self._poses else Quality(),
        )

    def _begin_poses(
        self, database: Database | None, choice: MethodChoice, calibration: Any
    ) -> None:
        try:
            self._poses = LivePoses(
                None if database is None else database.motions,
                self._sites,
                self._channels,
                choice,
                calibration,
                self._identities,
            )
            self._begun_s = time.perf_counter()
            self._update(warning="", num_dropped=0)
        except Exception as error:  # shown until the sensors or their locations change
            self._update(warning=one_line(error))

    def _look_for_shaking(self, client: Any, samples: Any) -> None:
        if self._shaking is None:
            return
        site, finder = self._shaking
        number = finder.push(samples)
        if number is None:
            return
        self._shaking = None
        sensors = client.status()["sensors"]
        identity = str(sensors[number]["identity"])
        # Who was there before is not: two sensors at one site are used for nothing.
        others = {str(s["identity"]): "" for s in sensors if s["site"] == site}
        sites = {**others, identity: site}
        client.set_sites(sites)
        _remember(sites)

    def _why_no_readings(self, status: dict[str, Any]) -> str:
        """One line while the live preview has had no readings for NO_READINGS_S, else nothing."""
        if self._wanted is None:
            return ""
        if self._poses is None:
            return "" if self._sites else NO_SITES
        silent_s = time.perf_counter() - max(self._poses.last_reading_s, self._begun_s)
        if silent_s < NO_READINGS_S:
            return ""
        reason = next((link["message"] for link in status["links"] if link["message"]), "")
        if reason:
            return f"No readings for {silent_s:.0f} s: {reason}"
        return f"No readings for {silent_s:.0f} s"

    def _advance(self, samples: Any) -> None:
        if self._poses is None:
            return
        try:
            pose = self._poses.advance(samples)
        except core().ConfigError as error:  # shown until something is chosen anew
            self._poses, self._refused = None, self._active
            self._update(warning=one_line(error))
            return
        if pose is None:
            return
        with self._lock:
            num_dropped = self._state.num_dropped + self._is_pose_new
            self._pose, self._is_pose_new = pose, True
        if num_dropped != self._state.num_dropped:
            self._update(num_dropped=num_dropped)

    def _leave(self, client: Any) -> None:
        """Detach; the capture ends unless it is recording or has other clients."""
        with suppress(Exception):  # it may have ended already
            client.leave()
        client.close()

    def _update(self, **changes: Any) -> None:
        """Replace the state; only called by the session's thread."""
        self._state = replace(self._state, **changes)


def answer_of(future: Future[Any], seconds: float) -> Any:
    """The answer to a request. Raises the request's error, or InputError on a timeout."""
    try:
        return future.result(seconds)
    except TimeoutError as error:
        raise InputError("The sensors do not respond: disconnect and connect again") from error


def _answer(request: Callable[[Any], Any], future: Future[Any], client: Any) -> None:
    try:
        future.set_result(request(client))
    except Exception as error:  # raised by answer_of
        future.set_exception(error)


def _remember(sites: dict[str, str]) -> None:
    with suppress(OSError):  # a read-only home keeps no settings; the session has them
        capture_module().remembered_sites.remember_sites(sites)


_current: LiveSession | None = None


def current() -> LiveSession | None:
    """The session, even if it has ended by itself."""
    return _current


def begin(session: LiveSession) -> None:
    """Start a new session. Raises InputError while the last one is running."""
    global _current
    if _current is not None and _current.is_running:
        raise InputError(f"{_current.label} is still connected: press Disconnect first")
    _current = session
    session.start()


def end() -> None:
    """End the session, if there is one. A recording continues."""
    global _current
    session, _current = _current, None
    if session is not None:
        session.close()
