# SPDX-License-Identifier: GPL-3.0-or-later
"""What an evaluation compares: methods with their settings, in live or best quality."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ..methods import Experiment, MethodInfo, Variant, method_info

__all__ = ["Contender", "contenders", "variants"]


@dataclass(frozen=True)
class Contender:
    """One way of reconstructing, under the name that tables give it."""

    label: str
    method: str
    preset: str | None = None
    options: Mapping[str, Any] = field(default_factory=dict)
    best_quality: bool = False
    sensors: Mapping[str, Sequence[str]] = field(default_factory=dict)
    """The channels of its sensors, by site; empty: those of the evaluation."""
    knows_all_clips: bool = False
    """Whether its database has all clips but the tests, not the training clips alone."""

    @property
    def info(self) -> MethodInfo:
        """Its method."""
        return method_info(self.method)


def contenders(
    methods: Sequence[str],
    *,
    presets: Sequence[str] = (),
    options: Mapping[str, Any] | None = None,
    with_best_quality: bool = False,
) -> list[Contender]:
    """Returns every method in every preset that it has of those named, live and, if wanted, best.

    A method that works on whole takes only is always there. Without presets the default one is
    used.
    """
    found = []
    for name in methods:
        info = method_info(name)
        known = [preset.name for preset in info.presets]
        for preset in [name for name in known if name in presets] or known[:1]:
            label = name if len(known) == 1 else f"{name} {preset}"
            if info.works_live:
                found.append(Contender(label, name, preset, options or {}))
            if info.works_on_whole_takes and (with_best_quality or not info.works_live):
                found.append(Contender(f"{label}, best", name, preset, options or {}, True))
    return found


def variants(method: str, experiment: Experiment) -> list[Contender]:
    """Returns what an experiment of a method compares."""
    return [_variant(method, variant) for variant in experiment.variants]


def _variant(method: str, variant: Variant) -> Contender:
    name = variant.method or method
    info = method_info(name)
    is_best = info.works_on_whole_takes and (variant.in_best_quality or not info.works_live)
    return Contender(
        variant.label,
        name,
        None,
        variant.options,
        is_best,
        variant.sensors,
        variant.knows_all_clips,
    )
