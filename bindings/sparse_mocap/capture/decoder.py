# SPDX-License-Identifier: GPL-3.0-or-later
"""From the bytes of a capture's links to samples, as they come or from the raw log."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .config import CaptureConfig, LinkConfig
from .drivers import keep_alive_commands, make_parser, parsed, site_order, start_commands
from .sample_log import Samples

__all__ = ["Decoded", "Decoder", "Sensor"]

IDLE_S = 0.2
"""A port without a byte for this long after it was opened was not opened amid a message: devices
send a message in one go, adapters hold bytes back for some 20 ms."""


@dataclass
class Sensor:
    """A sensor of the capture."""

    link: int
    local: int
    """Its index among the link's sensors."""
    name: str
    num_missing: int = 0
    """Samples that the device counted and that never came, while the connection stood."""
    last_counter: int = -1


@dataclass(frozen=True)
class Decoded:
    """What some bytes were."""

    samples: Samples
    replies: tuple[bytes, ...] = ()
    has_news: bool = False
    """A sensor was met or named anew."""


class Decoder:
    """Decodes the links of a capture; sensors are numbered over all links as they are met."""

    def __init__(self, config: CaptureConfig) -> None:
        self._config = config
        self.sensors: list[Sensor] = []
        self._links = [_LinkDecoder(link) for link in config.links]

    def connected(self, link: int, now_ns: int) -> tuple[bytes, ...]:
        """The link was opened anew; returns the commands that start its device."""
        for sensor in self.sensors:
            if sensor.link == link:
                sensor.last_counter = -1
        return self._links[link].connected(now_ns)

    def interrupted(self) -> None:
        """What comes next is not what followed."""
        for of_link in self._links:
            of_link.parser.interrupt()
        for sensor in self.sensors:
            sensor.last_counter = -1

    def keep_alive(self, link: int) -> tuple[bytes, ...]:
        """What the link's device wants to hear every second."""
        return self._links[link].keep_alive

    def arrived(self, link: int, arrival_ns: int, data: bytes, sender: str = "") -> Decoded:
        """Decodes the next bytes of a link, or a datagram when there is a sender."""
        of_link = self._links[link]
        of_link.heard(arrival_ns)
        samples = parsed(of_link.parser, data, sender)
        has_news = self._name_sensors(link)
        samples["arrival_ns"] = arrival_ns
        if len(samples):
            samples["sensor"] = np.asarray(of_link.numbers, np.uint16)[samples["sensor"]]
            self._count_missing(samples)
        return Decoded(samples, of_link.replies(), has_news)

    def counters(self, link: int) -> dict[str, int]:
        """What the link's parser counted."""
        return dict(self._links[link].parser.counters)

    def message(self, link: int) -> str:
        """What the link's device told last in words."""
        return str(self._links[link].parser.last_message)

    @property
    def sites(self) -> list[str]:
        """Where each sensor is worn: as the configuration says, or by its name, or in order."""
        known = site_order()
        names = [sensor.name for sensor in self.sensors]
        told = [_site_in(name, known) for name in names]
        if not self._config.sites and all(told):
            return told
        wanted = [*self._config.sites, *(site for site in known if site not in self._config.sites)]
        sites = [""] * len(names)
        for place, index in enumerate(self.order):
            sites[index] = wanted[place] if place < len(wanted) else names[index]
        return sites

    @property
    def order(self) -> list[int]:
        """The sensors link by link, so that it does not matter who was heard first."""
        sensors = self.sensors
        return sorted(range(len(sensors)), key=lambda i: (sensors[i].link, sensors[i].local))

    @property
    def are_sites_guessed(self) -> bool:
        """Whether nobody said where the sensors are worn."""
        known = site_order()
        is_named = all(_site_in(sensor.name, known) for sensor in self.sensors)
        return not is_named and len(self._config.sites) < len(self.sensors)

    def _name_sensors(self, link: int) -> bool:
        """Returns whether anything is new."""
        of_link = self._links[link]
        names = of_link.parser.sensor_names
        if names == of_link.names:
            return False
        of_link.names = names
        for local, name in enumerate(names):
            if local == len(of_link.numbers):
                of_link.numbers.append(len(self.sensors))
                self.sensors.append(Sensor(link, local, name))
            self.sensors[of_link.numbers[local]].name = name
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
    """The site that a device is called by, alone or before its number; empty when by none."""
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

    def heard(self, arrival_ns: int) -> None:
        if self._opened_ns is not None and arrival_ns - self._opened_ns > IDLE_S * 1e9:
            self.parser.begin_message()
        self._opened_ns = None

    def replies(self) -> tuple[bytes, ...]:
        replies = tuple(self.parser.take_replies())
        resets = int(self.parser.counters.get("device_resets", 0))
        if resets > self._num_resets:
            self._num_resets = resets
            return (*replies, *self._commands)
        return replies
