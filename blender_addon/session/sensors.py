# SPDX-License-Identifier: GPL-3.0-or-later
"""Real sensors as the animator uses them: connect, record, save as a take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .bake import PlacedTake, Placement, placed
from .calibrating import calibration_at
from .core import capture, core
from .database import Database, databases
from .errors import InputError, one_line
from .job import Cancelled, Job, Progress
from .live import ANSWER_WITHIN_S, LiveSession, answer_of
from .methods import MethodChoice, has_best_quality, missing_file, needs_database
from .new_files import free_path, stamp
from .reconstruct import reconstruct
from .take import takes
from .training import skeleton_of

STARTING_LIVE, SAVING_TAKE = "Starting the live preview", "Saving the take"
LINGER_S = 2.0


@dataclass(frozen=True)
class Port:
    """A port and the protocol of the sensors connected to it."""

    port: str
    driver: str
    baud: int = 115200
    options: str = ""
    """Of the driver, as in "rate_hz=100, output=mtdata"."""
    sites: str = ""
    """Sensor locations, separated by commas; empty: by the sensors' names."""


@dataclass(frozen=True)
class SavedTake:
    """A recording that was saved as a take file."""

    path: str
    warnings: tuple[str, ...]
    placed: PlacedTake | None
    """The take on the characters, in best quality where the method has it."""
    reason: str = ""
    """Why there is none."""


last_takes: list[str] = []
"""The file of the take that was saved last, if there is one."""


def new_session(port: Port, folder: Path, more: Sequence[Port] = ()) -> LiveSession:
    """A session, not started yet, that starts a capture with its logs in that folder of takes.

    more: further ports. Raises InputError, or ConfigError for wrong options of a driver.
    """
    module = capture()
    ports = (port, *more)
    if not all(one.port for one in ports):
        raise InputError("Choose the port of the sensors first")
    names = [one.port for one in ports]
    if twice := next((name for name in names if names.count(name) > 1), ""):
        raise InputError(f"{twice} is in the list twice: remove one")
    sites = tuple(_words(port.sites))
    for site in sites:
        if site not in core().site_names():
            known = ", ".join(core().site_names())
            raise InputError(f'Unknown sensor location "{site}": choose from {known}')
    config = module.CaptureConfig(
        tuple(_link(module, one) for one in ports),
        sites=sites,
        site_of=module.remembered_sites.remembered_sites(),
        linger_s=LINGER_S,
        is_temporary=True,
    )
    logs = folder / f"capture-{stamp()}"

    def connect() -> Any:
        return module.start_capture(config, free_path(logs))

    return LiveSession(connect, ", ".join(names))


def attach_session(session: Any) -> LiveSession:
    """A session, not started yet, with a running capture (capture.session.Session)."""
    module = capture()
    label = ", ".join(session.ports) or f"process {session.pid}"
    return LiveSession(lambda: module.CaptureClient(session), label)


@dataclass(frozen=True)
class LivePreview:
    """What a live preview needs."""

    database: Database | None
    """None for methods that need none."""
    calibration: Any
    skeleton: Any
    """Of the poses, with feet, toes and hands."""


def live_preview_job(database_path: str, calibration_path: str, choice: MethodChoice) -> Job:
    """The job that opens the database and the model; its result is a LivePreview."""
    core()
    calibration = calibration_at(calibration_path)

    def work(progress: Progress) -> LivePreview:
        database = None
        if needs_database(choice.method):
            database = databases.get(database_path)
            skeleton = core().with_extremities(database.motions.skeleton)
        else:
            skeleton = skeleton_of(choice)
        if not progress(1, 1, ""):
            raise Cancelled("Cancelled")
        return LivePreview(database, calibration, skeleton)

    return Job(STARTING_LIVE, work)


def save_take_job(
    session: LiveSession,
    database_path: str,
    calibration_path: str,
    folder: Path,
    choice: MethodChoice,
    placement: Placement,
) -> Job:
    """The job that stops the recording, saves and reconstructs it; its result is a SavedTake."""
    module = capture()

    def work(progress: Progress) -> SavedTake:
        logs, number = answer_of(session.stop_recording(), ANSWER_WITHIN_S)
        path, warnings = _save(module, logs, number, folder)
        session.tell_saved(number)
        last_takes[:] = [path]
        missing = missing_file(choice.method, database_path, choice.model)
        if missing:
            return SavedTake(path, warnings, None, missing[:1].lower() + missing[1:])
        try:
            performance = reconstruct(
                databases.get(database_path) if needs_database(choice.method) else None,
                takes.get(path),
                calibration=calibration_at(calibration_path),
                choice=choice,
                best_quality=has_best_quality(choice.method),
                progress=progress,
            )
            return SavedTake(path, warnings, placed(performance, placement, progress))
        except (Cancelled, core().Cancelled):
            return SavedTake(path, warnings, None, "cancelled")
        except Exception as error:  # the take is saved all the same
            return SavedTake(path, warnings, None, one_line(error))

    return Job(SAVING_TAKE, work)


def _save(module: Any, logs: Path, number: int, folder: Path) -> tuple[str, tuple[str, ...]]:
    try:
        recorded = module.recording_to_take(logs, number)
        folder.mkdir(parents=True, exist_ok=True)
        path = free_path(folder / f"take-{stamp()}.csv")
        core().write_take(path, recorded.take)
    except (module.CaptureError, OSError) as error:  # a full disk, for one
        reason = one_line(error).removeprefix(f"{logs}: ")
        raise InputError(f"{reason}; what was received is in {logs}") from error
    return str(path), tuple(recorded.warnings)


def _link(module: Any, port: Port) -> Any:
    options = _options(port.options)
    module.drivers.make_parser(port.driver, options)
    link = module.LinkConfig(port.port, port.driver, port.baud, options)
    module.diagnosis.check_bandwidth(link)
    return link


def _options(text: str) -> dict[str, str]:
    """From "rate_hz=100, columns=time,ax,ay,az": a word without "=" belongs to the list before."""
    options: dict[str, str] = {}
    name = ""
    for word in _words(text):
        first, equals, value = word.partition("=")
        if equals:
            name = first.strip()
            options[name] = value.strip()
        elif name:
            options[name] += f",{word}"
        else:
            raise InputError(f'Option "{word}": write name=value, separated by commas')
    return options


def _words(text: str) -> list[str]:
    return [word.strip() for word in text.split(",") if word.strip()]
