# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the commands for sensors."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from ..capture.config import DEFAULT_BAUD, CaptureConfig, LinkConfig
from ..capture.drivers import driver_names
from .options import Decorator, Sites

__all__ = ["Span", "capture_options", "config_of"]


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


def capture_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """Adds the options of a capture."""
    for option in (
        click.option(
            "--sites", type=Sites(), default=None,
            help="Sensor locations, in the order of the sensors.",
        ),
        driver_options_option,
        click.option(
            "--baud", type=click.IntRange(50, 4_000_000), default=DEFAULT_BAUD, show_default=True,
            help="Speed of the serial port, in bits per second.",
        ),
        click.option("--driver", type=click.Choice(driver_names()), help=_DRIVER_HELP),
        click.option(
            "--port", "ports", metavar="PORT_OR_URL", multiple=True,
            help="A serial port, pyserial URL or udp://HOST:PORT. Can be repeated.",
        ),
    ):  # fmt: skip
        function = option(function)
    return function


def config_of(
    ports: tuple[str, ...],
    driver: str | None,
    baud: int,
    options: dict[str, str],
    sites: tuple[str, ...] | None,
) -> CaptureConfig:
    """Returns the capture's configuration. Raises UsageError when an option is missing."""
    if not ports:
        raise click.UsageError("Missing option '--port'.")
    if driver is None:
        raise click.UsageError("Missing option '--driver'.")
    return CaptureConfig(
        tuple(LinkConfig(port, driver, baud, options) for port in ports), sites or ()
    )
