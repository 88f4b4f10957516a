# SPDX-License-Identifier: GPL-3.0-or-later
"""What each driver is for, in the words of somebody who has the device in front of them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

__all__ = ["GUIDES", "Guide", "sketch", "sketch_names"]


@dataclass(frozen=True)
class Guide:
    """How to use a driver."""

    devices: str
    example: str
    """Arguments of `sparse-mocap record`, but for the output."""
    notes: tuple[str, ...] = ()


GUIDES = {
    "xsens_mt": Guide(
        "Xsens MTi, MTx and MTw by a serial port, several MTx on an Xbus Master",
        "--port /dev/ttyUSB0 --driver xsens_mt --site 00B421E6=left_wrist",
    ),
    "witmotion": Guide(
        "WitMotion sensors by USB or serial (frames 55 51), one port each",
        "--port /dev/ttyUSB0 --driver witmotion --baud 9600 --option rate_hz=20",
        ("at 9600 baud, the factory setting of bare modules, no more than 20 Hz fit",),
    ),
    "witmotion_ble": Guide(
        "WitMotion BLE sensors (WT901BLE) by a USB adapter or a serial bridge (frames 55 61)",
        "--port /dev/ttyUSB0 --driver witmotion_ble",
        ("Bluetooth itself is not read: use the maker's USB adapter, or a bridge to a port",),
    ),
    "ximu3": Guide(
        "x-IMU3 by USB, serial or a TCP bridge; several on a multiplexer",
        "--port /dev/ttyACM0 --driver ximu3 --site 64F619FB=left_wrist",
    ),
    "text_line": Guide(
        "Arduino, ESP32 and anything that prints a line of numbers for each sample",
        "--port /dev/ttyUSB0 --driver text_line --option columns=time,ax,ay,az,gx,gy,gz "
        "--option time_unit=us",
        (
            "columns=header reads the names in the device's first line, such as Time_ms,AccX,...",
            "over Wi-Fi: --port udp://0.0.0.0:5005; each datagram is a line, each sender a sensor",
            "`sparse-mocap drivers --sketch mpu6050` and `--sketch bno055` print sketches",
        ),
    ),
    "slimevr": Guide(
        "SlimeVR trackers, and phones with owoTrack, by Wi-Fi",
        "--port udp://0.0.0.0:6969 --driver slimevr --site 24:e6:a1:b2:c3:d4=left_wrist",
        (
            "close the SlimeVR server first: both listen at the same port",
            "macs=... accepts these trackers alone, where strangers share the network",
        ),
    ),
}


def sketch_names() -> list[str]:
    """Returns the names of the sketches for microcontrollers."""
    return sorted(
        path.name.removesuffix(".ino") for path in _folder().iterdir() if path.name.endswith(".ino")
    )


def sketch(name: str) -> str:
    """Returns a sketch, to be saved and uploaded with the Arduino IDE."""
    return (_folder() / f"{name}.ino").read_text(encoding="utf-8")


def _folder() -> Path:
    return Path(__file__).with_name("sketches")
