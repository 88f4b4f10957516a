# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap latent``: a picture of what a model has learned."""

from __future__ import annotations

from pathlib import Path

import click
import numpy as np

from .. import ConfigError, read_model, read_take
from ..latent_space import latent_maps
from ..reconstruction import reconstruct
from .options import FilePath, OutputPath, check_ending

__all__ = ["latent"]


@click.command()
@click.argument("model_path", metavar="M.smmodel", type=FilePath)
@click.option(
    "-o", "--output", type=OutputPath(), required=True, help="The picture to write (.png)."
)
@click.option(
    "--take",
    metavar="TAKE.csv",
    type=FilePath,
    help="Also draw the path of a take through the latent space.",
)
def latent(model_path: Path, output: Path, take: Path | None) -> None:
    """Draws the latent space of a model: a point for each frame that it was trained on.

    The points have the colours of their phases; a picture for each type of motion.
    """
    check_ending(output, ".png")
    model = read_model(model_path)
    maps = latent_maps(model)
    way = None
    if take is not None:
        solved = reconstruct(read_take(take), best_quality=True, method=model.method, model=model)
        if "latent" not in solved.diagnostics:
            raise ConfigError(f"{model.method} does not tell the way of a take")
        types = solved.diagnostics["motion_type"][:, 0].astype(np.int64)
        way = (np.asarray(solved.diagnostics["latent"]), types)
    from ..plots_latent import plot_latent_space

    plot_latent_space(maps, output, way)
    click.echo(f"{output}: {len(maps)} {'type' if len(maps) == 1 else 'types'} of motion")
