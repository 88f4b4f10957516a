# SPDX-License-Identifier: GPL-3.0-or-later
"""What the accuracy tests perform, and the motions that their database is built from."""

from __future__ import annotations

import shutil
from math import radians
from pathlib import Path

import numpy as np
from sparse_mocap.demo_motions import exercises as ex
from sparse_mocap.demo_motions import generate_library
from sparse_mocap.demo_motions.body import Body
from sparse_mocap.demo_motions.bvh_text import write_bvh
from sparse_mocap.demo_motions.compose import alive, joined
from sparse_mocap.demo_motions.controls import mirror
from sparse_mocap.demo_motions.gait import perform, walk
from sparse_mocap.demo_motions.solve import Pose, solve
from sparse_mocap.demo_motions.style import Actor, Style

LIBRARY_ACTORS = ("ada", "emil")  # of tempos 1.00 and 0.93

PERFORMER = Actor(
    "greta",
    Body.of(181.0, legs=1.03, arms=1.02, breadth=1.05),
    Style(
        tempo=1.28,
        energy=1.12,
        arm_swing=1.25,
        stance=1.1,
        stoop=radians(6.0),
        toe_out=radians(10.0),
        elbow=radians(22.0),
        carriage=radians(12.0),
        unrest=1.2,
    ),
)
"""Quicker, taller and livelier than anybody in the library."""


def write_library(folder: Path) -> Path:
    """Writes the clips of the database: one-sided exercises to the left only."""
    everything = folder / "everything"
    generate_library(everything)
    chosen = folder / "library"
    chosen.mkdir()
    for actor in LIBRARY_ACTORS:
        for path in sorted(everything.glob(f"{actor}_*.bvh")):
            if "right" not in path.stem:
                shutil.copy(path, chosen)
    return chosen


def perform_programme(path: Path) -> Pose:
    """Writes the performance as BVH and returns its pose; most of it goes to the right."""
    actor, body, tempo = PERFORMER, PERFORMER.body, PERFORMER.style.tempo
    rng = np.random.default_rng(7)
    size = actor.style.energy**0.6
    parts = [
        perform(actor, walk(body, tempo, 1.05, steps=6)),
        ex.squat(actor, 1, 1.5 / tempo, 0.8 * size),
        mirror(ex.kick(actor, 1.5 / tempo, size)),
        ex.jacks(actor, 2, 1.2 / tempo, size),
        mirror(ex.reach_high(actor, 2.1 / tempo, 0.35)),
        mirror(ex.reach_low(actor, 2.3 / tempo, 0.5)),
        ex.arm_swings(actor, 1, 1.3 / tempo, size),
        mirror(perform(actor, walk(body, tempo, 0.9, steps=6, turn=radians(60.0)))),
    ]
    pose = solve(body, alive(actor, joined(actor, parts), rng))
    write_bvh(path, body, pose)
    return pose
