# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap emulate``: plays a take as a device would send it."""

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
    help="Playback speed; protocols without device time need 1.",
)  # fmt: skip
@click.option("--link", type=FilePath, help="Create a symbolic link to the pseudo-terminal.")
@click.option("--loop", is_flag=True, help="Repeat the take until Ctrl-C.")
@noise_option
@click.option("--loss", type=click.FloatRange(0, 1), default=0.0, help="Fraction of packets lost.")
@click.option(
    "--corrupt", type=click.FloatRange(0, 1), default=0.0, help="Fraction of bytes changed."
)
@click.option(
    "--cut-after", type=click.FloatRange(0), help="Unplug the device after this time, in s."
)
@click.option(
    "--replug-after", type=click.FloatRange(0),
    help="Plug it in again this much later, in s, as another pseudo-terminal.",
)  # fmt: skip
@click.option(
    "--stall", "stalls", type=Span(), multiple=True, help="Send nothing for S s from time T on."
)
@click.option(
    "--reset-at",
    "resets",
    type=click.FloatRange(0),
    multiple=True,
    help="Restart the device at this time, in s.",
)
@click.option(
    "--garbage", type=Span(), multiple=True, help="Send random bytes for S s from time T on."
)
@click.option("--duplicate-id", is_flag=True, help="Give the second sensor the first one's id.")
@click.option(
    "--seed",
    type=click.IntRange(0),
    default=0,
    show_default=True,
    help="Seed of the random numbers.",
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
    """Plays a take over a pseudo-terminal, in the protocol of a device.

    Prints the path of the pseudo-terminal on the first line (one line for each sensor, if each has
    its own port), starts playing when a program opens it, and ends after the take. On Windows it
    is a TCP port, and its URL is printed.
    """
    take = noisy(read_take(take_path), noise_presets()[noise], seed)
    faults = Faults(
        loss, corrupt, cut_after, replug_after, stalls, resets, garbage, duplicate_id, seed
    )
    emulator = Emulator(take, driver, options, speed, faults, link)
    with interrupted() as stop:
        _print(emulator.plug_in())
        try:
            while True:
                emulator.run(stop.is_set, _print)
                if not loop or stop.is_set():
                    break
        finally:
            emulator.close()
    lost = f", {emulator.num_overrun} not read in time" if emulator.num_overrun else ""
    click.echo(f"sent {emulator.num_sent} packets{lost}", err=True)


def _print(paths: list[str]) -> None:
    for path in paths:
        click.echo(path)
