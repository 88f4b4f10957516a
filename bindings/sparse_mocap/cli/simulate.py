# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap simulate``: simulates takes."""

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
    position_along_bone_option,
    positions_along_bone_of,
    seed_option,
)

__all__ = ["simulate"]


@click.command()
@click.argument("clip", metavar="CLIP", type=FilePath)
@click.option("-o", "--output", type=FilePath, required=True, help="The take file to write (.csv).")
@click.option(
    "--sites", type=Sites(), default=PAPER_SITES, show_default=True, help="Sensor locations."
)
@click.option(
    "--rate", type=click.FloatRange(1, 10_000), default=100.0, show_default=True,
    help="Samples per second.",
)  # fmt: skip
@noise_option
@seed_option
@position_along_bone_option
@click.option(
    "--with-positions", is_flag=True,
    help="Also write the position of each sensor (px,py,pz), as tracked sensors send it.",
)  # fmt: skip
def simulate(
    clip: Path,
    output: Path,
    sites: tuple[str, ...],
    rate: float,
    noise: str,
    seed: int,
    positions_along_bone: tuple[tuple[str, float], ...],
    with_positions: bool,
) -> None:
    """Simulates a take from a motion file.

    The take contains what sensors would record on a performer with the file's proportions.
    """
    check_ending(output, ".csv")
    motion, warnings = read_motion(clip)
    performed, more = to_standard(motion)
    along = positions_along_bone_of(sites, positions_along_bone)
    ideal = simulated(performed, sites, rate, along, with_position=with_positions)
    origin = f"simulated from {clip.name} at {rate:g} Hz, noise {noise}, seed {seed}"
    write_take(output, Take(noisy(ideal, noise_presets()[noise], seed).sensors, (origin,)))
    warn(warnings + more)
