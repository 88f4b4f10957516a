# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap calibrate``: makes a calibration from a take of guided movements."""

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
from .options import FilePath, Sites, Span, check_ending, position_along_bone_option

__all__ = ["Movement", "Shake", "calibrate_command"]


class Movement(click.ParamType):  # type: ignore[type-arg]
    """A guided movement and its time span."""

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
            self.fail(f"unknown guided movement {name!r}; choose from {known}", param, ctx)
        return name, Span().convert(span, param, ctx)


class Shake(click.ParamType):  # type: ignore[type-arg]
    """A sensor location and when the sensor there was shaken."""

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
@click.option(
    "-o", "--output", type=FilePath, required=True, help="The calibration file to write (.json)."
)
@click.option("--stand", type=Span(), required=True, help="When the performer stood still, in s.")
@click.option(
    "--pose", type=click.Choice(standing_pose_names()), default="arms_down", show_default=True,
    help="The pose for --stand: arms hanging with palms at the thighs, or T-pose with palms down.",
)  # fmt: skip
@click.option(
    "--arms", type=Span(), help="When both elbows were bent (same as --move bend_elbows=...)."
)
@click.option("--legs", type=Span(), help="When the performer squatted (same as --move squat=...).")
@click.option(
    "--move", "moves", type=Movement(), multiple=True,
    help=f"When a guided movement was made: {', '.join(guided_movements())}. Can be repeated.",
)  # fmt: skip
@click.option("--sites", type=Sites(), help="Sensor locations, in the take's order.")
@click.option(
    "--shake", "shakes", type=Shake(), multiple=True,
    help="When only the sensor at this location was shaken, to identify it. Can be repeated.",
)  # fmt: skip
@click.option(
    "--height", type=click.FloatRange(0.5, 2.5), default=1.75, show_default=True,
    help="Body height of the performer, in metres.",
)  # fmt: skip
@position_along_bone_option
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
    positions_along_bone: tuple[tuple[str, float], ...],
) -> None:
    """Finds the scale, orientation and position of the sensors on the body.

    The performer stands still, bends both elbows about five times with the upper arms at the sides
    and the thumbs forward, and squats about five times; or makes other guided movements (--move).
    Values that these movements do not determine are reported and keep their defaults.
    """
    check_ending(output, ".json")
    recorded = read_take(take)
    named = [("bend_elbows", arms), ("squat", legs)]
    steps = Steps(stand, (*((name, span) for name, span in named if span), *moves), pose)
    found = calibrate(
        recorded,
        steps,
        sites=_located(recorded, sites, shakes),
        height_m=height,
        positions=dict(positions_along_bone),
    )
    write_calibration(output, found)
    warn(found.notes)
    _print(output, found)


def _located(
    take: Take,
    sites: tuple[str, ...] | None,
    shakes: tuple[tuple[str, tuple[float, float]], ...],
) -> dict[str, str]:
    if sites is not None and len(sites) != len(take.sensors):
        raise click.BadParameter(
            f"give one location for each sensor of the take: {', '.join(take.sensors)}",
            param_hint="'--sites'",
        )
    located = dict(zip(take.sensors, sites, strict=True)) if sites else {}
    return located | {assign_by_shaking(take, span): site for site, span in shakes}


def _print(output: Path, found: Calibration) -> None:
    table = Table("sensor", "location", "at rest", "scale", "mounting", "along bone", "quality")
    for name, sensor in found.sensors.items():
        table.add_row(
            name,
            sensor.site,
            f"{sensor.gravity:.3f}",
            f"{sensor.scale:.4f}",
            f"axis {sensor.axis_ratio:.1f} to 1" if sensor.is_mounting_determined else "assumed",
            f"{sensor.position_along_bone:.2f}"
            + ("" if sensor.is_position_determined else " assumed"),
            f"{sensor.quality:.2f}",
        )
    print_table(table)
    click.echo(f"{output}: {len(found.sensors)} sensors, quality {found.quality:.2f}")
