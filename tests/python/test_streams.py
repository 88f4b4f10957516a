# SPDX-License-Identifier: GPL-3.0-or-later
"""The protocols of sensors as Python sees them."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from sparse_mocap import (
    SAMPLE_FLAGS,
    ConfigError,
    StreamEncoder,
    StreamParser,
    driver_names,
    driver_options,
    keep_alive_commands,
    start_commands,
)


def test_drivers_tell_their_options_and_commands() -> None:
    names = driver_names()
    assert names == ["xsens_mt", "witmotion", "witmotion_ble", "ximu3", "text_line", "slimevr"]
    for name in names:
        for option, (default, description) in driver_options(name).items():
            assert description
            if default:
                StreamParser(name, **{option: default})
    assert start_commands("xsens_mt")[0] == bytes.fromhex("FAFF3000D1")
    assert start_commands("text_line", start_text="x") == [b"x"]
    assert len(keep_alive_commands("slimevr")) == 1


def test_options_take_python_values() -> None:
    parser = StreamParser("text_line", columns=["ax", "ay", "az"], skip_first_line=False)
    assert len(parser.feed(b"0,0,9.81\n")["sensor"]) == 1
    with pytest.raises(ConfigError, match="nearest is 'columns'"):
        StreamParser("text_line", column="ax")
    with pytest.raises(ConfigError, match="nearest is 'ximu3'"):
        StreamParser("ximu")


def test_samples_are_arrays() -> None:
    parser = StreamParser("ximu3")
    assert parser.feed(b"I,1000,180,0,0,0,0,")["specific_force"].shape == (0, 3)
    got = parser.feed(b"1\r\nQ,1000,1,0,0,0\r\nF,1001,hot\r\nI,x\r\n")
    np.testing.assert_allclose(got["specific_force"], [[0, 0, 9.80665]])
    np.testing.assert_allclose(got["angular_velocity"], [[np.pi, 0, 0]])
    assert got["orientation"].shape == (1, 4)
    assert np.isnan(got["magnetic_field"]).all()
    assert got["counter"].tolist() == [-1]
    assert got["flags"].tolist() == [0]
    assert parser.sensor_names == ["ximu3"]
    assert parser.last_message == "hot"
    assert parser.counters["malformed"] == 1
    parser.reset()
    got = parser.feed(b"I,1000,0,0,0,0,0,1\r\nQ,1000,1,0,0,0\r\n")
    assert got["flags"].tolist() == [SAMPLE_FLAGS["after_reset"]]


def test_datagrams_and_their_answers() -> None:
    tracker = StreamEncoder("slimevr", ["a", "b"])
    parser = StreamParser("slimevr")
    for packet in tracker.hello():
        parser.feed(packet, sender="10.0.0.7:6969")
    assert parser.pop_replies()[0][:13] == b"\x03Hey OVR =D 5"
    force = [[0.0, 0.0, 9.81], [9.81, 0.0, 1.0]]
    got = [parser.feed(packet, "10.0.0.7:6969") for packet in tracker.encode(0.0, 0, force)]
    np.testing.assert_allclose(np.vstack([g["specific_force"] for g in got]), force, atol=1e-5)
    assert len(parser.sensor_names) == 2


def test_an_emulated_bus_streams_after_its_start_commands() -> None:
    options = {"output": "mtdata", "num_sensors": 3, "rate_hz": 60}
    device = StreamEncoder("xsens_mt", ["a", "b", "c"], **options)
    parser = StreamParser("xsens_mt", **options)
    for command in start_commands("xsens_mt", **options):
        parser.feed(device.respond(command))
    force = np.array([[0.0, 0.0, 9.81], [1.0, 0.0, 9.81], [2.0, 0.0, 9.81]])
    frames = b"".join(b"".join(device.encode(i / 60, i, force)) for i in range(10))
    got = parser.feed(frames)
    assert got["sensor"].tolist() == [0, 1, 2] * 10
    np.testing.assert_allclose(np.diff(got["time_s"][::3]), 1 / 60, atol=1e-9)
    np.testing.assert_allclose(got["specific_force"][-3:], force, atol=1e-5)
    with pytest.raises(ValueError, match="specific_force"):
        device.encode(0.0, 0, [1.0, 2.0])


def test_feeding_lets_other_threads_run() -> None:
    data = b"I,1,0,0,0,0,0,nan\n" * 400_000
    ticks = 0
    is_done = threading.Event()
    started = threading.Event()

    def feed() -> None:
        started.set()
        StreamParser("ximu3").feed(data)
        is_done.set()

    thread = threading.Thread(target=feed)
    thread.start()
    started.wait()
    while not is_done.wait(0.001):
        ticks += 1
    thread.join()
    assert ticks > 1
