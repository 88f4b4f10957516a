# SPDX-License-Identifier: GPL-3.0-or-later
"""Decodes the bytes of a capture's links to samples, live or from the raw log."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from .config import CaptureConfig, LinkConfig
from .drivers import keep_alive_commands, make_parser, parsed, start_commands
from .sample_log import Samples
from .sensor_sites import SensorSites, sites_of

__all__ = ["Decoded", "Decoder", "Sensor"]

IDLE_S = 0.2
"""If the first byte arrives this long after the port was opened, it starts a message: devices send
a message without pauses, and adapters delay bytes by only about 20 ms."""
_BY_ARRIVAL = ("slimevr", "text_line")
"""Drivers whose sensors are known in the order in which they sent."""
MOVED_S = 1.0
"""An identity that was silent for so long and is on another port now was plugged in there."""


@dataclass
class Sensor:
    """A sensor of the capture."""

    link: int
    local: int
    """Its index among the link's sensors."""
    name: str
    identity: str
    """The same wherever and whenever it is plugged in: the device's own number, else that of its
    USB adapter, else its port."""
    is_shared: bool = False
    """Another sensor has the same identity."""
    num_missing: int = 0
    """Samples lost by the device's counter, while connected."""
    last_counter: int = -1
    last_arrival_ns: int = 0
    replaced_by: int | None = None
    """The number of the sensor that this one turned out to be."""


@dataclass(frozen=True)
class Decoded:
    """The result of decoding some bytes."""

    samples: Samples
    replies: tuple[bytes, ...] = ()
    has_news: bool = False
    """There is a new sensor or a new name of a sensor."""


class Decoder:
    """Decodes the links of a capture; sensors are numbered over all links as they appear."""

    def __init__(self, config: CaptureConfig) -> None:
        self._config = config
        self.sensors: list[Sensor] = []
        self._links = [_LinkDecoder(link) for link in config.links]

    def connected(self, link: int, now_ns: int, device: str = "") -> tuple[bytes, ...]:
        """The link was opened (again); returns the commands that start its device.

        device: what identifies its USB adapter, if there is one.
        """
        for sensor in self.sensors:
            if sensor.link == link:
                sensor.last_counter = -1
        return self._links[link].connected(now_ns, device)

    def interrupted(self) -> None:
        """Bytes are missing before the next ones."""
        for decoder in self._links:
            decoder.parser.interrupt()
        for sensor in self.sensors:
            sensor.last_counter = -1

    def keep_alive(self, link: int) -> tuple[bytes, ...]:
        """What must be sent to the link's device regularly."""
        return self._links[link].keep_alive

    def arrived(self, link: int, arrival_ns: int, data: bytes, sender: str = "") -> Decoded:
        """Decodes the next bytes of a link, or a datagram when there is a sender."""
        decoder = self._links[link]
        decoder.check_first_bytes(arrival_ns)
        samples = parsed(decoder.parser, data, sender)
        has_news = self._name_sensors(link, arrival_ns)
        samples["arrival_ns"] = arrival_ns
        if len(samples):
            samples["sensor"] = np.asarray(decoder.numbers, np.uint16)[samples["sensor"]]
            self._count_missing(samples, arrival_ns)
        return Decoded(samples, decoder.replies(), has_news)

    def counters(self, link: int) -> dict[str, int]:
        """The counters of the link's parser."""
        return dict(self._links[link].parser.counters)

    def message(self, link: int) -> str:
        """The last text message of the link's device."""
        return str(self._links[link].parser.last_message)

    def battery(self, number: int) -> float | None:
        """How full a sensor's battery is, in percent; None when it is not known."""
        sensor = self.sensors[number]
        percent = float(self._links[sensor.link].parser.sensor_batteries[sensor.local])
        return percent if np.isfinite(percent) else None

    def set_sites(self, site_of: Mapping[str, str]) -> CaptureConfig:
        """Says where sensors are worn, by their identities; returns the new configuration."""
        merged = {**self._config.site_of, **site_of}
        self._config = replace(self._config, site_of=merged)
        return self._config

    @property
    def sites(self) -> SensorSites:
        """Where the sensors are worn, as far as that is known."""
        identities = [(sensor.identity, sensor.name) for sensor in self.sensors]
        is_there = [sensor.replaced_by is None for sensor in self.sensors]
        return sites_of(identities, self._listed_order, self._config, is_there)

    @property
    def order(self) -> list[int]:
        """The sensors link by link, as each link's device has them."""
        sensors = self.sensors
        return sorted(range(len(sensors)), key=lambda i: (sensors[i].link, sensors[i].local))

    @property
    def _listed_order(self) -> list[int]:
        """The order that a list of sites refers to: the same whichever sensor sent first."""

        def key(number: int) -> tuple[int, list[tuple[int, str]], int]:
            sensor = self.sensors[number]
            comes_by_chance = self._config.links[sensor.link].driver in _BY_ARRIVAL
            return (
                sensor.link, _natural(sensor.identity) if comes_by_chance else [], sensor.local
            )  # fmt: skip

        return sorted(range(len(self.sensors)), key=key)

    def _name_sensors(self, link: int, arrival_ns: int) -> bool:
        """Returns whether there is a new sensor or name."""
        decoder = self._links[link]
        names = list(zip(decoder.parser.sensor_names, decoder.parser.sensor_ids, strict=True))
        if names == decoder.names:
            return False
        decoder.names = names
        for local, (name, own_id) in enumerate(names):
            identity = decoder.identity(local, name, own_id)
            if local == len(decoder.numbers):
                decoder.numbers.append(len(self.sensors))
                self.sensors.append(Sensor(link, local, name, ""))
            self._identify(decoder, local, name, identity, arrival_ns)
        return True

    def _identify(
        self, decoder: _LinkDecoder, local: int, name: str, identity: str, now_ns: int
    ) -> None:
        number = decoder.numbers[local]
        sensor = self.sensors[number]
        sensor.name = name
        if sensor.identity in (identity, f"{identity} at {decoder.where}"):
            return
        twin = next(
            (n for n, other in enumerate(self.sensors)
             if n != number and other.identity == identity and other.replaced_by is None),
            None,
        )  # fmt: skip
        if twin is None:
            sensor.identity = identity
            return
        if now_ns - self.sensors[twin].last_arrival_ns > MOVED_S * 1e9:
            decoder.numbers[local] = twin
            sensor.identity, sensor.replaced_by = identity, twin
            self.sensors[twin].link, self.sensors[twin].local = sensor.link, local
            self.sensors[twin].last_counter = -1
            return
        sensor.identity = f"{identity} at {decoder.where}"
        sensor.is_shared = self.sensors[twin].is_shared = True

    def _count_missing(self, samples: Samples, arrival_ns: int) -> None:
        for number, counter in zip(
            samples["sensor"].tolist(), samples["counter"].tolist(), strict=True
        ):
            sensor = self.sensors[number]
            if counter > sensor.last_counter >= 0:
                sensor.num_missing += counter - sensor.last_counter - 1
            sensor.last_counter = counter
            sensor.last_arrival_ns = arrival_ns


