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

    def model(self, contender: Contender, excluded: Sequence[int]) -> Model:
        """Returns the model from all clips but those excluded and the copies."""
        hidden = set(excluded)
        used = tuple(
            index
            for index, clip in enumerate(self._clips)
            if index not in hidden and not is_copy(clip)
        )
        key = (contender.method, repr(sorted(contender.options.items())), used)
        if key not in self._models:
            self._models[key] = train(
                contender.method,
                [self._training_clip(index) for index in used],
                preset=contender.preset or "",
                options=option_values(contender.options),
            )
        return self._models[key]

    def _training_clip(self, index: int) -> TrainingClip:
        clip = self._clips[index]
        motion, _ = to_standard(read_motion(source_path(self._files, clip))[0], extremities=True)
        return TrainingClip(clip.name, motion, motion_class=clip.motion_class)
