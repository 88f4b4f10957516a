# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap record``: records sensors to a take."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from itertools import count
from pathlib import Path
from typing import Any

import click

from .. import write_take
from ..capture.client import CaptureClient, start_capture
from ..capture.config import CaptureConfig
from ..capture.errors import CaptureError, recover_command
from ..capture.recording import RecordedTake, recording_to_take
from ..capture.session import sessions
from ..files import remove_folder
from .capture_options import capture_options, config_of, remember
from .console import interrupted, status_line, warn
from .options import FilePath, check_ending

__all__ = ["attached", "record"]

FIRST_SAMPLE_TIMEOUT_S = 10.0
_POLL_S = 0.1


@click.command()
@capture_options
@click.option("-o", "--output", type=FilePath, required=True, help="The take file to write (.csv).")
@click.option("--seconds", type=click.FloatRange(0.1, 86_400), help="Stop after this time.")
@click.option(
    "--attach", is_flag=False, flag_value=0, type=click.IntRange(min=0), metavar="[PID]",
    help="Continue with a running capture (the only one, or the one with this process id).",
)  # fmt: skip
@click.option(
    "--recover", metavar="FOLDER", type=FilePath,
    help="Write the take from the folder of a capture that was killed before its take was written.",
)  # fmt: skip
def record(
    ports: tuple[str, ...],
    drivers: tuple[str, ...],
    baud: int,
    options: dict[str, str],
    sites: tuple[str, ...] | None,
    site_of: dict[str, str],
    output: Path,
    seconds: float | None,
    attach: int | None,
    recover: Path | None,
) -> None:
    """Records sensors to a take, until Ctrl-C or for a given time.

    Recording is done by a separate process, so that nothing is lost if this command is killed: the
    recording continues, and --attach connects to it again. Received data stays in the folder
    TAKE.capture, next to the take, until the take is written.
    """
    check_ending(output, ".csv")
    folder = output.with_suffix(".capture").absolute()
    if recover is not None:
        _write(output, recording_to_take(recover, None, sites or (), site_of))
        if recover.absolute() == folder:
            remove_folder(folder)
        return
    if attach is not None:
        with attached(attach) as client:
            client.set_sites(site_of)
            _save(client, output, seconds, sites, site_of)
        return
    config = config_of(ports, drivers, baud, options, sites, site_of)
    client = _started(config, folder)
    try:
        client.wait_for_samples(FIRST_SAMPLE_TIMEOUT_S, lambda message: warn([message]))
    except BaseException:
        _give_up(client, folder)
        raise
    _save(client, output, seconds, sites, site_of)


def _give_up(client: CaptureClient, folder: Path) -> None:
    """Ends a capture without samples; what arrived is kept: other options may read it."""
    has_bytes = any(link["bytes"] for link in client.status()["links"])
    client.stop()
    if not has_bytes:
        remove_folder(folder)
        return
    numbers = (folder.with_name(f"{folder.name}.{number}") for number in count(1))
    kept = next(path for path in numbers if not path.exists())
    folder.rename(kept)
    warn([f"what arrived is in {kept}"])


def _save(
    client: CaptureClient,
    output: Path,
    seconds: float | None,
    sites: tuple[str, ...] | None,
    site_of: dict[str, str],
) -> None:
    """Records and writes the take; a capture that nobody needs then ends without its folder."""
    number = _recorded(client, seconds)
    remember(client, site_of)
    _write(output, recording_to_take(client.folder, number, sites or (), site_of))
    client.tell_saved(number)
    if not client.leave():
        warn([f"capture process {client.session.pid} keeps running: other programs are attached"])


def _started(config: CaptureConfig, folder: Path) -> CaptureClient:
    if not folder.parent.is_dir():
        raise FileNotFoundError(2, "No such directory", str(folder.parent))
    running = next((s for s in sessions() if s.folder == str(folder)), None)
    if running is not None:
        raise CaptureError(f"{folder}: already recording; continue it with --attach {running.pid}")
    if folder.exists() and any(folder.iterdir()):
        raise CaptureError(
            f"{folder}: contains a recording that was not saved as a take; delete the folder, or "
            f"save it with: {recover_command(folder)}"
        )
    return start_capture(replace(config, must_record=True), folder)


def attached(pid: int) -> CaptureClient:
    """Attaches to the capture with this process id; 0: to the only one."""
    running = sessions()
    chosen = [session for session in running if pid in (0, session.pid)]
    if not chosen:
        which = f" with process id {pid}" if pid else ""
        raise CaptureError(f"there is no running capture{which}; start one with --port")
    if len(chosen) > 1:
        running_pids = ", ".join(f"{s.pid} ({' '.join(s.ports)})" for s in chosen)
        raise CaptureError(
            f"several captures are running; choose one with --attach: {running_pids}"
        )
    return CaptureClient(chosen[0])


def _recorded(client: CaptureClient, seconds: float | None) -> int:
    """Records until Ctrl-C or the end, and returns the recording's number."""
    running = client.status()["recording"]
    number = running["number"] if running and seconds is None else client.record(seconds)["number"]
    with interrupted() as stop, status_line() as show:
        _follow(client, stop, show)
    client.stop_recording()
    return int(number)


def _follow(client: CaptureClient, stop: threading.Event, show: Any) -> None:
    shown: dict[int, str] = {}
    told: set[str] = set()
    while not stop.is_set():
        status = client.status()
        recording = status["recording"]
        if recording is None:
            return
        for index, link in enumerate(status["links"]):
            message = f"{link['state']}: {link['message']}" if link["message"] else ""
            if message != shown.get(index, ""):
                shown[index] = message
                warn([message or f"{link['opened_as']}: {link['state']} again"])
        for note in status["notes"]:
            if note not in told:
                told.add(note)
                warn([note])
        missing = sum(sensor["missing"] for sensor in status["sensors"])
        show(
            f"recording {recording['seconds']:.1f} s, {len(status['sensors'])} sensors, "
            f"{recording['samples']} samples, {missing} lost (Ctrl-C to stop)"
        )
        time.sleep(_POLL_S)


def _write(output: Path, recorded: RecordedTake) -> None:
    take = recorded.take
    write_take(output, take)
    warn(recorded.warnings)
    num_samples = sum(len(record.times_s) for record in take.sensors.values())
    click.echo(
        f"{output}: {len(take.sensors)} sensors, {num_samples} samples, "
        f"{take.end_s - take.begin_s:.1f} s"
    )
