# SPDX-License-Identifier: GPL-3.0-or-later
"""Models of methods that learn from clips: trained from the motion database, and opened."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .core import core, latent_space_module, training_module
from .database import databases
from .errors import InputError
from .job import Job, Progress
from .methods import MethodChoice, models, parsed_options

SUFFIX = ".smmodel"
PHASES_SUFFIX = ".csv"
TRAINING = "Training the model"
PHASES = ("standing", "left_step", "right_step", "jump", "start", "stop")
"""By their numbers."""


@dataclass(frozen=True)
class TrainingChoices:
    """What a model is trained from."""

    method: str
    classes: str = ""
    """Of clips, separated by commas; each is a type of motion. Empty: all."""
    clips: str = ""
    """Names or patterns of clips, separated by commas. Empty: all of the classes."""
    phases: str = ""
    """A file with the phases of the clips; empty: found by the feet."""
    options: str = ""


@dataclass(frozen=True)
class Trained:
    """A trained model."""

    path: str
    num_clips: int
    types: tuple[str, ...]


def classes_in(database_path: str) -> list[str]:
    """The classes of the clips of a database that is open already; sorted."""
    database = databases.peek(database_path).value if database_path else None
    if database is None:
        return []
    return list(training_module().trainable_classes(database.motions))


def with_name(names: str, added: str) -> str:
    """The names, separated by commas, with one more."""
    kept = _parts(names)
    return ", ".join([*kept, added] if added not in kept else kept)


def default_output(database_path: str, choices: TrainingChoices) -> str:
    """Where a model is saved if nobody says: beside the database, named after what it knows."""
    if not database_path:
        return ""
    path = Path(database_path)
    what = "_".join(_parts(choices.classes)) or "motion"
    return str(path.with_name(f"{path.stem}_{what}{SUFFIX}"))


def train_job(database_path: str, output: str, choices: TrainingChoices) -> Job:
    """The job that trains a model and writes it; its result is a Trained.

    Raises InputError, or what is wrong with the files.
    """
    path = checked_output(output)
    database = databases.get(database_path)
    options = dict(parsed_options(choices.options))

    def work(progress: Progress) -> Trained:
        clips = _clips(database.motions, choices, options)
        model = core().train(choices.method, clips, options=options, progress=progress)
        models.forget()  # an open file cannot be replaced on Windows
        core().write_model(path, model)
        types = dict.fromkeys(clip.motion_class for clip in clips if clip.motion_class)
        return Trained(path, len(clips), tuple(types))

    return Job(TRAINING, work)


def write_phases(database_path: str, output: str, choices: TrainingChoices) -> tuple[str, int]:
    """Write the phases of the clips to a file to be changed; returns its path and how many clips.

    Raises InputError, or what is wrong with the clips.
    """
    path = str(Path(checked_output(output)).with_suffix(PHASES_SUFFIX))
    database = databases.get(database_path)
    options = dict(parsed_options(choices.options))
    clips = _clips(database.motions, choices, options, with_phases=False)
    segments = {
        clip.name: core().clip_segments(choices.method, clip, options=options) for clip in clips
    }
    training_module().write_phases(path, segments)
    return path, len(clips)


def checked_output(path: str) -> str:
    """The path with its ending, in a folder that exists. Raises InputError."""
    if not path:
        raise InputError("Choose where to save the model first")
    checked = path if path.endswith(SUFFIX) else path + SUFFIX
    if not Path(checked).parent.is_dir():
        raise InputError(f"The folder {Path(checked).parent} does not exist: choose another one")
    return checked


def skeleton_of(choice: MethodChoice) -> Any:
    """The skeleton of the live poses of a method with a model. Raises what is wrong with it."""
    arguments = choice.arguments()
    site = arguments["model"].metadata.get("site", "")
    channels = ["specific_force", "angular_velocity"]
    live = core().LiveReconstructor({0: _site(site)}, [channels], None, **arguments)
    return live.skeleton


def _site(trained_for: str) -> str:
    return "left_ankle" if trained_for in ("", "ankles") else trained_for


@dataclass(frozen=True)
class LatentView:
    """The latent space of one type of motion, as a picture of it needs it."""

    name: str
    points: NDArray[np.float64]
    """(N, 2) from 0 to 1."""
    phases: NDArray[np.int64]
    """(N,) of the points, numbers of PHASES."""
    sequences: tuple[slice, ...]
    """The points of each clip."""
    dimensions: int
    place: Callable[[NDArray[np.float64]], NDArray[np.float64]]
    """Puts points of the latent space (..., D) into the picture (..., 2)."""


def latent_views(path: str) -> list[LatentView]:
    """One for each type of motion that the model knows. Raises what is wrong with the file."""
    return list(_views(models.get(path)))


@lru_cache(maxsize=4)
def _views(model: Any) -> tuple[LatentView, ...]:
    return tuple(_view(found) for found in latent_space_module().latent_maps(model))


def _view(found: Any) -> LatentView:
    lowest, highest = found.points.min(axis=0), found.points.max(axis=0)
    size = float(max(*(highest - lowest), 1e-9))
    corner = 0.5 * (lowest + highest) - 0.5 * size

    def place(latent: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray((found.placed(latent) - corner) / size)

    return LatentView(
        found.name,
        (found.points - corner) / size,
        found.phases,
        tuple(found.sequences()),
        len(found.centre),
        place,
    )


def _clips(
    motions: Any, choices: TrainingChoices, options: dict[str, str], *, with_phases: bool = True
) -> list[Any]:
    clips: list[Any] = training_module().database_clips(
        motions,
        classes=_parts(choices.classes),
        names=_parts(choices.clips),
        position_along_bone=float(options.get("position_along_bone", 1.0)),
    )
    if choices.phases and with_phases:
        phases = training_module().read_phases(choices.phases)
        unknown = sorted(set(phases) - {clip.name for clip in clips})
        if unknown:
            raise InputError(
                f"The file of phases has a clip that is not trained from: {unknown[0]}"
            )
        for clip in clips:
            clip.segments = phases.get(clip.name, [])
    return clips


def _parts(text: str) -> list[str]:
    return [part.strip() for part in text.split(",") if part.strip()]
