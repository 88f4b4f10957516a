# SPDX-License-Identifier: GPL-3.0-or-later
"""Other users of the machine, and programs that only seem to be clients: none of them can end,
read, orphan or delay a recording."""

from __future__ import annotations

import json
import os
import shutil
import socket
import stat
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import closing, suppress
from pathlib import Path

import pytest
from capture_support import DRIVER, OPTIONS, SITES, Play, some_take, stop_captures, until
from sparse_mocap import write_take
from sparse_mocap.capture import (
    CaptureClient,
    CaptureConfig,
    CaptureError,
    LinkConfig,
    recording_to_take,
    start_capture,
)
from sparse_mocap.capture.channel import connected
from sparse_mocap.capture.server import GREETING_TIMEOUT_S, MOST_STRANGERS
from sparse_mocap.capture.session import (
    FOLDER_VARIABLE,
    Session,
    runtime_folder,
    session_path,
    sessions,
)

SECONDS = 6.0
NOBODY = 65534
LONG = "x" * 100
"""In a path, it makes it too long for a Unix socket, so that the channel is a loopback port."""

STRANGER = Path(__file__).with_name("stranger.py").read_text(encoding="utf-8")
"""Passed as text, because another user may not be able to enter this folder."""


posix = pytest.mark.skipif(sys.platform == "win32", reason="users and permissions of POSIX")


def needs_root() -> None:
    if os.getuid() != 0:
        pytest.skip("only root can become another user")


@pytest.fixture
def open_folder() -> Iterator[Path]:
    """A folder that every user can enter, unlike pytest's own."""
    folder = Path(tempfile.mkdtemp(prefix="sparse-mocap-users-"))
    folder.chmod(0o755)
    yield folder
    stop_captures()
    shutil.rmtree(folder)


def config_for(port: str, **how: object) -> CaptureConfig:
    return CaptureConfig((LinkConfig(port, DRIVER, options=OPTIONS),), SITES, **how)  # type: ignore[arg-type]


@posix
@pytest.mark.parametrize("channel", ["unix", "tcp"])
def test_another_user_can_do_nothing_to_a_recording(
    channel: str, play: Play, open_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    needs_root()
    runtime = open_folder / (LONG if channel == "tcp" else "run")
    monkeypatch.setenv(FOLDER_VARIABLE, str(runtime))
    emulator = play(some_take(SECONDS))
    config = config_for(emulator.lines[0].path, must_record=True)
    with start_capture(config, open_folder / "c") as client:
        session = client.session
        assert session.address.startswith(channel)
        client.wait_for_samples(10.0)
        take_path = open_folder / "take.csv"
        write_take(take_path, some_take(0.1))
        private = [
            *map(str, (open_folder / "c").iterdir()), str(open_folder / "c"), str(take_path),
            str(runtime), *map(str, runtime.iterdir()),
        ]  # fmt: skip
        python = os.path.realpath(sys.executable)  # a virtual environment may be private
        stranger = subprocess.Popen(
            [python, "-c", STRANGER, session.address, str(session.pid), *private],
            user=NOBODY, group=NOBODY, extra_groups=[], stdout=subprocess.PIPE, cwd="/",
        )  # fmt: skip
        try:
            assert stranger.stdout is not None
            done = json.loads(stranger.stdout.readline())
            assert (done["connected"] > 0) == (channel == "tcp")
            assert (done["read"], done["written"], done["listed"]) == ([], [], [])
            assert (done["answers"], done["killed"]) == (0, False)
            # With the crowd still connected, a client of the user is served at once.
            begin = time.perf_counter()
            assert sessions() == [session]
            with CaptureClient(session) as other:
                assert other.status()["recording"] is not None
            assert time.perf_counter() - begin < 1.5
        finally:
            stranger.kill()
            stranger.wait()
            assert stranger.stdout is not None
            stranger.stdout.close()
        until(lambda: client.status()["samples"] == round(SECONDS * 100) * 3)
        client.stop()
    recorded = recording_to_take(open_folder / "c")
    assert (recorded.gaps, recorded.num_missing) == ((), 0)


@posix
def test_a_folder_that_another_user_made_first_is_not_used(
    open_folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    needs_root()
    runtime = open_folder / "run"
    runtime.mkdir()
    os.chown(runtime, NOBODY, NOBODY)
    monkeypatch.setenv(FOLDER_VARIABLE, str(runtime))
    with pytest.raises(CaptureError, match="not a folder of this user"):
        sessions()
    with pytest.raises(CaptureError, match="not a folder of this user"):
        CaptureClient.start("loop://", DRIVER, open_folder / "c", options=OPTIONS)
    assert not (open_folder / "c").exists()


@posix
def test_a_link_in_place_of_the_folder_is_not_used(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "run").symlink_to(tmp_path / "elsewhere")
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "run"))
    with pytest.raises(CaptureError, match="not a folder of this user"):
        runtime_folder()


@posix
def test_the_usual_folder_is_where_nobody_else_can_be_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(FOLDER_VARIABLE)
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path / "missing"))
    folder = runtime_folder()
    assert tmp_path in folder.parents
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    folder.chmod(0o755)
    assert stat.S_IMODE(runtime_folder().stat().st_mode) == 0o700


