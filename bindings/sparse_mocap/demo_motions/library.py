# SPDX-License-Identifier: GPL-3.0-or-later
"""The motion library and the performance: which exercises, how large, into which files."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import radians
from pathlib import Path

import numpy as np

from . import exercises as ex
from .bvh_text import write_bvh
from .compose import alive, joined
from .controls import cropped, mirror
from .curves import FRAME_RATE, Array
from .gait import jog, perform, turn_in_place, walk
from .solve import solve
from .style import CAST, GUEST, Actor

__all__ = ["Clip", "generate_library", "generate_performance"]

Progress = Callable[[int, int, str], None]
"""Called after each file with the number of files written, their total and the file's name."""


@dataclass(frozen=True)
class _Chance:
    """Parameters about the usual ones of an actor, different in every exercise."""

    actor: Actor
    rng: np.random.Generator

    def about(self, value: float, spread: float = 0.04) -> float:
        return value * float(self.rng.uniform(1.0 - spread, 1.0 + spread))

    def pace(self, seconds: float) -> float:
        """A duration (s) at the actor's tempo."""
        return self.about(seconds / self.actor.style.tempo)

    def size(self, factor: float) -> float:
        """An amplitude with the actor's energy."""
        return self.about(factor * self.actor.style.energy**0.6)


@dataclass(frozen=True)
class Clip:
    """One file of the library to be: its name without ending, who moves, and how."""

    name: str
    actor: Actor
    motion: Array


def generate_library(
    folder: Path, *, seed: int = 0, progress: Progress | None = None
) -> list[Path]:
    """Write the library, one BVH file an exercise, into ``folder`` and return the files in order.

    Files are named ``<actor>_<class>_<take>.bvh``.  The same seed gives the same bytes.
    """
    folder.mkdir(parents=True, exist_ok=True)
    clips = [clip for number, actor in enumerate(CAST) for clip in _clips(actor, seed, number)]
    files = []
    for done, clip in enumerate(clips, start=1):
        path = folder / f"{clip.name}.bvh"
        files.append(write_bvh(path, clip.actor.body, solve(clip.actor.body, clip.motion)))
        if progress is not None:
            progress(done, len(clips), path.name)
    return files


def generate_performance(path: Path, *, seed: int = 1) -> Path:
    """Write one long motion of an actor who is not in the library to the BVH file ``path``."""
    rng = np.random.default_rng([seed, len(CAST)])
    motion = alive(GUEST, joined(GUEST, _programme(GUEST, rng)), rng)
    path.parent.mkdir(parents=True, exist_ok=True)
    return write_bvh(path, GUEST.body, solve(GUEST.body, motion))


def _clips(actor: Actor, seed: int, number: int) -> Iterator[Clip]:
    """All clips of one actor; one-sided exercises come as a mirrored pair."""
    rng = np.random.default_rng([seed, number])
    takes: Counter[str] = Counter()
    for parts in (_gaits, _one_sided, _two_sided):
        for kind, motion in parts(_Chance(actor, rng)):
            lively = alive(actor, motion, rng)
            pair = [("left", lively), ("right", mirror(lively))]
            for side, curves in pair if parts is _one_sided else [("", lively)]:
                takes[kind + side] += 1
                name = f"{actor.name}_{kind}{side}_{takes[kind + side]:02d}"
                yield Clip(name, actor, curves)


def _gaits(chance: _Chance) -> Iterator[tuple[str, Array]]:
    """Straight walks and jogs, from standing to standing or cut out of the middle."""
    actor, about = chance.actor, chance.about
    body, tempo = actor.body, actor.style.tempo
    yield "walk", perform(actor, walk(body, tempo, about(0.78), steps=6))
    yield "walk", _middle(perform(actor, walk(body, tempo, about(1.0), steps=9)), 1.1)
    yield "walk", _middle(perform(actor, walk(body, tempo, about(1.17), steps=8)), 0.3)
    yield "jog", _middle(perform(actor, jog(body, tempo, about(1.0), steps=10)), 0.3)


def _one_sided(chance: _Chance) -> Iterator[tuple[str, Array]]:
    """The exercises that lead with the left or go to the left."""
    actor, about, pace, size = chance.actor, chance.about, chance.pace, chance.size
    body, tempo = actor.body, actor.style.tempo
    curve, bend, spin = (radians(about(angle, 0.1)) for angle in (75.0, 60.0, 95.0))
    yield "walk", _middle(perform(actor, walk(body, tempo, about(0.95), 8, curve)), 0.3)
    yield "jog", _middle(perform(actor, jog(body, tempo, about(0.92), 10, bend)), 0.3)
    yield "turn", perform(actor, turn_in_place(about(tempo), spin, steps=4))
    yield "kick", ex.kick(actor, pace(1.5), size(1.0))
    yield "reach", ex.reach_high(actor, pace(2.1), about(0.35, 0.6))
    yield "reach", ex.reach_low(actor, pace(2.3), about(0.4, 0.9))


def _two_sided(chance: _Chance) -> Iterator[tuple[str, Array]]:
    """The exercises that use both sides alike."""
    actor, pace, size = chance.actor, chance.pace, chance.size
    yield "squat", ex.squat(actor, 2, pace(1.7), size(0.95))
    yield "squat", ex.squat(actor, 2, pace(1.25), size(0.55))
    yield "jack", ex.jacks(actor, 3, pace(1.14), size(1.0))
    yield "jack", ex.jacks(actor, 2, pace(1.25), size(0.88))
    yield "armcircle", ex.arm_circles(actor, 2, pace(1.2))
    yield "armcircle", ex.arm_circles(actor, 2, pace(1.25), backward=True)
    yield "armswing", ex.arm_swings(actor, 2, pace(1.3), size(1.0))
    yield "armswing", ex.hugs(actor, 2, pace(1.15), size(1.0))
    yield "idle", ex.idle(actor, pace(4.2), chance.rng)
    yield "idle", ex.idle(actor, pace(3.4), chance.rng)


def _programme(actor: Actor, rng: np.random.Generator) -> list[Array]:
    """The exercises of the performance, in order."""
    chance = _Chance(actor, rng)
    about, pace, size = chance.about, chance.pace, chance.size
    body, tempo = actor.body, actor.style.tempo
    return [
        perform(actor, walk(body, tempo, about(0.92), steps=4)),
        perform(actor, turn_in_place(tempo, radians(about(80.0)), steps=3)),
        ex.squat(actor, 1, pace(1.55), size(0.8)),
        ex.jacks(actor, 2, pace(1.15), size(0.95)),
        mirror(ex.kick(actor, pace(1.45), size(0.95))),
        ex.reach_high(actor, pace(1.9), about(0.3)),
        ex.arm_circles(actor, 1, pace(1.3)),
        perform(actor, walk(body, tempo, about(1.05), steps=5, turn=radians(about(40.0)))),
    ]


def _middle(motion: Array, margin: float) -> Array:
    """The motion without its first and last ``margin`` seconds, starting at the origin."""
    cut = round(margin * FRAME_RATE)
    return cropped(motion, cut, len(motion) - cut)
