# SPDX-License-Identifier: GPL-3.0-or-later
import os
import signal
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("sparse_mocap._core")
pytest.importorskip("serial")
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import sparse_mocap
from live_support import DRIVER, OPTIONS, emulated, own_runtime, until
from processes import is_alive, kill
from sparse_mocap.capture import CaptureClient
from sparse_mocap.capture.sample_log import SAMPLE
from sparse_mocap.demo_motions import generate_library

from blender_addon.session import live, sensors
from blender_addon.session.bake import Placement
from blender_addon.session.database import open_database
from blender_addon.session.errors import InputError
from blender_addon.session.live_poses import LivePoses
from blender_addon.session.methods import MethodChoice
from blender_addon.session.port_scanner import PortScanner

PLACEMENT = Placement(1.0, 25.0, True)
SITES = ["left_wrist", "right_wrist", "left_ankle", "right_ankle"]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A database's path, and a take of one of its motions."""
    folder = tmp_path_factory.mktemp("made")
    files = generate_library(folder)
    path = folder / "small.smdb"
    sparse_mocap.build_database(files[:40:10], path)
    motion, _ = sparse_mocap.standard_motion(sparse_mocap.read_motion(files[0])[0])
    return str(path), sparse_mocap.simulated(motion, SITES, 100.0)


@pytest.fixture(autouse=True)
def runtime(tmp_path):
    folder = tmp_path / "runtime"
    folder.mkdir(mode=0o700)
    with own_runtime(folder):
        yield
        live.end()


@pytest.fixture
def port(made):
    with emulated(made[1]) as port:
        yield port


def _connected(port, tmp_path, **how):
    chosen = sensors.Port(port, DRIVER, options=OPTIONS, sites=", ".join(SITES), **how)
    live.begin(sensors.new_session(chosen, tmp_path / "takes"))
    session = live.current()
    until(lambda: session.state.error or len(session.state.sensors) == len(SITES))
    assert session.state.error == ""
    return session


def test_live_poses_are_those_of_the_take(made, port, tmp_path):
    database = open_database(made[0])
    session = _connected(port, tmp_path)
    session.go_live(database, MethodChoice())
    poses = []

    def has_enough():
        pose = session.newest_pose()
        if pose is not None:
            poses.append(pose)
        return len(poses) >= 40

    until(has_enough)
    assert session.newest_pose() is None or len(poses) >= 40
    numbers = [pose.number for pose in poses]
    assert numbers == sorted(set(numbers))
    turned = np.ptp([pose.rotations for pose in poses], axis=0).max()
    assert turned > 0.1
    assert np.allclose(np.linalg.norm(poses[-1].rotations, axis=-1), 1.0)
    until(lambda: session.state.quality.num_poses >= 40)
    quality = session.state.quality
    assert 0.0 < quality.latency_s <= quality.worst_latency_s
    assert quality.match in ("good", "fair", "poor")
    session.leave_live()
    until(lambda: not session.state.is_live)


def test_a_recording_becomes_a_take_and_a_performance(made, port, tmp_path):
    session = _connected(port, tmp_path)
    session.record().result(5)
    until(lambda: session.state.recording and session.state.recording["samples"] > 600)
    job = sensors.save_take_job(session, made[0], "", tmp_path / "takes", MethodChoice(), PLACEMENT)
    kept = job.run()
    assert kept.reason == ""
    assert kept.warnings == ()
    assert Path(kept.path).parent == tmp_path / "takes"
    take = sparse_mocap.read_take(kept.path)
    assert take.sites == SITES
    assert take.end_s - take.begin_s > 1.0
    assert kept.placed is not None
    until(lambda: session.state.recording is None)


def test_a_take_is_kept_though_there_is_no_database(port, tmp_path):
    session = _connected(port, tmp_path)
    session.record().result(5)
    until(lambda: session.state.recording and session.state.recording["samples"] > 100)
    kept = sensors.save_take_job(
        session, "", "", tmp_path / "takes", MethodChoice(), PLACEMENT
    ).run()
    assert kept.placed is None
    assert "database" in kept.reason
    assert sparse_mocap.read_take(kept.path).sites == SITES


