# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap drivers``: the sensor protocols and their options."""

from __future__ import annotations

import click
from rich.table import Table

from .. import driver_options
from ..capture.driver_guide import GUIDES, sketch, sketch_names
from ..capture.drivers import driver_names
from .console import print_table

__all__ = ["drivers"]


@click.command()
@click.argument("name", required=False, type=click.Choice(driver_names()))
@click.option(
    "--sketch", "sketch_name", type=click.Choice(sketch_names()),
    help="Print a sketch for a microcontroller, which text_line reads.",
)  # fmt: skip
def drivers(name: str | None, sketch_name: str | None) -> None:
    """Lists the drivers (sensor protocols), or shows one with all its options.

    In `record` and `live`, --driver NAME chooses a driver and --option KEY=VALUE sets its options.
    """
    if sketch_name is not None:
        click.echo(sketch(sketch_name), nl=False)
    elif name is None:
        table = Table("driver", "for", box=None, pad_edge=False)
        for known in driver_names():
            table.add_row(known, GUIDES[known].devices)
        print_table(table)
        click.echo("\n`sparse-mocap drivers NAME` shows a driver's options.")
    else:
        _show(name)


def _show(name: str) -> None:
    guide = GUIDES[name]
    click.echo(f"{name}: {guide.devices}\n\n  sparse-mocap record {guide.example} -o take.csv\n")
    for note in guide.notes:
        click.echo(f"- {note}")
    table = Table("--option", "default", "", box=None, pad_edge=False)
    for option, (default, description) in driver_options(name).items():
        table.add_row(option, default or "(empty)", description)
    print_table(table)
