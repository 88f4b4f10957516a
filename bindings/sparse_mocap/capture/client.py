# SPDX-License-Identifier: GPL-3.0-or-later
"""A client of a capture: starts it, attaches to it, reads its samples, detaches."""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

from ..files import write_text
from .config import CONFIG_NAME, DEFAULT_BAUD, CaptureConfig, LinkConfig
from .diagnosis import check_bandwidth
from .drivers import make_parser
from .errors import CaptureError, recover_command
from .runtime_folder import runtime_folder
from .sample_log import SampleLogReader, Samples
from .session import Connection, Session, read_session, session_path, sessions

__all__ = ["CaptureClient", "start_capture"]

START_TIMEOUT_S = 20.0
OTHERS_S = 4.0
"""How long links that deliver wait for those that do not; by then these have a message."""
OUTPUT_NAME = "output.log"


class CaptureClient:
    """Attached to a capture process; closing detaches, and an unused capture ends.

    Use it from one thread at a time. Samples are read from the capture's logs on disk, so a client
    that was stalled continues where it stopped.
    """

    def __init__(self, session: Session, position: int | None = None) -> None:
        """Attaches; position: the first sample to read (None: only new samples)."""
        self.session = session
        try:
            self._connection = Connection(session)
        except (OSError, ValueError) as error:
            raise CaptureError(
                f"the capture process {session.pid} has ended ({error}); start a new one"
            ) from error
        self._samples = SampleLogReader(Path(session.folder), position or 0)
        if position is None:
            self._samples.seek_end()

    @staticmethod
    def start(
        port: str,
        driver: str,
        folder: str | os.PathLike[str],
        *,
        baud: int = DEFAULT_BAUD,
        options: Mapping[str, str] | None = None,
    ) -> CaptureClient:
        """Starts a capture of one port, and attaches. Raises CaptureError."""
        return start_capture(
            CaptureConfig((LinkConfig(port, driver, baud, options or {}),)), Path(folder)
        )

    @staticmethod
    def running() -> list[Session]:
        """The running captures, oldest first."""
        return sessions()

    @property
    def folder(self) -> Path:
        """The folder of the capture's logs."""
        return Path(self.session.folder)

    def status(self) -> dict[str, Any]:
        """What the capture is doing: links, sensors, recording. Raises CaptureError."""
        return self._ask("status")

    def read(self, most: int = 100_000) -> Samples:
        """The samples since the last call, (N,) of sample_log.SAMPLE."""
        return self._samples.read(most)

    def skip(self) -> None:
        """Skips the samples received so far."""
        self._samples.seek_end()

    @property
    def position(self) -> int:
        """The number of the next sample to read."""
        return self._samples.position

    def wait_for_samples(
        self, timeout_s: float, tell: Callable[[str], None] = lambda message: None
    ) -> dict[str, Any]:
        """Waits until every link delivers samples, and returns the status.

        tell: is called with each new message of a link that does not deliver yet. It does not wait
        for long when only some links deliver: the others' messages say why. Raises CaptureError
        with the reason of a link that failed, or when none delivers after the timeout.
        """
        begin = time.perf_counter()
        told: set[str] = set()
        while True:
            status = self.status()
            links = status["links"]
            failed = [link for link in links if link["state"] == "failed"]
            waiting = [link for link in links if link["state"] != "streaming"]
            waited_s = time.perf_counter() - begin
            if not failed and len(waiting) < len(links) and waited_s > min(OTHERS_S, timeout_s):
                return status
            if failed or (waiting and waited_s > timeout_s):
                link = (failed or waiting)[0]
                reason = (
                    link["message"]
                    or f"{link['port']}: no data within {timeout_s:g} s; check sensors and driver"
                )
                raise CaptureError(reason)
            if not waiting:
                return status
            for message in {one["message"] for one in waiting} - told - {""}:
                told.add(message)
                tell(message)
            time.sleep(0.05)

    def record(self, seconds: float | None = None) -> dict[str, Any]:
        """Records for this long from now, or until stopped, even without clients.

        A running recording continues. Returns its number, seconds and samples.
        """
        return self._ask("record", seconds=seconds)

    def stop_recording(self) -> None:
        """Stops the recording."""
        self._ask("stop_recording")

    def set_sites(self, site_of: Mapping[str, str]) -> None:
        """Says where sensors are worn, by their identities; an empty site: nowhere."""
        self._ask("sites", site_of=dict(site_of))

    def tell_saved(self, number: int) -> None:
        """Says that a recording was saved as a take.

        A capture removes its folder at its end when all of its recordings were saved.
        """
        self._ask("saved", number=number)

    def leave(self) -> bool:
        """Detaches; returns whether that ended the capture, after waiting for its end.

        It continues while other clients are attached or a recording is running.
        """
        answer = self._ask("leave")
        self.close()
        if answer["ends"]:
            self._wait_for_end(is_removed=answer["is_removed"])
        return bool(answer["ends"])

    def stop(self) -> None:
        """Ends the capture, even with other clients, and waits for its end."""
        self._ask("stop")
        self.close()
        self._wait_for_end()

    def close(self) -> None:
        """Detaches."""
        self._connection.close()
        self._samples.close()

    def __enter__(self) -> CaptureClient:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()

    def _wait_for_end(self, *, is_removed: bool = False) -> None:
        """Waits until the session file is gone; is_removed: and the capture's folder."""
        end = time.perf_counter() + START_TIMEOUT_S
        waits_for = [session_path(self.session.pid), *([self.folder] if is_removed else [])]
        while any(path.exists() for path in waits_for) and time.perf_counter() < end:
            time.sleep(0.02)

    def _ask(self, request: str, **arguments: Any) -> dict[str, Any]:
        try:
            return self._connection.ask(request, **arguments)
        except (OSError, ValueError) as error:
            raise CaptureError(
                f"the capture process {self.session.pid} has ended; save what it received with: "
                f"{recover_command(self.session.folder)}"
            ) from error


