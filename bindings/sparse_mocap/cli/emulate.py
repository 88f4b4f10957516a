# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap emulate``: a take, spoken by a device that is not there."""

from __future__ import annotations

from pathlib import Path

import click

from .. import noise_presets, noisy, read_take
from ..capture.emulator import Emulator, Faults
from .capture_options import Span, driver_option, driver_options_option
from .console import interrupted
from .options import FilePath, noise_option

__all__ = ["emulate"]


@click.command()
@click.argument("take_path", metavar="TAKE.csv", type=FilePath)
@driver_option
@driver_options_option
@click.option(
    "--speed", type=click.FloatRange(0.01, 1000), default=1.0, show_default=True,
    help="How much faster than performed; a protocol without the device's time needs 1.",
)  # fmt: skip
@click.option("--link", type=FilePath, help="Keeps a symbolic link at the pseudo-terminal.")
@click.option("--loop", is_flag=True, help="Plays the take again and again.")
@noise_option
@click.option("--loss", type=click.FloatRange(0, 1), default=0.0, help="Part of packets left out.")
@click.option(
    "--corrupt", type=click.FloatRange(0, 1), default=0.0, help="Part of bytes that are changed."
)
@click.option("--cut-after", type=click.FloatRange(0), help="Unplugs the device, in s.")
@click.option(
    "--replug-after", type=click.FloatRange(0),
    help="Plugs it in again so much later, in s, as another pseudo-terminal.",
)  # fmt: skip
@click.option("--stall", "stalls", type=Span(), multiple=True, help="Silent for S s from T on.")
@click.option("--reset-at", "resets", type=click.FloatRange(0), multiple=True, help="Starts anew.")
@click.option("--garbage", type=Span(), multiple=True, help="Random bytes for S s from T on.")
@click.option("--duplicate-id", is_flag=True, help="The second sensor has the first one's id.")
@click.option(
    "--seed", type=click.IntRange(0), default=0, show_default=True, help="Seed of chance."
)
def emulate(
    take_path: Path,
    driver: str,
    options: dict[str, str],
    speed: float,
    link: Path | None,
    loop: bool,
    noise: str,
    loss: float,
    corrupt: float,
    cut_after: float | None,
    replug_after: float | None,
    stalls: tuple[tuple[float, float], ...],
    resets: tuple[float, ...],
    garbage: tuple[tuple[float, float], ...],
    duplicate_id: bool,
    seed: int,
) -> None:
    """Speaks a device's protocol over a pseudo-terminal, from a take.

    Prints the pseudo-terminal's path on the first line (a line for each sensor, where a port
    carries one only), plays the take from the moment a program opens it, and ends with it.
    """
    take = noisy(read_take(take_path), noise_presets()[noise], seed)
    faults = Faults(
        loss, corrupt, cut_after, replug_after, stalls, resets, garbage, duplicate_id, seed
    )
    emulator = Emulator(take, driver, options, speed, faults, link)
    with interrupted() as stop:
        _tell(emulator.plug_in())
        try:
            while True:
                emulator.run(stop.is_set, _tell)
                if not loop or stop.is_set():
                    break
        finally:
            emulator.close()
    lost = f", {emulator.num_overrun} not fetched in time" if emulator.num_overrun else ""
    click.echo(f"sent {emulator.num_sent} packets{lost}", err=True)


def _tell(paths: list[str]) -> None:
    for path in paths:
        click.echo(path)
