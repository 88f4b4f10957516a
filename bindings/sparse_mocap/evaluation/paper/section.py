# SPDX-License-Identifier: GPL-3.0-or-later
"""One part of the paper's evaluation, ready to be written and drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

__all__ = ["Bars", "Lines", "Matrix", "Plot", "Section", "Table"]


@dataclass(frozen=True)
class Table:
    """Figures; the first column holds names."""

    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]


@dataclass(frozen=True)
class Lines:
    """Curves: x and y by label."""

    title: str
    xlabel: str
    ylabel: str
    curves: Mapping[str, tuple[Sequence[float], Sequence[float]]]
    is_logarithmic: bool = False
    has_steps: bool = False
    has_points: bool = True


@dataclass(frozen=True)
class Bars:
    """Groups of bars: heights by label, and by the group's name."""

    title: str
    ylabel: str
    groups: Mapping[str, Mapping[str, float]]


@dataclass(frozen=True)
class Matrix:
    """A table in colours; NaN is left blank."""

    title: str
    rows: Sequence[str]
    columns: Sequence[str]
    values: Sequence[Sequence[float]]


Plot = Lines | Bars | Matrix


@dataclass
class Section:
    """What a part of the evaluation found."""

    title: str
    paper: str
    """What the paper's text says."""
    method: str
    """How it was measured here."""
    findings: list[str] = field(default_factory=list)
    """Sentences with figures."""
    tables: list[Table] = field(default_factory=list)
    plots: dict[str, Plot] = field(default_factory=dict)
    """By the names of their files."""
    num_clips: list[int] = field(default_factory=list)
    """How many clips its evaluations test, sorted."""
