# SPDX-License-Identifier: GPL-3.0-or-later
"""``ports``, ``emulate``, ``record`` and ``live``, as processes that talk over pseudo-terminals."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from capture_support import DRIVER, some_take, until
from click.testing import Result
from processes import kill
from sparse_mocap import Take, read_positions, read_take, write_take
from sparse_mocap.capture.errors import recover_command
from sparse_mocap.capture.ports import PortInfo
from sparse_mocap.capture.session import sessions

Cli = Callable[..., Result]
Command = Callable[..., subprocess.CompletedProcess[str]]
Start = Callable[..., "subprocess.Popen[str]"]


@pytest.fixture
def start() -> Iterator[Start]:
    """Starts commands that go on; what still runs at the end is ended."""
    started: list[subprocess.Popen[str]] = []

    def call(*arguments: object) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            [sys.executable, "-m", "sparse_mocap", *map(str, arguments)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL, text=True,
        )  # fmt: skip
        started.append(process)
        return process

    yield call
    for process in started:
        if process.poll() is None:
            process.kill()
        process.communicate()


def first_line(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    return process.stdout.readline().strip()


def has_socket(pid: int) -> bool:
    """Whether the process has connected to something."""
    files = [path for path in Path(f"/proc/{pid}/fd").iterdir() if path.is_symlink()]
    return any(str(path.readlink()).startswith("socket:") for path in files)


@pytest.fixture
def played(tmp_path: Path) -> tuple[Take, Path]:
    take, path = some_take(3.0), tmp_path / "played.csv"
    write_take(path, take)
    return take, path


def check_same(recorded: Take, played: Take, tolerance: float = 1e-3) -> None:
    assert recorded.sites == played.sites
    for own, sent in zip(recorded.sensors.values(), played.sensors.values(), strict=True):
        assert own.specific_force == pytest.approx(sent.specific_force, abs=tolerance)
        assert own.times_s == pytest.approx(sent.times_s, abs=2e-3)


def test_ports_are_listed_with_their_devices(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    port = PortInfo("/dev/ttyACM0", "", 0x2639, 0x0300, "DB0001", "Xsens", "MTi-300", "1-2")
    monkeypatch.setattr("sparse_mocap.cli.ports.available_ports", lambda: [port])
    table = cli("ports")
    assert table.exit_code == 0
    for text in ("/dev/ttyACM0", "Xsens MTi-300", "2639:0300", "DB0001"):
        assert text in table.output
    (told,) = json.loads(cli("ports", "--json").output)
    assert told["port"] == "/dev/ttyACM0"
    assert (told["vendor_id"], told["product_id"]) == (0x2639, 0x0300)
    assert (told["serial_number"], told["manufacturer"]) == ("DB0001", "Xsens")


def test_no_port_is_no_fault(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sparse_mocap.cli.ports.available_ports", list)
    assert "plug a device in" in cli("ports").output
    assert json.loads(cli("ports", "--json").output) == []


def test_what_is_emulated_is_recorded(
    start: Start, command: Command, played: tuple[Take, Path], tmp_path: Path
) -> None:
    take, path = played
    port = first_line(start("emulate", path, "--driver", DRIVER))
    done = command("record", "--port", port, "--driver", DRIVER, "-o", tmp_path / "own.csv",
                   "--seconds", 2.9, "--sites", ",".join(take.sites))  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(f"{tmp_path / 'own.csv'}: 3 sensors, 900 samples")
    recorded = read_take(tmp_path / "own.csv")
    check_same(recorded, take)
    assert recorded.sensors["left_wrist"].orientation is not None
    assert not (tmp_path / "own.capture").exists()
    assert sessions() == []


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal of POSIX")
def test_ctrl_c_ends_a_recording_well(
    start: Start, played: tuple[Take, Path], tmp_path: Path
) -> None:
    port = first_line(start("emulate", played[1], "--driver", DRIVER))
    sites = "left_ankle,right_ankle,head"
    process = start("record", "--port", port, "--driver", DRIVER, "-o", tmp_path / "own.csv",
                    "--sites", sites)  # fmt: skip
    until(lambda: sessions() and (tmp_path / "own.capture" / "samples.bin").stat().st_size > 20_000)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=20)
    assert (process.returncode, err) == (0, "")
    assert "3 sensors" in out
    assert read_take(tmp_path / "own.csv").sites == sites.split(",")
    assert sessions() == []


@pytest.mark.skipif(sys.platform == "win32", reason="sends a signal of POSIX")
def test_a_recording_whose_command_was_killed_is_taken_up_again(
    start: Start, command: Command, played: tuple[Take, Path], tmp_path: Path
) -> None:
    take, path = played
    port = first_line(start("emulate", path, "--driver", DRIVER))
    arguments = ("record", "--port", port, "--driver", DRIVER, "-o", tmp_path / "own.csv",
                 "--sites", ",".join(take.sites))  # fmt: skip
    process = start(*arguments)
    until(lambda: sessions() and (tmp_path / "own.capture" / "samples.bin").stat().st_size > 20_000)
    process.kill()
    process.communicate()
    again = command(*arguments)
    (session,) = sessions()
    assert again.returncode == 1
    assert f"already recording; continue it with --attach {session.pid}" in again.stderr
    time.sleep(3.0)
    attached = start("record", "--attach", "-o", tmp_path / "other name.csv")
    until(lambda: has_socket(attached.pid))
    time.sleep(1.0)
    attached.send_signal(signal.SIGINT)
    _, err = attached.communicate(timeout=20)
    assert attached.returncode == 0, err
    check_same(read_take(tmp_path / "other name.csv"), take)
    assert sessions() == []
    assert not (tmp_path / "own.capture").exists()


def test_what_a_killed_capture_left_is_recovered(
    start: Start, command: Command, played: tuple[Take, Path], tmp_path: Path
) -> None:
    take, path = played
    port = first_line(start("emulate", path, "--driver", DRIVER))
    arguments = ("record", "--port", port, "--driver", DRIVER, "-o", tmp_path / "own.csv",
                 "--sites", ",".join(take.sites))  # fmt: skip
    process = start(*arguments)
    until(lambda: sessions() and (tmp_path / "own.capture" / "samples.bin").stat().st_size > 20_000)
    kill(sessions()[0].pid)
    _, err = process.communicate(timeout=20)
    assert process.returncode == 1
    assert recover_command(tmp_path / "own.capture") in err
    assert len(err.splitlines()) <= 2
    again = command(*arguments)
    assert again.returncode == 1
    assert recover_command(tmp_path / "own.capture") in again.stderr
    done = command("record", "--recover", tmp_path / "own.capture", "-o", tmp_path / "own.csv")
    assert done.returncode == 0, done.stderr
    own = read_take(tmp_path / "own.csv").sensors["right_wrist"].specific_force
    sent = take.sensors["right_wrist"].specific_force
    assert own == pytest.approx(sent[: len(own)], abs=1e-3)


REFUSED = {
    "missing port": (("--port", "{}/nothing", "--driver", DRIVER), 1, "no such port"),
    "no port": (("--driver", DRIVER), 2, "--port"),
    "no driver": (("--port", "loop://"), 2, "--driver"),
    "unknown driver": (("--port", "loop://", "--driver", "abacus"), 2, "abacus"),
    "unknown option": (
        ("--port", "loop://", "--driver", DRIVER, "--option", "a=b"), 1, 'has no option "a"',
    ),
    "nothing to attach to": (("--attach",), 1, "no running capture"),
    "nothing to recover": (("--recover", "{}/nothing"), 1, "nothing"),
    "unknown site": (("--port", "loop://", "--driver", DRIVER, "--sites", "nose"), 2, "nose"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_recorded_is_told_and_leaves_nothing(
    command: Command, tmp_path: Path, name: str
) -> None:
    arguments, code, problem = REFUSED[name]
    words = [word.format(tmp_path) for word in arguments]
    done = command("record", *words, "-o", tmp_path / "own.csv")
    assert done.returncode == code, done.stderr
    assert problem in done.stderr
    assert "Traceback" not in done.stderr
    if code == 1:
        assert len(done.stderr.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []
    assert sessions() == []


def test_live_streams_poses(
    start: Start, command: Command, take_path: Path, database_path: Path, tmp_path: Path
) -> None:
    port = first_line(start("emulate", take_path, "--driver", DRIVER))
    sites = ",".join(read_take(take_path).sites)
    done = command("live", "--port", port, "--driver", DRIVER, "--database", database_path,
                   "--sites", sites,
                   "--positions", tmp_path / "live.csv", "--seconds", 3)  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "poses" in done.stdout
    assert "sensors match the motion database" in done.stdout
    times, joints, positions = read_positions(tmp_path / "live.csv")
    assert len(joints) == 21
    assert 30 < len(times) < 110
    assert np.diff(times) == pytest.approx(1 / 25, abs=1e-5)
    assert np.isfinite(positions).all()
    assert abs(positions).max() < 2.5
    until(lambda: not sessions())


def test_emulated_and_recorded_the_motion_is_that_of_the_file(
    start: Start, command: Command, take_path: Path, database_path: Path, tmp_path: Path
) -> None:
    port = first_line(start("emulate", take_path, "--driver", DRIVER, "--speed", 3))
    done = command("record", "--port", port, "--driver", DRIVER, "-o", tmp_path / "own.csv",
                   "--sites", ",".join(read_take(take_path).sites),
                   "--seconds", read_take(take_path).end_s / 3 + 0.5)  # fmt: skip
    assert done.returncode == 0, done.stderr
    found = []
    for name, take in (("file", take_path), ("own", tmp_path / "own.csv")):
        positions = tmp_path / f"{name}_positions.csv"
        solved = command("reconstruct", "--database", database_path, take, "-o",
                         tmp_path / f"{name}.bvh", "--positions", positions)  # fmt: skip
        assert solved.returncode == 0, solved.stderr
        found.append(read_positions(positions)[2])
    count = min(map(len, found))
    assert count > 0.98 * max(map(len, found))
    apart = np.linalg.norm(found[0][:count] - found[1][:count], axis=2)
    assert apart.max() < 0.005
