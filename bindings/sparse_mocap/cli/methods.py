# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap methods``: lists the methods and their options."""

from __future__ import annotations

import json

import click
from rich.table import Table

from .._core import method_infos
from ..methods import MethodInfo, method_info
from ..methods import methods as all_methods
from .console import print_table

__all__ = ["methods"]


@click.command()
@click.argument("name", required=False)
@click.option("--json", "as_json", is_flag=True, help="Print everything as JSON.")
def methods(name: str | None, as_json: bool) -> None:
    """Lists the reconstruction methods, or shows one with its options.

    In `reconstruct`, `live` and `evaluate`, --method NAME chooses a method and --set KEY=VALUE sets
    its options.
    """
    chosen = all_methods() if name is None else (method_info(name),)
    if as_json:
        wanted = {method.name for method in chosen}
        found = [method for method in method_infos() if method["name"] in wanted]
        click.echo(json.dumps(found, indent=2))
    elif name is None:
        print_table(_overview(chosen))
        click.echo("\n`sparse-mocap methods NAME` shows a method's options.")
    else:
        _show(chosen[0])


def _overview(found: tuple[MethodInfo, ...]) -> Table:
    table = Table("method", "sensors", "needs", "quality", "", box=None, pad_edge=False)
    for method in found:
        table.add_row(
            method.name, _sensors(method), _needs(method), _quality(method), method.summary
        )
    return table


def _show(method: MethodInfo) -> None:
    click.echo(f"{method.name}: {method.title}\n{method.summary}")
    if method.paper:
        click.echo(method.paper)
    needed = [*method.required_channels, " or ".join(method.one_channel_of)]
    click.echo(f"Sensors: {_sensors(method)}, each with {', '.join(filter(None, needed))}")
    if method.optional_channels:
        click.echo(f"Also uses, if available: {', '.join(method.optional_channels)}")
    click.echo(f"Needs: {_needs(method)}. Quality: {_quality(method)}.")
    for preset in method.presets:
        click.echo(f"--preset {preset.name}: {preset.help}")
    for experiment in method.experiments:
        click.echo(f"evaluate --experiment {experiment.name}: {experiment.help}")
    table = Table("--set", "default", "range", "", box=None, pad_edge=False)
    for option in method.options:
        table.add_row(option.name, option.default, option.possible_values, option.help)
    print_table(table)


def _sensors(method: MethodInfo) -> str:
    if method.fewest_sensors == method.most_sensors:
        return str(method.most_sensors)
    return f"{method.fewest_sensors} to {method.most_sensors}"


def _needs(method: MethodInfo) -> str:
    return ", ".join(method.needs) or "nothing"


def _quality(method: MethodInfo) -> str:
    return ", ".join(["live"] * method.works_live + ["best"] * method.works_on_whole_takes)