def test_closing_leaves_no_capture(port, tmp_path):
    session = _connected(port, tmp_path)
    [capture] = CaptureClient.running()
    assert session.close()
    until(lambda: not is_alive(capture.pid))
    assert CaptureClient.running() == []
    assert list((tmp_path / "takes").iterdir()) == []


def test_a_recording_outlives_the_session_and_is_found(port, tmp_path):
    session = _connected(port, tmp_path)
    session.record().result(5)
    live.end()
    assert not session.is_running
    scanner = PortScanner()
    scanner.scan()
    scanner.wait(10)
    [found] = scanner.result.captures
    assert found.recording_s is not None
    assert "recording" in found.text
    live.begin(sensors.attach_session(found.session))
    again = live.current()
    until(lambda: again.state.recording is not None)
    kept = sensors.save_take_job(again, "", "", tmp_path / "takes", MethodChoice(), PLACEMENT).run()
    assert sparse_mocap.read_take(kept.path).sites == SITES
    live.end()
    until(lambda: not is_alive(found.pid))


@pytest.mark.skipif(sys.platform == "win32", reason="Windows cannot hold a process")
def test_a_held_capture_does_not_hold_the_session(port, tmp_path):
    session = _connected(port, tmp_path)
    [capture] = CaptureClient.running()
    os.kill(capture.pid, signal.SIGSTOP)
    try:
        closing = threading.Thread(target=session.close)
        closing.start()
        until(lambda: not closing.is_alive())
    finally:
        os.kill(capture.pid, signal.SIGCONT)
    until(lambda: not is_alive(capture.pid))


def test_a_killed_capture_is_told_in_a_line(port, tmp_path):
    session = _connected(port, tmp_path)
    [capture] = CaptureClient.running()
    kill(capture.pid)
    until(lambda: not session.is_running)
    assert "ended" in session.state.error
    assert "\n" not in session.state.error
    with pytest.raises(InputError, match="Connect"):
        session.record().result(1)


def test_a_port_that_is_not_there_is_told_in_a_line(tmp_path):
    live.begin(sensors.new_session(sensors.Port("/dev/not-there", DRIVER), tmp_path / "takes"))
    session = live.current()
    until(lambda: not session.is_running)
    assert "no such port" in session.state.error
    assert "\n" not in session.state.error
    assert CaptureClient.running() == []


@pytest.mark.parametrize(
    ("port", "said"),
    [
        (sensors.Port("", DRIVER), "port"),
        (sensors.Port("/dev/x", "nonsense"), "nonsense"),
        (sensors.Port("/dev/x", DRIVER, sites="nose"), "nose"),
        (sensors.Port("/dev/x", DRIVER, options="fast"), "fast"),
    ],
)
def test_bad_choices_are_told_before_anything_starts(port, said, tmp_path):
    with pytest.raises(ValueError, match=said):
        sensors.new_session(port, tmp_path / "takes")
    assert not (tmp_path / "takes").exists()


def test_options_may_be_lists():
    text = "rate_hz=100, columns=time,ax, ay,az,separator=tab"
    assert sensors._options(text) == {
        "rate_hz": "100", "columns": "time,ax,ay,az", "separator": "tab",
    }  # fmt: skip
    with pytest.raises(InputError, match="fast"):
        sensors._options("fast, rate_hz=1")


def test_one_session_at_a_time(port, tmp_path):
    _connected(port, tmp_path)
    with pytest.raises(InputError, match="Disconnect"):
        _connected(port, tmp_path)


