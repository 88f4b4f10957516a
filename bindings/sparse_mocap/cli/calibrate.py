# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap calibrate``: a take of guided movements into a calibration."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from rich.table import Table

from .. import guided_movements, read_take, standing_pose_names
from ..calibration import Calibration, Steps, assign_by_shaking, calibrate
from ..calibration_file import write_calibration
from ..take import Take
from .console import print_table, warn
from .options import FilePath, Sites, Span, check_ending, place_option

__all__ = ["Movement", "Shake", "calibrate_command"]


class Movement(click.ParamType):  # type: ignore[type-arg]
    """A guided movement and when it was made."""

    name = "NAME=FROM:TO"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, tuple[float, float]]:
        """Returns the movement's name and its span."""
        if isinstance(value, tuple):
            return value
        name, _, span = str(value).partition("=")
        if name not in guided_movements():
            known = ", ".join(guided_movements())
            self.fail(f"{name!r} is no guided movement; known are {known}", param, ctx)
        return name, Span().convert(span, param, ctx)


class Shake(click.ParamType):  # type: ignore[type-arg]
    """A site and when the sensor worn there was shaken."""

    name = "SITE=FROM:TO"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, tuple[float, float]]:
        """Returns the site and the span."""
        if isinstance(value, tuple):
            return value
        site, _, span = str(value).partition("=")
        (site,) = Sites().convert(site, param, ctx)
        return site, Span().convert(span, param, ctx)


@click.command()
@click.argument("take", metavar="TAKE.csv", type=FilePath)
@click.option("-o", "--output", type=FilePath, required=True, help="The calibration (.json).")
@click.option("--stand", type=Span(), required=True, help="When the wearer stood still (s).")
@click.option(
    "--pose", type=click.Choice(standing_pose_names()), default="arms_down", show_default=True,
    help="How: arms hanging with palms at the thighs, or a T-pose with palms down.",
)  # fmt: skip
@click.option("--arms", type=Span(), help="When both elbows were bent (as --move bend_elbows=...).")
@click.option("--legs", type=Span(), help="When the wearer squatted (as --move squat=...).")
@click.option(
    "--move", "moves", type=Movement(), multiple=True,
    help=f"When a guided movement was made: {', '.join(guided_movements())}. May be repeated.",
)  # fmt: skip
@click.option("--sites", type=Sites(), help="Where the take's sensors are worn, in its order.")
@click.option(
    "--shake", "shakes", type=Shake(), multiple=True,
    help="When only the sensor worn at a site was shaken: says which of the take's it is.",
)  # fmt: skip
@click.option(
    "--height", type=click.FloatRange(0.5, 2.5), default=1.75, show_default=True,
    help="The wearer's, in metres.",
)  # fmt: skip
@place_option
def calibrate_command(
    take: Path,
    output: Path,
    stand: tuple[float, float],
    pose: str,
    arms: tuple[float, float] | None,
    legs: tuple[float, float] | None,
    moves: tuple[tuple[str, tuple[float, float]], ...],
    sites: tuple[str, ...] | None,
    shakes: tuple[tuple[str, tuple[float, float]], ...],
    height: float,
    places: tuple[tuple[str, float], ...],
) -> None:
    """Finds how sensors are scaled, turned and placed.

    The wearer stands still, bends both elbows about five times with the upper arms at the sides and
    the thumbs forward, and squats about five times; or makes other guided movements (--move).
    What these do not determine is said and left as the site says.
    """
    check_ending(output, ".json")
    recorded = read_take(take)
    named = [("bend_elbows", arms), ("squat", legs)]
    steps = Steps(stand, (*((name, span) for name, span in named if span), *moves), pose)
    found = calibrate(
        recorded, steps, sites=_worn(recorded, sites, shakes), height_m=height, places=dict(places)
    )
    write_calibration(output, found)
    warn(found.notes)
    _tell(output, found)


def _worn(
    take: Take,
    sites: tuple[str, ...] | None,
    shakes: tuple[tuple[str, tuple[float, float]], ...],
) -> dict[str, str]:
    if sites is not None and len(sites) != len(take.sensors):
        raise click.BadParameter(
            f"the take has {len(take.sensors)} sensors: {', '.join(take.sensors)}",
            param_hint="'--sites'",
        )
    worn = dict(zip(take.sensors, sites, strict=True)) if sites else {}
    return worn | {assign_by_shaking(take, span): site for site, span in shakes}


def _tell(output: Path, found: Calibration) -> None:
    table = Table("sensor", "site", "at rest", "scale", "mounting", "place", "quality")
    for name, sensor in found.sensors.items():
        table.add_row(
            name,
            sensor.site,
            f"{sensor.gravity:.3f}",
            f"{sensor.scale:.4f}",
            f"axis {sensor.axis_ratio:.1f} to 1" if sensor.is_mounting_determined else "assumed",
            f"{sensor.place:.2f}" + ("" if sensor.is_place_determined else " assumed"),
            f"{sensor.quality:.2f}",
        )
    print_table(table)
    click.echo(f"{output}: {len(found.sensors)} sensors, quality {found.quality:.2f}")
