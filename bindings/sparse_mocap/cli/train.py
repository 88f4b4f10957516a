# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap train``: trains the model of a method."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import click

from .. import ConfigError, write_model
from .. import train as train_method
from ..training import read_phases
from .console import progress_bar
from .options import FilePath, check_ending, method_choice, preset_option, set_option
from .training_clips import clip_options, training_clips

__all__ = ["train"]


@click.command()
@clip_options
@click.option("--method", required=True, help="The method to train; `methods` lists them.")
@click.option(
    "-o", "--output", type=FilePath, required=True, help="The model file to write (.smmodel)."
)
@preset_option
@set_option
@click.option(
    "--take", "takes", type=(str, FilePath), multiple=True, metavar="CLIP TAKE.csv",
    help="The file name of a clip, and the take that real sensors recorded of it. Can be repeated;"
    " for other clips, sensors are simulated.",
)  # fmt: skip
@click.option(
    "--phases", "phases_path", metavar="FILE.csv", type=FilePath,
    help="The phases of clips: write the file with `phases`, then change the times in it.",
)  # fmt: skip
def train(
    chosen: Mapping[str, Any],
    method: str,
    output: Path,
    preset: str | None,
    settings: tuple[tuple[str, str], ...],
    takes: tuple[tuple[str, Path], ...],
    phases_path: Path | None,
) -> None:
    """Trains a method's model from motion files, folders of them or clips of a database.

    Methods that need only a motion database are not trained.
    """
    check_ending(output, ".smmodel")
    choice = method_choice(method, preset, settings)
    if not choice.info.can_be_trained:
        raise ConfigError(
            f"{choice.method} needs no trained model: give it a motion database (--database)"
        )
    phases = {} if phases_path is None else read_phases(phases_path)
    examples = training_clips(chosen, choice.options, dict(takes), phases)
    with progress_bar("Training") as progress:
        model = train_method(
            choice.method,
            examples,
            preset=choice.preset or "",
            options=choice.options,
            progress=progress,
        )
    write_model(output, model)
    types = sorted({clip.motion_class for clip in examples} - {""})
    told = f" of {len(types)} types of motion" if len(types) > 1 else ""
    click.echo(f"{output}: model of {choice.method}, trained on {len(examples)} clips{told}")
