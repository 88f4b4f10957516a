# SPDX-License-Identifier: GPL-3.0-or-later
"""Options that several commands share."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from math import isfinite
from pathlib import Path
from typing import Any

import click

from .. import method_names, noise_presets, preset_names, site_names
from .console import warn

PAPER_SITES = "left_wrist,right_wrist,left_ankle,right_ankle"

FilePath = click.Path(path_type=Path)

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


class Sites(click.ParamType):  # type: ignore[type-arg]
    """A list of sensors' sites, separated by commas."""

    name = "SITE,..."

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, ...]:
        """Returns the sites, all known and different."""
        if isinstance(value, tuple):
            return value
        sites = tuple(site.strip() for site in str(value).split(","))
        known = site_names()
        for site in sites:
            if site not in known:
                self.fail(f"{site!r} is no site; known are {', '.join(known)}", param, ctx)
        if len(set(sites)) < len(sites):
            self.fail("a site is named twice", param, ctx)
        return sites


class PositionAlongBone(click.ParamType):  # type: ignore[type-arg]
    """A site and where along its bone the sensor sits."""

    name = "SITE=X"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, float]:
        """Returns the site and the position."""
        if isinstance(value, tuple):
            return value
        site, _, text = str(value).partition("=")
        (site,) = Sites().convert(site, param, ctx)
        try:
            position = float(text)
        except ValueError:
            position = -1.0
        if not 0.0 <= position <= 1.0:
            self.fail(f"{text!r} is not a number from 0 (nearer the body) to 1", param, ctx)
        return site, position


class Span(click.ParamType):  # type: ignore[type-arg]
    """A stretch of a take."""

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
            self.fail(f"{value!r} is no FROM:TO in seconds, as in 2.5:10", param, ctx)
        return begin_s, end_s


def _position_option(name: str) -> Decorator:
    """Gives a command the parameter ``name``: sites and positions along their bones.

    --place is what older scripts call it.
    """

    def decorate(command: Callable[..., Any]) -> Callable[..., Any]:
        @functools.wraps(command)
        def with_old_name(*args: Any, place: tuple[tuple[str, float], ...], **more: Any) -> Any:
            if place:
                said = " ".join(f"--position-along-bone {site}={x:g}" for site, x in place)
                warn([f"--place is now called --position-along-bone: write {said}"])
                more[name] = (*more[name], *place)
            return command(*args, **more)

        option = click.option(
            "--position-along-bone", name, type=PositionAlongBone(), multiple=True,
            help="Where along its bone a sensor sits, from 0 (elbow, knee) to 1 (wrist, ankle; the"
            " default): left_ankle=0.4 is nearer the knee. May be repeated.",
        )  # fmt: skip
        old = click.option("--place", type=PositionAlongBone(), multiple=True, hidden=True)
        return option(old(with_old_name))

    return decorate


position_along_bone_option: Decorator = _position_option("positions_along_bone")
place_option: Decorator = _position_option("places")

frame_option: Decorator = click.option(
    "--frame", type=click.Choice(["heading", "root", "world"]), default="heading",
    show_default=True,
    help="What positions are relative to: root position and heading, root position and"
    " orientation, or the world.",
)  # fmt: skip

noise_option: Decorator = click.option(
    "--noise", type=click.Choice(list(noise_presets())), default="none", show_default=True,
    help="How far the simulated sensors are from ideal ones.",
)  # fmt: skip

seed_option: Decorator = click.option(
    "--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Seed of the noise."
)

method_option: Decorator = click.option(
    "--method", type=click.Choice(method_names()), default="tautges2011", show_default=True,
    help="The published method that is used.",
)  # fmt: skip


def positions_along_bone_of(
    sites: Sequence[str], positions: Sequence[tuple[str, float]]
) -> list[float] | None:
    """Returns a position for each site, None when none is named. Raises BadParameter."""
    named = dict(positions)
    for site in named:
        if site not in sites:
            raise click.BadParameter(
                f"no sensor is at {site}", param_hint="'--position-along-bone'"
            )
    return [named.get(site, 1.0) for site in sites] if named else None


places_of = positions_along_bone_of


def check_presets(method: str, presets: Sequence[str]) -> None:
    """Raises BadParameter when the method has no such preset."""
    known = preset_names(method)
    for preset in presets:
        if preset not in known:
            raise click.BadParameter(
                f"{preset!r} is no preset of {method}; known are {', '.join(known)}",
                param_hint="'--preset'",
            )


def check_ending(path: Path, *endings: str) -> str:
    """Returns the path's ending in lower case. Raises BadParameter when it is another."""
    ending = path.suffix.lower()
    if ending not in endings:
        raise click.BadParameter(
            f"'{path}' must end in {' or '.join(endings)}", param_hint="'--output'"
        )
    return ending
