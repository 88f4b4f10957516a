# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap import``: converts recordings of other programs to takes."""

from __future__ import annotations

from pathlib import Path

import click

from .. import site_names, write_take
from ..imports import read_recording, recording_formats
from ..take import devices_of
from ..take_file import device_comment
from .console import warn
from .options import FilePath, SensorSite, check_ending

__all__ = ["import_recording"]


@click.command(
    name="import", help=f"Converts a recording to a take: {', '.join(recording_formats())}."
)
@click.argument("recording", metavar="RECORDING", type=FilePath)
@click.option("-o", "--output", type=FilePath, required=True, help="The take file to write (.csv).")
@click.option(
    "--site", "sites", type=SensorSite(), multiple=True,
    help="Location of a sensor, as in 'Right Foot=right_ankle'. Can be repeated; other sensors keep"
    " their names.",
)  # fmt: skip
def import_recording(recording: Path, output: Path, sites: tuple[tuple[str, str], ...]) -> None:
    """Converts a recording to a take."""
    check_ending(output, ".csv")
    take = read_recording(recording, dict(sites))
    write_take(output, take)
    named = {device_comment(*pair) for pair in devices_of(take).items()}
    for comment in take.comments:
        if comment not in named:
            click.echo(comment)
    for name, record in take.sensors.items():
        click.echo(f"{name}: {len(record.times_s)} samples, {record.times_s[-1]:.2f} s")
    unnamed = [name for name in take.sensors if name not in site_names()]
    if unnamed:
        warn([f"no location given for {', '.join(unnamed)}; add --site '{unnamed[0]}=SITE'"])
