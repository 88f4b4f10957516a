# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap live``: reconstructs poses live and shows the state in the terminal."""

from __future__ import annotations

import tempfile
import time
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.live import Live

from .. import MotionDatabase
from ..calibration_file import read_calibration
from ..capture.client import CaptureClient, start_capture
from ..capture.errors import CaptureError
from ..files import remove_folder
from .capture_options import capture_options, config_of, remember
from .console import interrupted, warn
from .live_session import LiveSession
from .live_view import view
from .options import (
    FilePath,
    OutputPath,
    body_option,
    calibration_option,
    extremities_option,
    method_choice,
    method_option,
    model_option,
    preset_option,
    set_option,
)
from .reconstruct import body_of, model_of, require_given
from .record import FIRST_SAMPLE_TIMEOUT_S, attached

__all__ = ["live"]

_POLL_S = 0.01
_REFRESH_S = 0.2
_MORE_SENSORS_S = 1.0  # how long to wait for further sensors after the first sample


@click.command()
@capture_options
@click.option("--database", "database_path", metavar="DB.smdb", type=FilePath)
@method_option
@preset_option
@set_option
@model_option
@body_option
@calibration_option
@click.option("--positions", type=OutputPath(), help="Also write the joint positions (.csv).")
@extremities_option
@click.option("--seconds", type=click.FloatRange(0.1), help="Stop after this time.")
@click.option(
    "--attach", is_flag=False, flag_value=0, type=click.IntRange(min=0), metavar="[PID]",
    help="Attach to a running capture (the only one, or the one with this process id).",
)  # fmt: skip
def live(
    ports: tuple[str, ...],
    drivers: tuple[str, ...],
    baud: int,
    options: dict[str, str],
    sites: tuple[str, ...] | None,
    site_of: dict[str, str],
    database_path: Path | None,
    method: str | None,
    preset: str | None,
    settings: tuple[tuple[str, str], ...],
    model_path: Path | None,
    body_path: Path | None,
    calibration_path: Path | None,
    positions: Path | None,
    extremities: bool,
    seconds: float | None,
    attach: int | None,
) -> None:
    """Shows sensors and how well the motion is reconstructed, until Ctrl-C.

    For each sensor: rate, loss, last value and state. For the reconstruction: how well the sensors
    match the motion database, and the delay from a movement to its pose. Nothing is recorded.
    """
    choice = method_choice(method, preset, settings)
    require_given(choice, database_path, model_path, body_path)
    database = None if database_path is None else MotionDatabase(database_path)
    calibration = None if calibration_path is None else read_calibration(calibration_path)
    with ExitStack() as stack:
        if attach is not None:
            client = stack.enter_context(attached(attach))
        else:
            config = config_of(ports, drivers, baud, options, sites, site_of)
            client = _own_capture(stack, config)
        client.set_sites(site_of)
        status = _status(client)
        remember(client, site_of)
        model, body = model_of(choice, model_path, database), body_of(body_path)
        session = LiveSession(client, status, database, choice, calibration, model, body)
        if positions is not None:
            file = stack.enter_context(positions.open("w", encoding="utf-8"))
            session.stream_to(file, extremities)
        _watch(stack, client, session, seconds)
    click.echo(session.summary())


def _own_capture(stack: ExitStack, config: Any) -> CaptureClient:
    folder = Path(tempfile.mkdtemp(prefix="sparse-mocap-live-"))
    try:
        client = start_capture(replace(config, is_temporary=True), folder)
    except BaseException:
        remove_folder(folder)
        raise
    stack.callback(_leave, client)
    return client


def _leave(client: CaptureClient) -> None:
    """Detaches from the capture; removes its folder if no other program is attached."""
    try:
        is_over = client.leave()
    except CaptureError:  # the capture was killed
        is_over = True
    if is_over:
        remove_folder(client.folder)


def _status(client: CaptureClient) -> dict[str, Any]:
    """Waits for the sensors, and returns the status; says what keeps a sensor from being used."""
    client.wait_for_samples(FIRST_SAMPLE_TIMEOUT_S, lambda message: warn([message]))
    time.sleep(_MORE_SENSORS_S)
    client.skip()
    status = client.status()
    warn([link["message"] for link in status["links"] if link["message"]])
    unnamed = [str(sensor["identity"]) for sensor in status["sensors"] if not sensor["site"]]
    if status["notes"]:
        warn(status["notes"])
    elif unnamed:
        warn([
            f"no sensor location is known for {', '.join(unnamed)}; give it with "
            f"--site '{unnamed[0]}=left_wrist'"
        ])  # fmt: skip
    return status


def _watch(
    stack: ExitStack, client: CaptureClient, session: LiveSession, seconds: float | None
) -> None:
    console = Console(stderr=True, highlight=False)
    screen = stack.enter_context(Live(console=console, auto_refresh=False, transient=True))
    stop = stack.enter_context(interrupted())
    begin = time.perf_counter()
    next_refresh = begin
    while not stop.is_set() and (seconds is None or time.perf_counter() - begin < seconds):
        session.advance()
        now = time.perf_counter()
        if now >= next_refresh and console.is_terminal:
            screen.update(view(client.status(), session), refresh=True)
            next_refresh = now + _REFRESH_S
        time.sleep(_POLL_S)
