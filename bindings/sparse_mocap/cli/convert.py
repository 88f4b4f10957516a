# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap convert``: converts motion files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
import numpy as np

from .. import (
    MotionDatabase,
    read_motion,
    to_standard,
    write_acclaim,
    write_bvh,
    write_positions,
)
from .console import warn
from .options import FilePath, check_ending, extremities_option, frame_option, reading_options

__all__ = ["convert"]


@click.command()
@click.argument("clip", metavar="CLIP", type=FilePath)
@click.option(
    "-o", "--output", type=FilePath, required=True,
    help="OUT.bvh; OUT.amc, which also writes its skeleton OUT.asf; or OUT.csv for a table of joint"
    " positions on the standard skeleton.",
)  # fmt: skip
@click.option(
    "--skeleton", metavar="own|DB.smdb", default="own", show_default=True,
    help="The file's own skeleton (for .csv: the standard skeleton with the file's proportions), or"
    " that of a database.",
)  # fmt: skip
@frame_option
@click.option("--fps", type=float, help="Resample to this many frames per second.")
@extremities_option
@reading_options
def convert(
    clip: Path,
    output: Path,
    skeleton: str,
    frame: str,
    extremities: bool,
    fps: float | None,
    reading: dict[str, Any],
) -> None:
    """Converts a motion file: .bvh, .amc, .npz (SMPL, AMASS) or .mvnx."""
    ending = check_ending(output, ".bvh", ".amc", ".csv")
    motion, warnings = read_motion(clip, **reading)
    if skeleton != "own" or ending == ".csv":
        target = None if skeleton == "own" else MotionDatabase(skeleton).skeleton
        motion, more = to_standard(motion, target, extremities=extremities)
        warnings += more
    if fps is not None:
        motion = motion.resampled(fps)
    if ending == ".bvh":
        write_bvh(output, motion)
    elif ending == ".amc":
        write_acclaim(output, motion)
    else:
        times = np.arange(motion.num_frames) * motion.frame_time_s
        write_positions(output, times, motion.skeleton.names, motion.joint_positions(frame))
    warn(warnings)
