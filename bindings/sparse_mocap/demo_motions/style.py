# SPDX-License-Identifier: GPL-3.0-or-later
"""Ways of moving, and the cast: who performs the library and who the demonstration."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians

from .body import Body

__all__ = ["Actor", "Style"]


@dataclass(frozen=True)
class Style:
    """How somebody moves; 1 is average for every factor, angles are radians."""

    tempo: float = 1.0
    """Factor on the rate of everything."""
    energy: float = 1.0
    """Factor on the size of movements."""
    arm_swing: float = 1.0
    stance: float = 1.0
    """Factor on the distance between the feet."""
    stoop: float = radians(2.0)
    """Forward bend of the spine at rest."""
    toe_out: float = radians(7.0)
    elbow: float = radians(14.0)
    """Elbow flexion of the hanging arm."""
    carriage: float = radians(9.0)
    """How far the hanging arms are held from the body."""
    unrest: float = 1.0
    """Factor on aimless small motion."""


@dataclass(frozen=True)
class Actor:
    """One person: a body and a style."""

    name: str
    body: Body
    style: Style


def _degrees(
    stoop: float, toe_out: float, elbow: float, carriage: float, **factors: float
) -> Style:
    return Style(
        stoop=radians(stoop),
        toe_out=radians(toe_out),
        elbow=radians(elbow),
        carriage=radians(carriage),
        **factors,
    )


CAST = (
    Actor(
        "ada",
        Body.of(168.0),
        _degrees(2, 7, 14, 8, tempo=1.0, energy=1.0, arm_swing=1.0, stance=1.0),
    ),
    Actor(
        "bruno",
        Body.of(188.0, legs=1.02, arms=1.03, breadth=1.10),
        _degrees(5, 11, 20, 12, tempo=0.90, energy=0.92, arm_swing=0.8, stance=1.2, unrest=0.8),
    ),
    Actor(
        "chen",
        Body.of(160.0, legs=0.97, arms=0.98, breadth=0.95),
        _degrees(-1, 4, 10, 7, tempo=1.12, energy=1.10, arm_swing=1.25, stance=0.9, unrest=1.2),
    ),
    Actor(
        "dalia",
        Body.of(175.0, legs=1.04, arms=1.0, breadth=0.94),
        _degrees(0, 6, 12, 7, tempo=1.05, energy=1.15, arm_swing=1.1, stance=0.95),
    ),
    Actor(
        "emil",
        Body.of(179.0, legs=0.98, arms=1.02, breadth=1.12),
        _degrees(8, 13, 24, 13, tempo=0.93, energy=0.86, arm_swing=0.7, stance=1.25, unrest=1.3),
    ),
)
"""The actors of the library."""

GUEST = Actor(
    "freya",
    Body.of(172.0, legs=1.01, arms=0.99, breadth=1.03),
    _degrees(3, 9, 17, 10, tempo=1.03, energy=1.04, arm_swing=0.95, stance=1.08),
)
"""The actor of the performance, who is not in the library."""
