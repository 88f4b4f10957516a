# SPDX-License-Identifier: GPL-3.0-or-later
"""The sensor protocols, for captures and emulators."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .. import ConfigError, StreamEncoder, StreamParser
from .. import driver_names as driver_names
from .. import keep_alive_commands as _keep_alive_commands
from .. import start_commands as _start_commands
from .sample_log import SAMPLE, Samples

__all__ = [
    "KEEP_ALIVE_S",
    "START_PAUSE_S",
    "Encoder",
    "can_share_a_port",
    "keep_alive_commands",
    "make_parser",
    "parsed",
    "start_commands",
    "with_rate",
]

DATAGRAM_DRIVERS = ("slimevr",)
"""On a serial port their datagrams are sent as [u16 length, big-endian][datagram]."""

KEEP_ALIVE_S = {"slimevr": 0.04}
"""How often a driver's devices must be written to; otherwise every second. A tracker that is still
sends nothing but answers to this."""
START_PAUSE_S = {"witmotion": 0.1, "witmotion_ble": 0.1}
"""What a device needs between two commands."""

_SAME_NAMES = (
    "sensor", "counter", "flags", "specific_force", "angular_velocity", "orientation",
)  # fmt: skip


def make_parser(driver: str, options: Mapping[str, str]) -> StreamParser:
    """Returns a parser. Raises ConfigError for an unknown driver or option."""
    return StreamParser(driver, **options)


def parsed(parser: StreamParser, data: bytes, sender: str = "") -> Samples:
    """Returns the samples completed by these bytes or this datagram, without arrival times."""
    columns = parser.feed(data, sender or None)
    samples = np.zeros(len(columns["sensor"]), SAMPLE)
    for name in _SAME_NAMES:
        samples[name] = columns[name]
    samples["device_time_s"] = columns["time_s"]
    return samples


def start_commands(driver: str, options: Mapping[str, str]) -> tuple[bytes, ...]:
    """The commands that make the device send."""
    return tuple(_start_commands(driver, **options))


def keep_alive_commands(driver: str, options: Mapping[str, str]) -> tuple[bytes, ...]:
    """What must be sent to the device every second."""
    return tuple(_keep_alive_commands(driver, **options))


class Encoder:
    """Encodes what a device with these sensors sends. Raises ConfigError for too many sensors."""

    def __init__(self, driver: str, sensors: Sequence[str], options: Mapping[str, Any]) -> None:
        self._encoder = StreamEncoder(driver, list(sensors), **options)
        self._is_datagram = driver in DATAGRAM_DRIVERS
        self._counter = 0

    def hello(self) -> list[bytes]:
        """What the device sends when it starts."""
        return [self._framed(packet) for packet in self._encoder.hello()]

    def encode(self, time_s: float, samples: Samples) -> list[bytes]:
        """The packets of an instant, in s since the device started."""
        packets = self._encoder.encode(
            time_s,
            self._counter,
            samples["specific_force"].astype(np.float64),
            samples["angular_velocity"].astype(np.float64),
            samples["orientation"].astype(np.float64),
            samples["sensor"].tolist(),
        )
        self._counter += 1
        return [self._framed(packet) for packet in packets]

    def respond(self, request: bytes) -> bytes:
        """The device's answer to what a host sent."""
        return bytes(self._encoder.respond(request))

    def _framed(self, packet: bytes) -> bytes:
        return len(packet).to_bytes(2, "big") + packet if self._is_datagram else packet


def with_rate(driver: str, options: Mapping[str, Any], rate_hz: float) -> dict[str, Any]:
    """The options with the sensors' rate, if the driver has such an option and allows the rate."""
    wanted = {"rate_hz": f"{rate_hz:g}", **options}
    try:
        StreamParser(driver, **wanted)
    except ConfigError:  # no such option, or the device has no such rate
        return dict(options)
    return wanted


def can_share_a_port(driver: str, sensors: Sequence[str], options: Mapping[str, Any]) -> bool:
    """Whether one device of the driver can have all these sensors."""
    try:
        Encoder(driver, sensors, options)
    except ConfigError:
        # If a single sensor fails too, the options are wrong: raises.
        Encoder(driver, sensors[:1], options)
        return False
    return True
