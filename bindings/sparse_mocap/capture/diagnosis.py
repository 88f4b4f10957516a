# SPDX-License-Identifier: GPL-3.0-or-later
"""Why a port that receives data gives no samples, in a line that says what to do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .. import ConfigError, StreamParser, driver_options
from .config import LinkConfig
from .text_diagnosis import is_text, why_no_lines

__all__ = ["check_bandwidth", "why_no_bytes", "why_no_samples", "why_odd_values"]

KINDS = {
    "xsens_mt": "Xsens messages",
    "witmotion": "WitMotion frames",
    "witmotion_ble": "WitMotion BLE frames",
    "ximu3": "x-IMU3 messages",
    "slimevr": "SlimeVR trackers",
}
"""What the data of each driver but text_line are called."""

_STARTS = (b"\x55\x61", b"\x55\x51", b"\xfa\xff")
_SURE_FRAMES = 3
_SHOWN_BYTES = 8
_GRAVITY_MPS2 = 9.81


def why_no_samples(config: LinkConfig, arrived: Sequence[bytes]) -> str:
    """Returns why a driver makes no samples of the newest data, and what to do.

    arrived: as it was read, oldest first; each a datagram for a port udp://.
    """
    is_datagram = config.port.startswith("udp://")
    data = b"".join(arrived)
    if is_text(data):
        lines = _lines(arrived, is_datagram)
        if config.driver == "text_line":
            return why_no_lines(lines, config.options)
        if other := _understood_by(config, arrived, is_datagram, ("ximu3",)):
            return _other(data, config, other)
        last = next((line for line in reversed(lines) if line.strip()), "")
        return (
            f"text arrives, such as '{last.strip()[:60]}', and not the data of the protocol "
            f"{config.driver}; choose text_line, if these are numbers"
        )
    if other := _understood_by(config, arrived, is_datagram, tuple(KINDS)):
        return _other(data, config, other)
    if config.driver == "slimevr" and is_datagram:
        return (
            "datagrams arrive, but no tracker has introduced itself yet; wait 5 s, "
            "then restart the tracker"
        )
    advice = "check the protocol"
    if not is_datagram and "://" not in config.port:
        baud = config.baud or "all were tried"
        advice = f"check the protocol and the baud rate ({baud}); 0 tries the usual rates"
    return f"the data, such as {_shown(data)}, are not of the protocol {config.driver}; {advice}"


def why_no_bytes(config: LinkConfig) -> str:
    """Returns what to check when nothing arrives at all."""
    if config.port.startswith("udp://"):
        return (
            "nothing has arrived; give the sensors this computer's address and the port's number, "
            "and let them through the firewall"
        )
    if "://" in config.port:
        return "nothing has arrived; check that the device is on"
    return "nothing has arrived; check that the device is on, and its cable and baud rate"


def why_odd_values(config: LinkConfig, name: str, size: float) -> str:
    """Returns what is odd about a sensor's median specific force in m/s^2, or nothing."""
    if 0.5 < size < 2.0:
        what, unit = "g", "g"
    elif 300.0 < size < 3000.0:
        what, unit = "thousandths of g", "mg"
    elif size > 3000.0:
        what, unit = "raw counts", "raw"
    else:
        return ""
    rounded = float(f"{size:.2g}")  # so that the message stays the same
    advice = (
        f"set the option acceleration_unit={unit}" if config.driver == "text_line"
        else "check the device's unit and range"
    )  # fmt: skip
    return (
        f"{name} measures {rounded:g} m/s², and gravity alone is {_GRAVITY_MPS2}; its values look "
        f"like {what}: {advice}"
    )


def _understood_by(
    config: LinkConfig, arrived: Sequence[bytes], is_datagram: bool, drivers: tuple[str, ...]
) -> str:
    for driver in drivers:
        if driver != config.driver and _num_frames(driver, arrived, is_datagram) >= _SURE_FRAMES:
            return driver
    return ""


def _num_frames(driver: str, arrived: Sequence[bytes], is_datagram: bool) -> int:
    parser = StreamParser(driver)
    for data in arrived:
        parser.feed(data, "a:1" if is_datagram else None)
    counters: dict[str, Any] = parser.counters
    if driver == "slimevr":  # before a greeting nothing else counts
        return int(counters["frames"] + counters["unconfigured"]) if is_datagram else 0
    return int(counters["frames"])


def _other(data: bytes, config: LinkConfig, driver: str) -> str:
    shown = "" if is_text(data) else f" ({_shown(data)})"
    return (
        f"these look like {KINDS[driver]}{shown}; choose the protocol {driver} instead of "
        f"{config.driver}"
    )


def _shown(data: bytes) -> str:
    """The newest bytes, from the start of a message if that is known."""
    newest = data[-256:]
    at = next((newest.find(start) for start in _STARTS if start in newest), 0)
    return newest[at : at + _SHOWN_BYTES].hex(" ")


def _lines(arrived: Sequence[bytes], is_datagram: bool) -> list[str]:
    """The complete lines; a datagram always ends one."""
    text = b"".join(data if not is_datagram else data.rstrip(b"\n") + b"\n" for data in arrived)
    return text.decode("ascii", "replace").split("\n")[:-1]


def check_bandwidth(config: LinkConfig) -> None:
    """Raises ConfigError when a serial port's speed cannot carry the rate that is asked for."""
    default = driver_options(config.driver).get("rate_hz", ("", ""))[0]
    rate = config.options.get("rate_hz", default)
    if "://" in config.port or not config.baud or not rate:
        return
    rate_hz = float(rate)
    needed = rate_hz * _bytes_per_instant(config)
    if needed > config.baud / 10:
        raise ConfigError(
            f"{config.baud} baud carry {config.baud // 10} bytes a second, and {config.driver} "
            f"sends {needed:.0f} at {rate_hz:g} Hz; lower rate_hz or raise the baud rate"
        )


def _bytes_per_instant(config: LinkConfig) -> int:
    from .drivers import Encoder
    from .sample_log import SAMPLE

    count = int(config.options.get("num_sensors", "1"))
    samples = np.zeros(count, SAMPLE)
    samples["sensor"] = np.arange(count)
    samples["orientation"] = [1.0, 0.0, 0.0, 0.0]
    encoder = Encoder(config.driver, [str(i) for i in range(count)], config.options)
    return sum(map(len, encoder.encode(0.0, samples)))