def start_capture(config: CaptureConfig, folder: Path) -> CaptureClient:
    """Starts a capture process with its logs in a new or empty folder, and attaches to it.

    Raises CaptureError, ConfigError for an unknown driver or option, ImportError without pyserial,
    and OSError.
    """
    importlib.import_module("serial")
    for link in config.links:
        make_parser(link.driver, link.options)
        check_bandwidth(link)
    runtime_folder()
    folder = folder.absolute()
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    if any(folder.iterdir()):
        raise CaptureError(f"{folder}: the folder is not empty; choose another one")
    write_text(folder / CONFIG_NAME, json.dumps(config.as_json()), is_private=True)
    process = _launched(folder)
    end = time.perf_counter() + START_TIMEOUT_S
    while time.perf_counter() < end and process.poll() is None:
        session = read_session(session_path(process.pid))
        if session is not None and session.folder == str(folder):
            return CaptureClient(session, position=0)
        time.sleep(0.02)
    process.kill()
    lines = (folder / OUTPUT_NAME).read_text("utf-8", "replace").strip().splitlines()
    raise CaptureError(
        f"the capture process did not start: {lines[-1] if lines else 'no response'}"
    )


def _launched(folder: Path) -> subprocess.Popen[bytes]:
    """Starts the process detached, so that it survives the terminal and the client."""
    environment = dict(os.environ)
    here = str(Path(__file__).resolve().parents[2])
    paths = [here, *(path for path in sys.path if path)]
    environment["PYTHONPATH"] = os.pathsep.join(dict.fromkeys(paths))
    detached: dict[str, Any] = {"start_new_session": True}
    if sys.platform == "win32":
        flags = subprocess.DETACHED_PROCESS | subprocess.CREATE_NEW_PROCESS_GROUP
        detached = {"creationflags": flags}
    with open(folder / OUTPUT_NAME, "wb") as output:
        process = subprocess.Popen(
            [sys.executable, "-m", f"{__package__}", str(folder)],
            stdin=subprocess.DEVNULL, stdout=output, stderr=output,
            env=environment, **detached,
        )  # fmt: skip
    # An ended process stays a zombie until someone waits for it.
    threading.Thread(target=process.wait, daemon=True).start()
    return process
