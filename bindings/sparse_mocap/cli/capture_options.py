# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the commands for sensors."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from ..capture.client import CaptureClient
from ..capture.config import DEFAULT_BAUD, CaptureConfig, LinkConfig
from ..capture.drivers import driver_names
from ..capture.remembered_sites import remember_sites, remembered_sites
from .options import Decorator, SensorSite, Sites

__all__ = ["Span", "capture_options", "config_of", "remember"]


class Span(click.ParamType):  # type: ignore[type-arg]
    """A time span, as duration and begin."""

    name = "S@T"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, float]:
        """Returns begin and duration in s."""
        if isinstance(value, tuple):
            return value
        length, _, begin = str(value).partition("@")
        try:
            span = float(begin), float(length)
        except ValueError:
            self.fail(f"{value!r} is not S@T, such as 5@12.5 (5 s, starting at 12.5 s)", param, ctx)
        if not (span[0] >= 0 and span[1] >= 0):
            self.fail(f"{value!r} has a negative time", param, ctx)
        return span


class _Setting(click.ParamType):  # type: ignore[type-arg]
    """An option of a driver."""

    name = "NAME=VALUE"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, str]:
        """Returns name and value."""
        if isinstance(value, tuple):
            return value
        name, equals, text = str(value).partition("=")
        if not equals:
            self.fail(f"{value!r} is not NAME=VALUE", param, ctx)
        return name.strip(), text.strip()


_DRIVER_HELP = "The sensor protocol."

driver_option: Decorator = click.option(
    "--driver", type=click.Choice(driver_names()), required=True, help=_DRIVER_HELP
)


def _as_dictionary(
    _ctx: click.Context, _param: click.Parameter, value: tuple[tuple[str, str], ...]
) -> dict[str, str]:
    return dict(value)


driver_options_option: Decorator = click.option(
    "--option", "options", type=_Setting(), multiple=True, callback=_as_dictionary,
    help="An option of the driver. Can be repeated.",
)  # fmt: skip


def _as_sites(
    _ctx: click.Context, _param: click.Parameter, value: tuple[tuple[str, str], ...]
) -> dict[str, str]:
    sites = dict(value)
    for site in sites.values():
        twins = [name for name, other in sites.items() if other == site]
        if len(twins) > 1:
            raise click.BadParameter(f"{' and '.join(twins)} are both worn at {site}")
    return sites


def capture_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Adds the options of a capture."""
    for option in (
        click.option(
            "--sites", type=Sites(), default=None,
            help="Sensor locations, in the order of the ports and of the sensors' own numbers; "
            "--site is surer.",
        ),
        click.option(
            "--site", "site_of", type=SensorSite(), multiple=True, callback=_as_sites,
            help="Where a sensor is worn, by its name or number, as in 'DB0001=left_wrist'. Can be "
            "repeated; remembered for the next time.",
        ),
        driver_options_option,
        click.option(
            "--baud", type=click.IntRange(0, 4_000_000), default=DEFAULT_BAUD, show_default=True,
            help="Speed of the serial port, in bits per second; 0 tries the usual ones.",
        ),
        click.option(
            "--driver", "drivers", type=click.Choice(driver_names()), multiple=True,
            help=f"{_DRIVER_HELP} Can be repeated, one for each port. `sparse-mocap drivers` "
            "lists them.",
        ),
        click.option(
            "--port", "ports", metavar="PORT_OR_URL", multiple=True,
            help="A serial port, pyserial URL or udp://HOST:PORT. Can be repeated.",
        ),
    ):  # fmt: skip
        function = option(function)
    return function


def config_of(
    ports: tuple[str, ...],
    drivers: tuple[str, ...],
    baud: int,
    options: dict[str, str],
    sites: tuple[str, ...] | None,
    site_of: dict[str, str],
) -> CaptureConfig:
    """Returns the capture's configuration, with the remembered sensor locations.

    Raises UsageError when an option is missing.
    """
    if not ports:
        raise click.UsageError("Missing option '--port'.")
    if not drivers:
        raise click.UsageError("Missing option '--driver'.")
    if len(drivers) not in (1, len(ports)):
        raise click.UsageError("give one --driver for all ports, or one for each --port")
    own = drivers * len(ports) if len(drivers) == 1 else drivers
    links = tuple(
        LinkConfig(port, driver, baud, options) for port, driver in zip(ports, own, strict=True)
    )
    return CaptureConfig(links, sites or (), {**_remembered(site_of), **site_of})


def _remembered(given: dict[str, str]) -> dict[str, str]:
    """The remembered locations, but for those that another sensor is given now."""
    taken = set(given.values())
    return {name: site for name, site in remembered_sites().items() if site not in taken}


def remember(client: CaptureClient, site_of: dict[str, str]) -> None:
    """Remembers the locations that were given now, by the identities of the sensors."""
    if not site_of:
        return
    given = {name.casefold() for name in site_of}
    found = {
        sensor["identity"]: sensor["site"]
        for sensor in client.status()["sensors"]
        if {str(sensor[key]).casefold() for key in ("identity", "name")} & given
    }
    remember_sites({identity: site for identity, site in found.items() if site})
