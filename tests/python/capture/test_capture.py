# SPDX-License-Identifier: GPL-3.0-or-later
"""The capture process: clients come and go, processes are killed, and nothing is lost or left."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from capture_support import DRIVER, OPTIONS, SITES, Play, some_take, until
from processes import is_alive, kill
from sparse_mocap import StreamEncoder
from sparse_mocap.capture import (
    CaptureClient,
    CaptureConfig,
    CaptureError,
    Faults,
    LinkConfig,
    RecordingError,
    recording_to_take,
    start_capture,
)
from sparse_mocap.capture.session import session_path, sessions


def config_for(port: str, **how: object) -> CaptureConfig:
    how.setdefault("sites", SITES)
    return CaptureConfig((LinkConfig(port, DRIVER, options=OPTIONS),), **how)  # type: ignore[arg-type]


def test_samples_reach_a_client_and_the_disk(play: Play, tmp_path: Path) -> None:
    take = some_take(2.0)
    emulator = play(take)
    with CaptureClient.start(
        emulator.lines[0].path, DRIVER, tmp_path / "c", options=OPTIONS
    ) as client:
        client.wait_for_samples(10.0)
        samples = [client.read()]
        until(lambda: client.status()["samples"] == 600)
        samples.append(client.read())
        status = client.status()
        client.stop()
    everything = np.concatenate(samples)
    assert len(everything) == 600
    assert [sensor["samples"] for sensor in status["sensors"]] == [200] * 3
    assert [sensor["missing"] for sensor in status["sensors"]] == [0] * 3
    first = everything[everything["sensor"] == 0]["specific_force"]
    assert first == pytest.approx(take.sensors["left_wrist"].specific_force, abs=0.02)


def test_a_client_detaches_and_another_goes_on_where_it_was(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(3.0))
    client = CaptureClient.start(emulator.lines[0].path, DRIVER, tmp_path / "c", options=OPTIONS)
    client.wait_for_samples(10.0)
    client.read()
    position = client.position
    client.close()
    time.sleep(0.5)  # a consumer that is away, or stalled: the log waits for it
    (session,) = sessions()
    with CaptureClient(session, position) as other:
        until(lambda: other.status()["samples"] == 900)
        assert len(other.read()) == 900 - position
        other.stop()


def test_looking_for_captures_keeps_none_alive(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(10.0))
    start_capture(config_for(emulator.lines[0].path, linger_s=0.5), tmp_path / "c").close()
    assert len(sessions()) == 1
    until(lambda: sessions() == [])


def test_without_clients_and_recording_the_process_ends(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(10.0))
    config = config_for(emulator.lines[0].path, linger_s=0.3)
    client = start_capture(config, tmp_path / "c")
    pid = client.session.pid
    time.sleep(1.0)
    assert is_alive(pid)
    client.close()
    until(lambda: not is_alive(pid))
    assert not session_path(pid).exists()
    assert sessions() == []
    assert not Path(f"/proc/{pid}").exists()  # no zombie either


def test_a_temporary_capture_leaves_no_folder(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(10.0))
    config = config_for(emulator.lines[0].path, linger_s=0.1, is_temporary=True)
    start_capture(config, tmp_path / "c").close()
    until(lambda: not (tmp_path / "c").exists())


def test_a_recording_goes_on_without_clients(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(3.0))
    config = config_for(emulator.lines[0].path, linger_s=0.1, must_record=True)
    start_capture(config, tmp_path / "c").close()
    time.sleep(1.5)
    (session,) = sessions()
    with CaptureClient(session) as client:
        assert client.status()["recording"]["number"] == 0
        until(lambda: client.status()["samples"] == 900)
        client.stop_recording()
    until(lambda: not is_alive(session.pid))
    assert all(
        len(r.times_s) == 300 for r in recording_to_take(tmp_path / "c").take.sensors.values()
    )


def test_who_leaves_ends_only_what_nobody_else_needs(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(10.0))
    config = config_for(emulator.lines[0].path, linger_s=60.0, is_temporary=True)
    first = start_capture(config, tmp_path / "c")
    second, third = (CaptureClient(first.session) for _ in range(2))
    first.wait_for_samples(10.0)
    first.record()
    assert not first.leave()
    second.skip()
    until(lambda: len(second.read()) > 0)
    second.stop_recording()
    assert not second.leave()
    assert is_alive(third.session.pid)
    third.skip()
    until(lambda: len(third.read()) > 0)
    assert third.leave()
    until(lambda: not is_alive(third.session.pid))
    assert len(recording_to_take(tmp_path / "c").take.sensors) == 3


def test_a_folder_goes_when_what_was_recorded_is_kept(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(10.0))
    for folder, records_again in ((tmp_path / "gone", False), (tmp_path / "there", True)):
        config = config_for(emulator.lines[0].path, linger_s=0.1, must_record=True)
        first = start_capture(config, folder)
        second = CaptureClient(first.session)
        first.wait_for_samples(10.0)
        first.stop_recording()
        first.tell_saved(0)
        assert not first.leave()
        if records_again:
            second.record()
            second.stop_recording()
            second.tell_saved(7)
        assert second.leave()
        assert folder.exists() == records_again


def test_a_recording_ends_by_itself(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(5.0))
    with CaptureClient.start(
        emulator.lines[0].path, DRIVER, tmp_path / "c", options=OPTIONS
    ) as client:
        client.wait_for_samples(10.0)
        client.record(0.5)
        until(lambda: client.status()["recording"] is None)
        client.stop()
    length = recording_to_take(tmp_path / "c").take.end_s
    assert 0.3 < length < 2.0


def test_two_recordings_of_a_capture_are_two_takes(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(5.0))
    with CaptureClient.start(
        emulator.lines[0].path, DRIVER, tmp_path / "c", options=OPTIONS
    ) as client:
        client.wait_for_samples(10.0)
        for number in range(2):
            assert client.record()["number"] == number
            time.sleep(0.4)
            client.stop_recording()
            time.sleep(0.3)
        client.stop()
    first, second = (recording_to_take(tmp_path / "c", number) for number in range(2))
    assert first.begin_ns + first.take.end_s * 1e9 < second.begin_ns
    with pytest.raises(RecordingError, match="no recording 2"):
        recording_to_take(tmp_path / "c", 2)


def mac_of(device: StreamEncoder) -> str:
    greeting = device.hello()[0]
    return ":".join(f"{byte:02x}" for byte in greeting[-6:])


def test_trackers_over_udp_are_told_apart_and_recorded(tmp_path: Path) -> None:
    with closing(socket.socket(socket.AF_INET, socket.SOCK_DGRAM)) as free:
        free.bind(("127.0.0.1", 0))
        address = free.getsockname()
    link = LinkConfig(f"udp://{address[0]}:{address[1]}", "slimevr")
    take = some_take(1.0, 2)
    devices = [StreamEncoder("slimevr", [site]) for site in take.sites]
    site_of = {mac_of(device): site for device, site in zip(devices, take.sites, strict=True)}
    config = CaptureConfig((link,), site_of=site_of, must_record=True)
    trackers = []
    with start_capture(config, tmp_path / "c") as client:
        until(lambda: client.status()["links"][0]["state"] == "configuring")
        for device in devices:
            tracker = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            tracker.settimeout(5.0)
            tracker.connect(address)
            trackers.append((tracker, device))
        for tracker, device in trackers:
            for packet in device.hello():
                tracker.send(packet)
            assert b"Hey OVR" in tracker.recv(100)
        for index in range(100):
            for (tracker, device), record in zip(trackers, take.sensors.values(), strict=True):
                force, turn = record.specific_force[index, None], record.orientation[index, None]
                for packet in device.encode(index / 100, index, force, None, turn):
                    tracker.send(packet)
            time.sleep(0.002)
        until(lambda: client.status()["samples"] == 200)
        client.stop()
    for tracker, _ in trackers:
        tracker.close()
    recorded = recording_to_take(tmp_path / "c").take
    for site, sent in take.sensors.items():
        own = recorded.sensors[site]
        assert own.specific_force == pytest.approx(sent.specific_force, abs=0.05)


CONSUMER = """
import sys, time
from sparse_mocap.capture import CaptureConfig, LinkConfig, start_capture
from pathlib import Path
link = LinkConfig(sys.argv[1], sys.argv[2], options={"output": "mtdata"})
config = CaptureConfig((link,), must_record=True)
client = start_capture(config, Path(sys.argv[3]))
print(client.session.pid, flush=True)
while True:
    client.read()
    time.sleep(0.01)