def test_a_preview_that_is_too_slow_uses_the_newest_reading(made):
    channels = [["specific_force"]] * len(SITES)
    poses = LivePoses(
        open_database(made[0]).motions, dict(enumerate(SITES)), channels, MethodChoice()
    )
    seconds = 4.0
    samples = np.zeros(int(100 * seconds) * len(SITES), SAMPLE)
    samples["sensor"] = np.tile(np.arange(len(SITES)), len(samples) // len(SITES))
    times_s = np.repeat(np.arange(len(samples) // len(SITES)) / 100.0, len(SITES))
    samples["arrival_ns"] = (time.perf_counter() - seconds + times_s) * 1e9
    samples["device_time_s"], samples["specific_force"] = times_s, [0.0, 0.0, 9.81]
    assert poses.advance(samples) is None
    assert poses.quality().num_skipped > 80


def test_several_ports_make_one_session(made, tmp_path):
    with emulated(made[1]) as left, emulated(made[1]) as right:
        first, second = (sensors.Port(port, DRIVER, options=OPTIONS) for port in (left, right))
        live.begin(sensors.new_session(first, tmp_path / "takes", [second]))
        session = live.current()
        until(lambda: session.state.error or len(session.state.sensors) == 2 * len(SITES))
        assert session.state.error == ""
        assert [link["state"] for link in session.state.links] == ["streaming"] * 2
        live.end()
    with pytest.raises(InputError, match="twice"):
        sensors.new_session(first, tmp_path / "takes", [first])


def test_a_location_is_chosen_and_remembered_for_the_sensor(made, port, tmp_path):
    chosen = sensors.Port(port, DRIVER, options=OPTIONS)
    live.begin(sensors.new_session(chosen, tmp_path / "takes"))
    session = live.current()
    until(lambda: len(session.state.sensors) == len(SITES))
    assert [sensor["site"] for sensor in session.state.sensors] == [""] * len(SITES)
    session.go_live(open_database(made[0]), MethodChoice())
    until(lambda: "no sensor has a sensor location" in session.state.no_readings)
    first, second = (str(sensor["identity"]) for sensor in session.state.sensors[:2])
    session.set_site(first, "head").result(5)
    until(lambda: session.state.sensors[0]["site"] == "head")
    session.set_site(second, "head").result(5)
    until(lambda: session.state.notes)
    assert "both worn at head" in session.state.notes[0]
    session.set_site(second, "").result(5)
    until(lambda: session.state.sensors[0]["site"] == "head" and not session.state.notes)
    remembered = sensors.capture().remembered_sites.remembered_sites()
    assert remembered == {first: "head"}


def test_the_shaken_sensor_is_put_at_the_chosen_location(made, tmp_path):
    times = np.arange(2000) / 100.0
    still = np.tile([0.0, 0.0, 9.81], (len(times), 1))
    shaken = still + 30.0 * np.sin(20.0 * times)[:, None] * [1.0, 0.0, 0.0]
    records = {
        site: sparse_mocap.SensorRecord(times, shaken if site == SITES[2] else still)
        for site in SITES
    }
    with emulated(sparse_mocap.Take(records)) as port:
        chosen = sensors.Port(port, DRIVER, options=OPTIONS)
        live.begin(sensors.new_session(chosen, tmp_path / "takes"))
        session = live.current()
        until(lambda: len(session.state.sensors) == len(SITES))
        session.find_by_shaking("left_ankle").result(5)
        until(lambda: session.state.sensors[2]["site"] == "left_ankle")
        until(lambda: session.state.shaking == "")
        assert [sensor["site"] for sensor in session.state.sensors].count("") == 3
        live.end()


def test_no_readings_are_told_within_a_second(made, tmp_path):
    database = open_database(made[0])
    goes_on = threading.Event()
    goes_on.set()
    with emulated(lambda: goes_on.wait() and made[1]) as port:
        session = _connected(port, tmp_path)
        session.go_live(database, MethodChoice())
        until(lambda: session.state.quality.num_poses > 5)
        assert session.state.no_readings == ""
        goes_on.clear()
        until(lambda: session.state.no_readings)
        assert "No readings for" in session.state.no_readings
        goes_on.set()
        until(lambda: not session.state.no_readings)
        live.end()
    assert live.NO_READINGS_S + live._STATUS_S < 1.0
