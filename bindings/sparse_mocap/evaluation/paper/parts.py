# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of the paper's evaluation, in the order in which they are written."""

from __future__ import annotations

from collections.abc import Callable

from . import knowledge, method, sensing
from .runs import Runs
from .section import Section

__all__ = ["PARTS", "run_part"]

PARTS: dict[str, Callable[[Runs], Section]] = {
    "scenarios": knowledge.scenarios,
    "energy": method.energy,
    "window": method.window,
    "priors": method.priors,
    "graph": method.graph,
    "sensors": sensing.sensors,
    "noise": sensing.noise,
    "tempo": sensing.tempo,
    "root_speed": sensing.root_speed,
    "histogram": knowledge.histogram,
    "proportions": knowledge.proportions,
    "content": knowledge.content,
}


def run_part(runs: Runs, name: str) -> Section:
    """Returns what a part found; what it had found before is not run again. Raises Cancelled."""
    names = list(PARTS)
    runs.part = (names.index(name), len(names), name)
    runs.num_clips.clear()
    section = PARTS[name](runs)
    section.num_clips = sorted(runs.num_clips)
    return section