@posix
def test_a_session_file_of_another_user_is_ignored(runtime: Path) -> None:
    needs_root()
    path = runtime / "capture-1.json"
    path.write_text(json.dumps(Session(1, "tcp:1", "x", "/", 1.0).__dict__))
    os.chown(path, NOBODY, NOBODY)
    assert sessions() == []


def test_session_files_of_captures_that_were_killed_are_removed(runtime: Path) -> None:
    whole = json.dumps(Session(3, "tcp:1", "x", "/", 1.0).__dict__)
    for pid, text in ((1, ""), (2, "{}"), (3, whole), (4, "[" * 100_000)):
        (runtime / f"capture-{pid}.json").write_text(text)
        (runtime / f"capture-{pid}.sock").write_text("")
        os.utime(runtime / f"capture-{pid}.json", (1.0, 1.0))
    assert sessions() == []
    assert list(runtime.iterdir()) == []


@posix
def test_what_is_received_and_recorded_is_the_users_alone(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(5.0))
    (tmp_path / "c").mkdir(mode=0o755)
    with start_capture(config_for(emulator.lines[0].path, must_record=True), tmp_path / "c") as c:
        c.wait_for_samples(10.0)
        assert stat.S_IMODE(session_path(c.session.pid).stat().st_mode) == 0o600
        c.stop()
    write_take(tmp_path / "take.csv", recording_to_take(tmp_path / "c").take)
    files = [path for path in (tmp_path / "c").iterdir() if path.name != "output.log"]
    assert {path.name for path in files} >= {"raw.log", "samples.bin", "config.json"}
    for path in [*files, tmp_path / "take.csv"]:
        assert stat.S_IMODE(path.stat().st_mode) == 0o600, path.name


@pytest.fixture(params=["unix", "tcp"])
def recorded(
    request: pytest.FixtureRequest, play: Play, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[CaptureClient]:
    """A client of a capture that records, with each kind of channel."""
    if request.param == "unix" and sys.platform == "win32":
        pytest.skip("Windows' Python knows no Unix sockets")
    if request.param == "tcp":
        monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / LONG))
    emulator = play(some_take(20.0))
    config = config_for(emulator.lines[0].path, must_record=True)
    with start_capture(config, tmp_path / "c") as client:
        client.wait_for_samples(10.0)
        yield client
        with suppress(CaptureError):
            client.stop()


@pytest.mark.parametrize(
    "greeting",
    [
        b'{"do": "stop"}', b"\xff\xfe", "é".encode(), b"[" * 60_000, b"GET / HTTP/1.1", b"",
        b"0" * 32,
    ],
)  # fmt: skip
def test_nobody_attaches_without_the_token(recorded: CaptureClient, greeting: bytes) -> None:
    with closing(connected(recorded.session.address, 5.0)) as stranger:
        with suppress(OSError):  # it may hang up while this is sent
            stranger.sendall(greeting + b'\n{"do": "stop"}\n')
        with suppress(ConnectionResetError):
            assert stranger.recv(100) == b""
    assert recorded.status()["recording"] is not None


@pytest.mark.parametrize(
    "request_line",
    [
        b"[" * 60_000, b'{"do":' * 9000, b'{"do": "\\ud800"}', b"[1]", b'"do"', b"{}", b"\xff",
        b'{"do": "record", "seconds": "soon"}', b'{"do": "record", "seconds": 1e400}',
        b'{"do": "status"' + b" " * 70_000,
    ],
)  # fmt: skip
def test_a_client_with_an_odd_request_ends_alone(
    recorded: CaptureClient, request_line: bytes
) -> None:
    with closing(connected(recorded.session.address, 5.0)) as odd:
        odd.sendall(recorded.session.token.encode() + b"\n")
        assert json.loads(odd.recv(1000))["pid"] == recorded.session.pid
        with suppress(OSError):
            odd.sendall(request_line + b"\n")
        with suppress(ConnectionResetError):
            assert b"samples" not in odd.recv(1000)
    assert recorded.status()["recording"] is not None


def test_strangers_are_dropped_and_lock_nobody_out(recorded: CaptureClient) -> None:
    crowd = [connected(recorded.session.address, 5.0) for _ in range(MOST_STRANGERS + 40)]
    try:
        assert sessions() == [recorded.session]
        with CaptureClient(recorded.session) as other:
            assert other.status()["recording"] is not None
        for stranger in crowd:
            stranger.settimeout(GREETING_TIMEOUT_S + 3.0)
            with suppress(ConnectionResetError):
                assert stranger.recv(1) == b""
    finally:
        for stranger in crowd:
            stranger.close()
    assert sessions() == [recorded.session]


def test_a_refused_request_is_told(recorded: CaptureClient) -> None:
    with pytest.raises(CaptureError, match="unknown request"):
        recorded._ask("dance")


def test_no_connection_waits_for_an_impostor(runtime: Path) -> None:
    """After a capture was killed, another program may listen on its port; it gets no token."""
    with closing(socket.create_server(("127.0.0.1", 0))) as impostor:
        port = impostor.getsockname()[1]
        path = runtime / "capture-77.json"
        path.write_text(json.dumps(Session(77, f"tcp:{port}", "secret", "/", 1.0).__dict__))
        assert sessions() == []
        impostor.settimeout(0.1)
        with pytest.raises(TimeoutError):
            impostor.accept()
