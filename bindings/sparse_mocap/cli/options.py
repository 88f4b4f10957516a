# SPDX-License-Identifier: GPL-3.0-or-later
"""Options shared by several commands."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from pathlib import Path
from typing import Any

import click

from .. import method_names, noise_presets, preset_names, site_names

PAPER_SITES = "left_wrist,right_wrist,left_ankle,right_ankle"

FilePath = click.Path(path_type=Path)

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


class Sites(click.ParamType):  # type: ignore[type-arg]
    """A list of sensor locations, separated by commas."""

    name = "SITE,..."

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, ...]:
        """Returns the locations, all known and different."""
        if isinstance(value, tuple):
            return value
        sites = tuple(site.strip() for site in str(value).split(","))
        known = site_names()
        for site in sites:
            if site not in known:
                self.fail(
                    f"unknown sensor location {site!r}; choose from {', '.join(known)}", param, ctx
                )
        if len(set(sites)) < len(sites):
            self.fail("a sensor location is given twice", param, ctx)
        return sites


class Place(click.ParamType):  # type: ignore[type-arg]
    """A sensor location and the sensor's position along the bone."""

    name = "SITE=PLACE"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, float]:
        """Returns the location and the position along the bone."""
        if isinstance(value, tuple):
            return value
        site, _, text = str(value).partition("=")
        (site,) = Sites().convert(site, param, ctx)
        try:
            place = float(text)
        except ValueError:
            place = -1.0
        if not 0.0 <= place <= 1.0:
            self.fail(f"{text!r} is not a position from 0 (near the body) to 1", param, ctx)
        return site, place


class Span(click.ParamType):  # type: ignore[type-arg]
    """A time span of a take."""

    name = "FROM:TO"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, float]:
        """Returns from and to in seconds."""
        if isinstance(value, tuple):
            return value
        begin_text, _, end_text = str(value).partition(":")
        try:
            begin_s, end_s = float(begin_text), float(end_text)
        except ValueError:
            begin_s, end_s = 0.0, 0.0
        if not (begin_s < end_s and isfinite(begin_s) and isfinite(end_s)):
            self.fail(f"{value!r} is not FROM:TO in seconds, such as 2.5:10", param, ctx)
        return begin_s, end_s


place_option: Decorator = click.option(
    "--place", "places", type=Place(), multiple=True,
    help="Position of a sensor along its bone, from 0 (elbow, knee) to 1 (wrist, ankle; the"
    " default), as in left_ankle=0.4. Can be repeated.",
)  # fmt: skip

frame_option: Decorator = click.option(
    "--frame", type=click.Choice(["heading", "root", "world"]), default="heading",
    show_default=True,
    help="Frame of the positions: root position and heading removed, root position and full"
    " orientation removed, or world.",
)  # fmt: skip

noise_option: Decorator = click.option(
    "--noise", type=click.Choice(list(noise_presets())), default="none", show_default=True,
    help="Quality of the simulated sensors: ideal, research or consumer grade.",
)  # fmt: skip

seed_option: Decorator = click.option(
    "--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Seed of the noise."
)

method_option: Decorator = click.option(
    "--method", type=click.Choice(method_names()), default="tautges2011", show_default=True,
    help="The reconstruction method.",
)  # fmt: skip


def places_of(sites: Sequence[str], places: Sequence[tuple[str, float]]) -> list[float] | None:
    """Returns a position along the bone for each site; None if none is given."""
    named = dict(places)
    for site in named:
        if site not in sites:
            raise click.BadParameter(f"there is no sensor at {site}", param_hint="'--place'")
    return [named.get(site, 1.0) for site in sites] if named else None


def check_presets(method: str, presets: Sequence[str]) -> None:
    """Raises BadParameter when the method has no such preset."""
    known = preset_names(method)
    for preset in presets:
        if preset not in known:
            raise click.BadParameter(
                f"unknown preset {preset!r} of {method}; choose from {', '.join(known)}",
                param_hint="'--preset'",
            )


def check_ending(path: Path, *endings: str) -> str:
    """Returns the path's extension in lower case. Raises BadParameter for another one."""
    ending = path.suffix.lower()
    if ending not in endings:
        raise click.BadParameter(
            f"'{path}' must end in {' or '.join(endings)}", param_hint="'--output'"
        )
    return ending
