# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap body``: writes the performer's proportions."""

from __future__ import annotations

from pathlib import Path

import click

from .. import body_of_height
from ..body_file import body_of_motion, write_body
from .options import FilePath, check_ending

__all__ = ["body"]


@click.command()
@click.argument("clip", metavar="[CLIP]", required=False, type=FilePath)
@click.option(
    "--height", "height_m", metavar="METRES", type=float,
    help="The performer's height, if there is no motion file of them.",
)  # fmt: skip
@click.option(
    "-o", "--output", type=FilePath, required=True, help="The body file to write (.json)."
)
def body(clip: Path | None, height_m: float | None, output: Path) -> None:
    """Writes the performer's body from a motion file of them, or from their height.

    Use the file with --body in other commands.
    """
    check_ending(output, ".json")
    if (clip is None) == (height_m is None):
        raise click.UsageError("Give either a motion file of the performer or their --height.")
    if clip is not None:
        found = body_of_motion(clip)
        write_body(output, found, clip.name)
    else:
        assert height_m is not None
        found = body_of_height(height_m)
        write_body(output, found, f"a height of {height_m:g} m")
    click.echo(f"{output}: body height {found.height_m:.2f} m")
