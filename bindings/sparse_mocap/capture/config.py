# SPDX-License-Identifier: GPL-3.0-or-later
"""What a capture is asked to do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

__all__ = ["CaptureConfig", "LinkConfig"]

DEFAULT_BAUD = 115200
CONFIG_NAME = "config.json"


@dataclass(frozen=True)
class LinkConfig:
    """One port and the protocol that is spoken there."""

    port: str
    driver: str
    baud: int = DEFAULT_BAUD
    options: Mapping[str, str] = field(default_factory=dict)
    """The driver's."""


@dataclass(frozen=True)
class CaptureConfig:
    """The links of a capture and how it ends."""

    links: tuple[LinkConfig, ...]
    sites: tuple[str, ...] = ()
    """Where the sensors are worn, in the order of the capture's sensors; empty: by their names."""
    linger_s: float = 5.0
    """Without a client and without a recording the capture ends after this time."""
    must_record: bool = False
    """The capture records from the first byte on."""
    is_temporary: bool = False
    """The capture removes its folder when it ends and nothing was recorded."""

    def as_json(self) -> dict[str, Any]:
        """As JSON has it."""
        return asdict(self)

    @staticmethod
    def from_json(value: Mapping[str, Any]) -> CaptureConfig:
        """The opposite of as_json."""
        links = tuple(LinkConfig(**link) for link in value["links"])
        return CaptureConfig(**{**value, "links": links, "sites": tuple(value["sites"])})
