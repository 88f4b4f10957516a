# SPDX-License-Identifier: GPL-3.0-or-later
"""The protocols of sensors."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

SAMPLE_FLAGS: dict[str, int]
"""The bits of a sample's flags: clipped, after_gap, after_reset, gravity_restored."""

class StreamParser:
    """Turns a device's bytes into samples; options are those of driver_options. Thread-safe.

    Raises ConfigError for an unknown driver or option, naming the nearest, and for wrong values.
    """

    def __init__(self, driver: str, **options: object) -> None: ...
    def feed(self, data: bytes, sender: str | None = None) -> dict[str, NDArray[np.generic]]:
        """The samples (N) that the bytes complete, however they are cut; NaN for what is absent.

        ``sensor`` (N,) index into sensor_names; ``time_s`` (N,) the device's clock, unwrapped;
        ``counter`` (N,) unwrapped, -1 for none; ``specific_force`` (N, 3) m/s^2;
        ``angular_velocity`` (N, 3) rad/s; ``orientation`` (N, 4) R_world_sensor, world y up;
        ``magnetic_field`` (N, 3) in the device's unit; ``flags`` (N,) of SAMPLE_FLAGS.
        With a sender the data are one datagram.
        """
    def reset(self) -> None:
        """The connection was reopened: sensors keep their indices, counters continue."""
    def begin_message(self) -> None:
        """After reset: the line was idle for so long that the next byte begins a message."""
    def interrupt(self) -> None:
        """Bytes are missing before the next ones: an incomplete message is dropped."""
    def pop_replies(self) -> list[bytes]:
        """The answers that the protocol expects, each once."""
    @property
    def counters(self) -> dict[str, int]:
        """What was received and what was lost, each kind by its name."""
    @property
    def sensor_ids(self) -> list[str]:
        """What each device calls itself wherever it is plugged in; empty without such."""
    @property
    def sensor_batteries(self) -> list[float]:
        """How full each battery is, in percent; NaN while it is not known."""
    @property
    def sensor_names(self) -> list[str]:
        """The sensors seen so far, in the order of their indices."""
    @property
    def last_message(self) -> str:
        """The last text from the device, such as an error."""

class StreamEncoder:
    """What a device with these sensors would send."""

    def __init__(self, driver: str, sensor_names: Sequence[str], **options: object) -> None: ...
    def hello(self) -> list[bytes]:
        """What the device sends when it starts."""
    def encode(
        self,
        time_s: float,
        counter: int,
        specific_force: ArrayLike,
        angular_velocity: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
        sensors: Sequence[int] | None = None,
    ) -> list[bytes]:
        """The packets of one instant: (S, 3) m/s^2, (S, 3) rad/s, (S, 4) R_world_sensor.

        sensors: whose rows these are; all sensors' when None.
        """
    def respond(self, from_host: bytes) -> bytes:
        """What the device answers to what a host sends it."""

def driver_names() -> list[str]:
    """The protocols that StreamParser takes."""

def driver_options(driver: str) -> dict[str, tuple[str, str]]:
    """Each option's default and what it means."""

def start_commands(driver: str, **options: object) -> list[bytes]:
    """What makes the device stream, to be sent one after the other."""

def keep_alive_commands(driver: str, **options: object) -> list[bytes]:
    """What must be sent every second to keep the device streaming."""
