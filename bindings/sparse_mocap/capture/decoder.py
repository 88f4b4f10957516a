# SPDX-License-Identifier: GPL-3.0-or-later
"""Decodes the bytes of a capture's links to samples, live or from the raw log."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .config import CaptureConfig, LinkConfig
from .drivers import keep_alive_commands, make_parser, parsed, site_order, start_commands
from .sample_log import Samples

__all__ = ["Decoded", "Decoder", "Sensor"]

IDLE_S = 0.2
"""If the first byte arrives this long after the port was opened, it starts a message: devices send
a message without pauses, and adapters delay bytes by only about 20 ms."""


@dataclass
class Sensor:
    """A sensor of the capture."""

    link: int
    local: int
    """Its index among the link's sensors."""
    name: str
    num_missing: int = 0
    """Samples lost by the device's counter, while connected."""
    last_counter: int = -1


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

    def connected(self, link: int, now_ns: int) -> tuple[bytes, ...]:
        """The link was opened (again); returns the commands that start its device."""
        for sensor in self.sensors:
            if sensor.link == link:
                sensor.last_counter = -1
        return self._links[link].connected(now_ns)

    def interrupted(self) -> None:
        """Bytes are missing before the next ones."""
        for decoder in self._links:
            decoder.parser.interrupt()
        for sensor in self.sensors:
            sensor.last_counter = -1

    def keep_alive(self, link: int) -> tuple[bytes, ...]:
        """What must be sent to the link's device every second."""
        return self._links[link].keep_alive

    def arrived(self, link: int, arrival_ns: int, data: bytes, sender: str = "") -> Decoded:
        """Decodes the next bytes of a link, or a datagram when there is a sender."""
        decoder = self._links[link]
        decoder.check_first_bytes(arrival_ns)
        samples = parsed(decoder.parser, data, sender)
        has_news = self._name_sensors(link)
        samples["arrival_ns"] = arrival_ns
        if len(samples):
            samples["sensor"] = np.asarray(decoder.numbers, np.uint16)[samples["sensor"]]
            self._count_missing(samples)
        return Decoded(samples, decoder.replies(), has_news)

    def counters(self, link: int) -> dict[str, int]:
        """The counters of the link's parser."""
        return dict(self._links[link].parser.counters)

    def message(self, link: int) -> str:
        """The last text message of the link's device."""
        return str(self._links[link].parser.last_message)

    @property
    def sites(self) -> list[str]:
        """The sensors' locations: from the configuration, else from their names, else in order."""
        known = site_order()
        names = [sensor.name for sensor in self.sensors]
        by_name = [_site_in(name, known) for name in names]
        if not self._config.sites and all(by_name):
            return by_name
        wanted = [*self._config.sites, *(site for site in known if site not in self._config.sites)]
        sites = [""] * len(names)
        for rank, index in enumerate(self.order):
            sites[index] = wanted[rank] if rank < len(wanted) else names[index]
        return sites

    @property
    def order(self) -> list[int]:
        """The sensors link by link, whichever sent first."""
        sensors = self.sensors
        return sorted(range(len(sensors)), key=lambda i: (sensors[i].link, sensors[i].local))

    @property
    def are_sites_guessed(self) -> bool:
        """Whether the sensors' locations are only assumed from their order."""
        known = site_order()
        is_named = all(_site_in(sensor.name, known) for sensor in self.sensors)
        return not is_named and len(self._config.sites) < len(self.sensors)

    def _name_sensors(self, link: int) -> bool:
        """Returns whether there is a new sensor or name."""
        decoder = self._links[link]
        names = decoder.parser.sensor_names
        if names == decoder.names:
            return False
        decoder.names = names
        for local, name in enumerate(names):
            if local == len(decoder.numbers):
                decoder.numbers.append(len(self.sensors))
                self.sensors.append(Sensor(link, local, name))
            self.sensors[decoder.numbers[local]].name = name
        return True

    def _count_missing(self, samples: Samples) -> None:
        for number, counter in zip(
            samples["sensor"].tolist(), samples["counter"].tolist(), strict=True
        ):
            sensor = self.sensors[number]
            if counter > sensor.last_counter >= 0:
                sensor.num_missing += counter - sensor.last_counter - 1
            sensor.last_counter = counter


def _site_in(name: str, known: list[str]) -> str:
    """The site in a device's name, alone or before its number; empty without one."""
    first = name.partition(" ")[0]
    return first if first in known else ""


class _LinkDecoder:
    def __init__(self, config: LinkConfig) -> None:
        self.config = config
        self.parser = make_parser(config.driver, config.options)
        self.numbers: list[int] = []
        self.names: list[str] = []
        self._num_resets = 0
        self._opened_ns: int | None = None
        """Until the first byte comes."""
        self._commands = start_commands(config.driver, config.options)
        self.keep_alive = keep_alive_commands(config.driver, config.options)

    def connected(self, now_ns: int) -> tuple[bytes, ...]:
        self.parser.reset()
        self._opened_ns = now_ns
        return self._commands

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