def _natural(text: str) -> list[tuple[int, str]]:
    """A key that puts mt_10 after mt_9."""
    parts: list[tuple[int, str]] = []
    digits = ""
    for letter in f"{text} ":
        if letter.isdigit():
            digits += letter
            continue
        if digits:
            parts.append((int(digits), ""))
            digits = ""
        parts.append((-1, letter))
    return parts


@dataclass
class _LinkDecoder:
    config: LinkConfig
    numbers: list[int] = field(default_factory=list)
    names: list[tuple[str, str]] = field(default_factory=list)
    _num_resets: int = 0
    _opened_ns: int | None = None
    """Until the first byte comes."""
    _device: str = ""

    def __post_init__(self) -> None:
        self.parser = make_parser(self.config.driver, self.config.options)
        self._commands = start_commands(self.config.driver, self.config.options)
        self.keep_alive = keep_alive_commands(self.config.driver, self.config.options)

    def connected(self, now_ns: int, device: str) -> tuple[bytes, ...]:
        self.parser.reset()
        self._opened_ns = now_ns
        self._device = device
        return self._commands

    @property
    def where(self) -> str:
        """The port, to tell devices apart that have the same number."""
        return self.config.port

    def identity(self, local: int, name: str, own_id: str) -> str:
        if own_id:
            return own_id
        port = self._device or self.config.port
        return port if local == 0 else f"{port}/{name}"

    def check_first_bytes(self, arrival_ns: int) -> None:
        if self._opened_ns is not None and arrival_ns - self._opened_ns > IDLE_S * 1e9:
            self.parser.begin_message()
        self._opened_ns = None

    def replies(self) -> tuple[bytes, ...]:
        replies = tuple(self.parser.pop_replies())
        resets = int(self.parser.counters.get("device_resets", 0))
        if resets > self._num_resets:
            self._num_resets = resets
            return (*replies, *self._commands)
        return replies
