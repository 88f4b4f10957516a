# SPDX-License-Identifier: GPL-3.0-or-later
"""The latent space of a trained model of ``eom2014``, laid out on a plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import ConfigError, Model

__all__ = ["PHASES", "LatentMap", "latent_maps"]

Floats = NDArray[np.float64]

PHASES = ("standing", "left_step", "right_step", "jump", "start", "stop")
"""By the numbers that models and diagnostics have."""


@dataclass(frozen=True)
class LatentMap:
    """One type of motion: where its frames lie on the plane in which they differ most."""

    name: str
    """Of the type; may be empty."""
    points: Floats
    """(N, 2)"""
    phases: NDArray[np.int64]
    """(N,) numbers of PHASES."""
    begins: NDArray[np.int64]
    """The first frames of the clips."""
    centre: Floats
    """(D,)"""
    axes: Floats
    """(D, 2)"""

    def placed(self, latent: Floats) -> Floats:
        """Returns where points of the latent space (..., D) lie on the plane (..., 2)."""
        return np.asarray((latent - self.centre) @ self.axes)

    def sequences(self) -> list[slice]:
        """Returns the frames of each clip."""
        ends = [*self.begins[1:].tolist(), len(self.points)]
        return [slice(b, e) for b, e in zip(self.begins.tolist(), ends, strict=True)]


def latent_maps(model: Model) -> list[LatentMap]:
    """Returns a map for each type of motion that the model knows.

    Raises ConfigError for models of other methods.
    """
    maps: list[LatentMap] = []
    names = {name for name, *_ in model.tensor_infos}
    while (prefix := f"type{len(maps)}.") + "latent" in names:
        X = np.asarray(model.tensor(f"{prefix}latent"), float)
        centre = X.mean(axis=0)
        axes = np.linalg.svd(X - centre, full_matrices=False)[2][:2].T
        if axes.shape[1] < 2:
            axes = np.hstack([axes, np.zeros((len(axes), 2 - axes.shape[1]))])
        maps.append(
            LatentMap(
                model.metadata.get(f"{prefix}name", ""),
                (X - centre) @ axes,
                np.asarray(model.tensor(f"{prefix}phases"), np.int64),
                np.asarray(model.tensor(f"{prefix}sequence_begins"), np.int64),
                centre,
                axes,
            )
        )
    if not maps:
        raise ConfigError(f"a model of '{model.method}' has no latent space to plot")
    return maps
