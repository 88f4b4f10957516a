# SPDX-License-Identifier: GPL-3.0-or-later
"""Real sensors as the animator uses them: connected to, recorded, kept as a take."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .calibrating import calibration_at
from .core import capture, core
from .database import databases
from .errors import InputError, one_line
from .job import Job, Progress
from .live import ANSWER_WITHIN_S, LiveSession, answer_of, one_line_of
from .new_files import free_path, stamp
from .reconstruct import Performance, reconstruct
from .take import takes

GOING_LIVE, STOPPING = "Going live", "Keeping the take"
LINGER_S = 2.0


@dataclass(frozen=True)
class Port:
    """A port and what is spoken there."""

    port: str
    driver: str
    baud: int = 115200
    options: str = ""
    """The driver's, as in "rate_hz=100, output=mtdata"."""
    sites: str = ""
    """Where the sensors are worn, separated by commas; empty: by their names."""


@dataclass(frozen=True)
class Kept:
    """A recording that was kept as a take file."""

    path: str
    warnings: tuple[str, ...]
    performance: Performance | None
    reason: str = ""
    """Why there is no performance."""


last_takes: list[str] = []
"""The file of the take that was kept last, if there is one."""


def connecting(port: Port, folder: Path) -> LiveSession:
    """A session, to be begun, that starts a capture with its logs in that folder of takes.

    Raises InputError, or what the driver has to say of its options.
    """
    module = capture()
    if not port.port:
        raise InputError("Choose the port of the sensors first")
    sites = tuple(_words(port.sites))
    for site in sites:
        if site not in core().site_names():
            raise InputError(f'"{site}" is no place of a sensor: {", ".join(core().site_names())}')
    options = _options(port.options)
    module.drivers.make_parser(port.driver, options)
    config = module.CaptureConfig(
        (module.LinkConfig(port.port, port.driver, port.baud, options),),
        sites=sites,
        linger_s=LINGER_S,
        is_temporary=True,
    )
    logs = folder / f"capture-{stamp()}"

    def connect() -> Any:
        return module.start_capture(config, free_path(logs))

    return LiveSession(connect, port.port)


def attaching(session: Any) -> LiveSession:
    """A session, to be begun, with a capture (capture.session.Session) that goes on already."""
    module = capture()
    label = ", ".join(session.ports) or f"process {session.pid}"
    return LiveSession(lambda: module.CaptureClient(session), label)


def going_live_job(database_path: str, calibration_path: str) -> Job:
    """The job that opens the database; its result is that, and the calibration if there is one."""
    core()
    calibration = calibration_at(calibration_path)
    return Job(GOING_LIVE, lambda progress: (databases.get(database_path), calibration))


def stopping_job(
    session: LiveSession, database_path: str, calibration_path: str, folder: Path, preset: str
) -> Job:
    """The job that ends the recording, keeps it as a take and reconstructs it; gives a Kept."""
    module = capture()

    def work(progress: Progress) -> Kept:
        logs, number = answer_of(session.stop_recording(), ANSWER_WITHIN_S)
        path, warnings = _keep(module, logs, number, folder)
        last_takes[:] = [path]
        if not database_path:
            return Kept(path, warnings, None, "no motion database is chosen")
        try:
            performance = reconstruct(
                databases.get(database_path),
                takes.get(path),
                calibration=calibration_at(calibration_path),
                preset=preset,
                offline=False,
                progress=progress,
            )
        except Exception as error:  # the take is kept all the same
            return Kept(path, warnings, None, one_line(error))
        return Kept(path, warnings, performance)

    return Job(STOPPING, work)


def _keep(module: Any, logs: Path, number: int, folder: Path) -> tuple[str, tuple[str, ...]]:
    try:
        recorded = module.recording_to_take(logs, number)
    except module.CaptureError as error:
        raise InputError(f"{one_line_of(error)}; what came is in {logs}") from error
    folder.mkdir(parents=True, exist_ok=True)
    path = free_path(folder / f"take-{stamp()}.csv")
    core().write_take(path, recorded.take)
    return str(path), tuple(recorded.warnings)


def _options(text: str) -> dict[str, str]:
    options = {}
    for word in _words(text):
        name, equals, value = word.partition("=")
        if not equals:
            raise InputError(f'"{word}" is no option: write name=value, separated by commas')
        options[name.strip()] = value.strip()
    return options


def _words(text: str) -> list[str]:
    return [word.strip() for word in text.split(",") if word.strip()]
