# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap simulate``: takes of sensors that never were."""

from __future__ import annotations

from pathlib import Path

import click

from .. import noise_presets, noisy, read_motion, simulated, to_standard, write_take
from ..take import Take
from .console import warn
from .options import (
    PAPER_SITES,
    FilePath,
    Sites,
    check_ending,
    noise_option,
    place_option,
    places_of,
    seed_option,
)

__all__ = ["simulate"]


@click.command()
@click.argument("clip", metavar="CLIP", type=FilePath)
@click.option("-o", "--output", type=FilePath, required=True, help="The take file (.csv).")
@click.option(
    "--sites", type=Sites(), default=PAPER_SITES, show_default=True, help="Where sensors are worn."
)
@click.option(
    "--rate", type=click.FloatRange(1, 10_000), default=100.0, show_default=True,
    help="Samples a second.",
)  # fmt: skip
@noise_option
@seed_option
@place_option
def simulate(
    clip: Path,
    output: Path,
    sites: tuple[str, ...],
    rate: float,
    noise: str,
    seed: int,
    places: tuple[tuple[str, float], ...],
) -> None:
    """Turns a motion file into a take.

    It is what sensors would record while someone of the file's proportions performs the motion.
    """
    check_ending(output, ".csv")
    motion, warnings = read_motion(clip)
    performed, more = to_standard(motion)
    ideal = simulated(performed, sites, rate, places_of(sites, places))
    origin = f"simulated from {clip.name} at {rate:g} Hz, noise {noise}, seed {seed}"
    write_take(output, Take(noisy(ideal, noise_presets()[noise], seed).sensors, (origin,)))
    warn(warnings + more)
