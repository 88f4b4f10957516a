# SPDX-License-Identifier: GPL-3.0-or-later
"""Models that are trained for a test, from clips that the test may know."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from .. import Clip, Model, TrainingClip, read_motion, to_standard, train
from ..methods import option_values
from .contender import Contender
from .protocol import is_copy, source_path

__all__ = ["Trainer"]


class Trainer:
    """Trains each method once for the same clips."""

    def __init__(
        self,
        clips: Sequence[Clip],
        files: Mapping[str, list[Path]],
    ) -> None:
        self._clips, self._files = clips, dict(files)
        self._models: dict[tuple[str, str, tuple[int, ...]], Model] = {}
        self._of_training: dict[str, set[str]] = {}
        """By method, the options that its models remember: those of training."""

    def model(self, contender: Contender, excluded: Sequence[int]) -> Model:
        """Returns the model from all clips but those excluded and the copies."""
        hidden = set(excluded)
        used = tuple(
            index
            for index, clip in enumerate(self._clips)
            if index not in hidden and not is_copy(clip)
        )
        key = self._key(contender, used)
        if key not in self._models:
            model = train(
                contender.method,
                [self._training_clip(index) for index in used],
                preset=contender.preset or "",
                options=option_values(contender.options),
            )
            self._of_training[contender.method] = set(model.metadata)
            self._models[self._key(contender, used)] = model
            return model
        return self._models[key]

    def _key(self, contender: Contender, used: tuple[int, ...]) -> tuple[str, str, tuple[int, ...]]:
        """Returns the same for contenders that share a model."""
        names = self._of_training.get(contender.method, set(contender.options))
        options = {name: contender.options[name] for name in contender.options if name in names}
        return (contender.method, f"{contender.preset} {sorted(options.items())!r}", used)

    def _training_clip(self, index: int) -> TrainingClip:
        clip = self._clips[index]
        motion, _ = to_standard(read_motion(source_path(self._files, clip))[0], extremities=True)
        return TrainingClip(clip.name, motion, motion_class=clip.motion_class)
