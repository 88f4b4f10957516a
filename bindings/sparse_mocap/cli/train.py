# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap train``: trains the model of a method."""

from __future__ import annotations

from pathlib import Path

import click

from .. import (
    ConfigError,
    Motion,
    TrainingClip,
    find_motion_files,
    read_motion,
    read_take,
    to_standard,
    write_model,
)
from .. import train as train_method
from ..calibration import sensor_inputs
from ..readings import Readings, all_readings, channels_in
from .console import progress_bar, warn
from .options import FilePath, check_ending, method_choice, preset_option, set_option

__all__ = ["train"]


@click.command()
@click.argument("clips", metavar="CLIP...", nargs=-1, type=FilePath)
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
def train(
    clips: tuple[Path, ...],
    method: str,
    output: Path,
    preset: str | None,
    settings: tuple[tuple[str, str], ...],
    takes: tuple[tuple[str, Path], ...],
) -> None:
    """Trains a method's model from motion files and folders of them.

    Methods that need only a motion database are not trained.
    """
    check_ending(output, ".smmodel")
    choice = method_choice(method, preset, settings)
    if not choice.info.can_be_trained:
        raise ConfigError(
            f"{choice.method} needs no trained model: give it a motion database (--database)"
        )
    files = [Path(path) for path in find_motion_files(clips)]
    recorded = dict(takes)
    unknown = set(recorded) - {path.name for path in files}
    if unknown:
        raise click.BadParameter(
            f"no clip has the file name {', '.join(sorted(unknown))}", param_hint="'--take'"
        )
    examples = [_example(path, recorded.get(path.name)) for path in files]
    with progress_bar("Training") as progress:
        model = train_method(
            choice.method,
            examples,
            preset=choice.preset or "",
            options=choice.options,
            progress=progress,
        )
    write_model(output, model)
    click.echo(f"{output}: model of {choice.method}, trained on {len(examples)} clips")


def _example(path: Path, take: Path | None) -> TrainingClip:
    motion, warnings = read_motion(path)
    standard, more = to_standard(motion, extremities=True)
    warn([f"{path.name}: {line}" for line in [*warnings, *more]])
    readings = None if take is None else _readings(take, standard)
    return TrainingClip(path.stem, standard, readings=readings)


def _readings(take: Path, motion: Motion) -> Readings:
    recorded = read_take(take)
    channels = [channels_in(record) for record in recorded.sensors.values()]
    inputs = sensor_inputs(None, recorded.sites, channels)
    return all_readings(recorded, inputs, 1.0 / motion.frame_time_s, gravity_average="whole_take")