"""


def test_a_killed_client_ends_no_recording(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(3.0))
    consumer = subprocess.Popen(
        [sys.executable, "-c", CONSUMER, emulator.lines[0].path, DRIVER, str(tmp_path / "c")],
        stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    with consumer:
        assert consumer.stdout is not None
        pid = int(consumer.stdout.readline())
        time.sleep(1.0)
        consumer.kill()
    assert is_alive(pid)
    (session,) = sessions()
    with CaptureClient(session, 0) as client:
        until(lambda: client.status()["samples"] == 900)
        assert len(client.read()) == 900
        client.stop()


def test_a_killed_capture_loses_nothing_that_it_had(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(5.0))
    config = config_for(emulator.lines[0].path, must_record=True)
    with start_capture(config, tmp_path / "c") as client:
        client.wait_for_samples(10.0)
        time.sleep(0.5)
        kill(client.session.pid)
        until(lambda: not is_alive(client.session.pid))
        live = client.read()
        with pytest.raises(
            CaptureError, match="save what it received with: sparse-mocap record --recover"
        ):
            client.status()
    until(lambda: sessions() == [])  # its other threads may take a moment to end
    take = recording_to_take(tmp_path / "c").take
    kept = sum(len(record.times_s) for record in take.sensors.values())
    assert kept >= len(live) > 100
    sent = emulator.take.sensors["right_wrist"].specific_force
    own = take.sensors["right_wrist"].specific_force
    assert own == pytest.approx(sent[: len(own)], abs=0.02)


@pytest.mark.skipif(sys.platform == "win32", reason="needs pseudo-terminals")
def test_unplugged_and_back_the_recording_goes_on_and_the_gap_is_told(
    play: Play, tmp_path: Path
) -> None:
    link = tmp_path / "port"
    faults = Faults(cut_after_s=1.0, replug_after_s=0.6)
    play(some_take(5.0), faults=faults, link_path=link)
    with start_capture(config_for(str(link), must_record=True), tmp_path / "c") as client:
        until(lambda: client.status()["links"][0]["reconnects"] == 1)
        until(lambda: client.status()["links"][0]["state"] == "streaming")
        time.sleep(1.0)
        status = client.status()
        client.stop()
    assert len(status["sensors"]) == 3
    recorded = recording_to_take(tmp_path / "c")
    assert len(recorded.gaps) == 3
    for gap in recorded.gaps:
        assert gap.begin_s == pytest.approx(1.0, abs=0.1)
        assert 0.6 <= gap.end_s - gap.begin_s < 2.6
    assert any("no data from left_wrist between" in line for line in recorded.take.comments)


def test_sensors_on_ports_of_their_own_make_one_take(play: Play, tmp_path: Path) -> None:
    left, right = play(some_take(2.0, 1)), play(some_take(2.0, 1))
    links = tuple(
        LinkConfig(emulator.lines[0].path, DRIVER, options=OPTIONS) for emulator in (left, right)
    )
    config = CaptureConfig(links, ("left_ankle", "right_ankle"), must_record=True)
    with start_capture(config, tmp_path / "c") as client:
        until(lambda: client.status()["samples"] == 400)
        client.stop()
    recorded = recording_to_take(tmp_path / "c")
    assert recorded.take.sites == ["left_ankle", "right_ankle"]
    assert recorded.warnings == []
    assert [len(record.times_s) for record in recorded.take.sensors.values()] == [200, 200]


def test_two_sensors_with_one_id_are_told(play: Play, tmp_path: Path) -> None:
    options = {"columns": "time,sensor,counter,ax,ay,az"}
    faults = Faults(is_id_duplicate=True)
    emulator = play(some_take(5.0, 2), "text_line", options=options, faults=faults)
    config = CaptureConfig((LinkConfig(emulator.lines[0].path, "text_line", options=options),))
    with start_capture(config, tmp_path / "c") as client:
        until(lambda: "two sensors seem to have the same id" in str(client.status()["links"]))
        client.stop()


def test_a_missing_port_is_told_at_once(tmp_path: Path) -> None:
    with CaptureClient.start(
        str(tmp_path / "nothing"), DRIVER, tmp_path / "c", options=OPTIONS
    ) as client:
        with pytest.raises(CaptureError, match="no such port"):
            client.wait_for_samples(10.0)
        client.stop()


@pytest.mark.skipif(sys.platform == "win32", reason="needs pseudo-terminals")
def test_a_silent_device_is_told_after_the_timeout(play: Play, tmp_path: Path) -> None:
    master, slave = os.openpty()
    with CaptureClient.start(os.ttyname(slave), DRIVER, tmp_path / "c", options=OPTIONS) as client:
        with pytest.raises(CaptureError, match=r"no data within 0\.5 s"):
            client.wait_for_samples(0.5)
        client.stop()
    os.close(master)
    os.close(slave)


def test_a_used_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "c").mkdir()
    (tmp_path / "c" / "raw.log").write_bytes(b"x")
    with pytest.raises(CaptureError, match="is not empty"):
        CaptureClient.start("loop://", DRIVER, tmp_path / "c", options=OPTIONS)


@pytest.mark.skipif(sys.platform == "win32", reason="needs pseudo-terminals")
def test_a_capture_outlives_its_terminal(play: Play, tmp_path: Path) -> None:
    emulator = play(some_take(10.0))
    with CaptureClient.start(
        emulator.lines[0].path, DRIVER, tmp_path / "c", options=OPTIONS
    ) as client:
        pid = client.session.pid
        assert os.getsid(pid) == pid  # a session of its own
        for number in (signal.SIGHUP, signal.SIGINT):
            os.kill(pid, number)
        time.sleep(0.2)
        assert client.status()
        os.kill(pid, signal.SIGTERM)
        until(lambda: not is_alive(pid))
    assert not session_path(pid).exists()
