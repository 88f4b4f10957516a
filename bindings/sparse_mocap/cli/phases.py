# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap phases``: the parts that training divides clips into."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click
from rich.table import Table

from .. import clip_segments
from ..training import write_phases
from .console import print_table
from .options import OutputPath, check_ending, method_choice, set_option
from .training_clips import clip_options, training_clips

__all__ = ["phases"]


@click.command()
@clip_options
@click.option("--method", default="eom2014", show_default=True, help="The method to train.")
@set_option
@click.option(
    "-o", "--output", type=OutputPath(), metavar="FILE.csv",
    help="Write them to this file, to change them and give them to `train --phases`.",
)  # fmt: skip
def phases(
    chosen: Mapping[str, Any],
    method: str,
    settings: tuple[tuple[str, str], ...],
    output: Path | None,
) -> None:
    """Lists the phases of clips: when each begins, and its name.

    They are found by which foot leaves the floor. Move them by changing their times; names are
    standing, start, left_step, right_step, stop, jump.
    """
    if output is not None:
        check_ending(output, ".csv")
    choice = method_choice(method, None, settings)
    found = {
        clip.name: clip_segments(choice.method, clip, options=choice.options)
        for clip in training_clips(chosen, choice.options)
    }
    if output is not None:
        write_phases(output, found)
        click.echo(f"{output}: the phases of {len(found)} clips")
        return
    table = Table("clip", "from (s)", "phase", box=None, pad_edge=False)
    for name, segments in found.items():
        for begin_s, label in segments:
            table.add_row(name, f"{begin_s:.2f}", label)
    print_table(table)
