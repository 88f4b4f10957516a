# SPDX-License-Identifier: GPL-3.0-or-later
"""What a port says that receives data and makes no samples of them: a person can mend it from the
message alone."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from sparse_mocap import ConfigError, StreamEncoder
from sparse_mocap.capture import LinkConfig
from sparse_mocap.capture.diagnosis import (
    check_bandwidth,
    why_no_bytes,
    why_no_samples,
    why_odd_values,
)

USB, UDP = "/dev/ttyUSB0", "udp://0.0.0.0:5005"
FORCE, TURN, UPRIGHT = [[0.0, 0.0, 9.81]], [[0.0, 0.1, 0.0]], [[1.0, 0.0, 0.0, 0.0]]


def frames(driver: str, **options: str) -> list[bytes]:
    device = StreamEncoder(driver, ["a"], **options)
    return [
        packet
        for index in range(20)
        for packet in device.encode(index / 100, index, FORCE, TURN, UPRIGHT)
    ]


def lines(text: str) -> list[bytes]:
    return [f"{text}\r\n".encode()] * 20


WRONG: dict[str, tuple[LinkConfig, list[bytes], tuple[str, ...]]] = {
    "ble for serial": (
        LinkConfig(USB, "witmotion"), frames("witmotion_ble"),
        ("WitMotion BLE frames", "55 61", "choose the protocol witmotion_ble"),
    ),
    "serial for ble": (
        LinkConfig(USB, "witmotion_ble"), frames("witmotion"),
        ("WitMotion frames", "choose the protocol witmotion instead"),
    ),
    "x-IMU3 for lines": (
        LinkConfig(USB, "xsens_mt"), frames("ximu3"), ("x-IMU3", "choose the protocol ximu3"),
    ),
    "lines for frames": (
        LinkConfig(USB, "xsens_mt"), lines("1.5,2.5,9.8"), ("1.5,2.5,9.8", "choose text_line"),
    ),
    "noise": (
        LinkConfig(USB, "ximu3", 9600), [np.random.default_rng(1).bytes(500)],
        ("baud rate (9600)", "protocol"),
    ),
    "noise by UDP": (
        LinkConfig(UDP, "ximu3"), [np.random.default_rng(1).bytes(500)], ("check the protocol",),
    ),
    "decimal commas": (
        LinkConfig(USB, "text_line", options={"separator": "semicolon"}),
        lines("0,12;-0,05;9,81;0,0;0,1;0,2"), ("decimal commas", "decimal points", "0,12;-0,05"),
    ),
    "labels": (
        LinkConfig(USB, "text_line"), lines("ax:0.1,ay:0.2,az:9.8,gx:0,gy:0,gz:0"),
        ("labels such as 'ax'", "numbers alone"),
    ),
    "labels between blanks": (
        LinkConfig(USB, "text_line"), lines("ax: 0.10 ay: 0.20 az: 9.81"), ("labels such as 'ax'",),
    ),
    "one label": (
        LinkConfig(USB, "text_line", options={"separator": "tab"}),
        lines("a/g:\t1\t2\t16384\t0\t0\t0"), ("prefix=a/g:",),
    ),
    "one column too many": (
        LinkConfig(USB, "text_line"), lines("12,0,0,9.8,0,0,0"),
        ("7 columns, 1 too many", "ax,ay,az,gx,gy,gz", "option columns"),
    ),
    "too few columns": (LinkConfig(USB, "text_line"), lines("0,0,9.8"), ("3 too few",)),
    "JSON": (
        LinkConfig(UDP, "text_line"), [b'{"ax": 0.1, "ay": 0, "az": 9.8}'] * 5,
        ("JSON", "separated by commas"),
    ),
    "a header": (
        LinkConfig(USB, "text_line"), [b"Time_ms,AccX,AccY,AccZ\n", *lines("10,0,0,9.8")],
        ("Time_ms,AccX,AccY,AccZ", "columns=header"),
    ),
    "no header": (
        LinkConfig(USB, "text_line", options={"columns": "header"}), lines("10,0,0,9.8"),
        ("no header line", "restart the device"),
    ),
    "another separator": (
        LinkConfig(USB, "text_line"), lines("0;0;9.8;0;0;0"), ("separator=semicolon",),
    ),
    "no number": (
        LinkConfig(USB, "text_line"), lines("0,0,nan,0,0,0"), ("'nan'", "column az"),
    ),
    "no line end": (LinkConfig(USB, "text_line"), [b"0,0,9.8,0,0,0"], ("println",)),
    "no greeting": (
        LinkConfig("udp://0.0.0.0:6969", "slimevr"),
        [struct.pack(">iq3fB", 4, i, 0, 0, 0, 0) for i in range(9)], ("no tracker", "restart"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_stream_is_explained(name: str) -> None:
    config, arrived, expected = WRONG[name]
    said = why_no_samples(config, arrived)
    for part in expected:
        assert part in said, said
    assert "\n" not in said
    assert len(said) < 300
    if config.port == UDP:
        assert "baud" not in said
    print(f"{name}: {said}")


def test_silence_is_explained_in_the_words_of_the_port() -> None:
    assert "baud" in why_no_bytes(LinkConfig(USB, "text_line"))
    said = why_no_bytes(LinkConfig(UDP, "text_line"))
    assert "firewall" in said
    assert "baud" not in said


@pytest.mark.parametrize(
    ("size", "expected"),
    [(1.0, "acceleration_unit=g"), (1000.0, "=mg"), (16384.0, "=raw"), (9.8, ""), (40.0, "")],
)
def test_values_in_another_unit_are_told(size: float, expected: str) -> None:
    said = why_odd_values(LinkConfig(USB, "text_line"), "A7", size)
    assert (expected in said) if expected else said == ""


def test_a_rate_that_the_baud_rate_cannot_carry_is_refused() -> None:
    check_bandwidth(LinkConfig(USB, "witmotion", 115200))
    check_bandwidth(LinkConfig("socket://a:1", "witmotion", 9600))
    check_bandwidth(LinkConfig(USB, "witmotion", 9600, {"rate_hz": "20"}))
    for options in ({}, {"rate_hz": "50"}):
        with pytest.raises(ConfigError, match="9600 baud carry 960 bytes a second"):
            check_bandwidth(LinkConfig(USB, "witmotion", 9600, options))
