# SPDX-License-Identifier: GPL-3.0-or-later
"""The configuration of a capture."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

__all__ = ["CaptureConfig", "LinkConfig"]

DEFAULT_BAUD = 115200
CONFIG_NAME = "config.json"


@dataclass(frozen=True)
class LinkConfig:
    """One port and the driver for the protocol of its sensors."""

    port: str
    driver: str
    baud: int = DEFAULT_BAUD
    """0: the usual ones are tried in turn until there are samples."""
    options: Mapping[str, str] = field(default_factory=dict)
    """Options of the driver."""


@dataclass(frozen=True)
class CaptureConfig:
    """The links of a capture and when it ends."""

    links: tuple[LinkConfig, ...]
    sites: tuple[str, ...] = ()
    """Sensor locations, in the order of the links and of each link's sensors: as its device numbers
    them, else by their identities."""
    site_of: Mapping[str, str] = field(default_factory=dict)
    """Sensor locations by the sensors' identities or names; they win over sites."""
    linger_s: float = 5.0
    """The capture ends after this time without clients and recordings."""
    must_record: bool = False
    """Record from the first byte on."""
    is_temporary: bool = False
    """Remove the folder at the end if nothing was recorded."""

    def as_json(self) -> dict[str, Any]:
        """As a JSON object."""
        return asdict(self)

    @staticmethod
    def from_json(value: Mapping[str, Any]) -> CaptureConfig:
        """The opposite of as_json."""
        links = tuple(LinkConfig(**link) for link in value["links"])
        return CaptureConfig(**{**value, "links": links, "sites": tuple(value["sites"])})
