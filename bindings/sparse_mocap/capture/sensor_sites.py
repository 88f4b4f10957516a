# SPDX-License-Identifier: GPL-3.0-or-later
"""Which sensor is worn where: by the device's identity, never by the order of arrival."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .. import site_names
from .config import CaptureConfig

__all__ = ["SensorSites", "sites_of"]

_LONGEST_NAME = 60  # in a take file; the end of a long port tells it from others


@dataclass(frozen=True)
class SensorSites:
    """The sites of a capture's sensors, in the order of their numbers."""

    sites: tuple[str, ...]
    """Empty for a sensor without one, or whose site another has too."""
    conflicts: tuple[str, ...]
    """One line for each site that several sensors have."""
    unknown: tuple[str, ...]
    """Names that were given a site and that no sensor has."""

    def name(self, number: int, identity: str) -> str:
        """A sensor's name in a take: its site, else its identity."""
        return self.sites[number] or identity.replace(",", " ").strip()[-_LONGEST_NAME:]


def sites_of(
    sensors: Sequence[tuple[str, str]],
    order: Sequence[int],
    config: CaptureConfig,
    is_there: Sequence[bool],
) -> SensorSites:
    """Returns the sites of sensors by identity and name.

    A site that was given for the identity or name counts, else the name itself if it is a site,
    else the configuration's list of sites in this order. Two sensors at one site get none.
    """
    given = {key.casefold(): site for key, site in config.site_of.items()}
    listed = dict(zip([i for i in order if is_there[i]], config.sites, strict=False))
    wanted = [
        _wanted(identity, name, given, listed.get(i, "")) if is_there[i] else ""
        for i, (identity, name) in enumerate(sensors)
    ]
    conflicts = []
    for site in dict.fromkeys(site for site in wanted if wanted.count(site) > 1 and site):
        twins = " and ".join(
            identity for (identity, _), own in zip(sensors, wanted, strict=True) if own == site
        )
        conflicts.append(f"{twins} are both worn at {site}; choose another location for one")
    sites = tuple("" if site and wanted.count(site) > 1 else site for site in wanted)
    names = {text.casefold() for pair in sensors for text in pair}
    unknown = tuple(key for key in config.site_of if key.casefold() not in names)
    return SensorSites(sites, tuple(conflicts), unknown)


def _wanted(identity: str, name: str, given: dict[str, str], listed: str) -> str:
    first = name.partition(" ")[0]
    for key in (identity, name, first):
        if key.casefold() in given:
            return given[key.casefold()]
    return listed or (first if first in site_names() else "")
