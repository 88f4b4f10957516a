# SPDX-License-Identifier: GPL-3.0-or-later
"""Which clips of a database show the same recorded movement, found by what they show.

A take may be in a database twice, under another name, cut out of a longer one, recorded at another
rate, mirrored or played backwards. Whatever its files are called, the poses are the same.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .. import MotionDatabase
from .protocol import is_copy

__all__ = ["SameMotion", "same_motion", "seen_in_a_mirror"]

Floats = NDArray[np.float64]

TOLERANCE_M = 0.01
"""RMS over the joints; repeated movements of a performer are two to five times as far apart."""
LEAST_SHARE = 0.5
"""Of the shorter one of two clips that must be in the other, for them to be of one recording."""
LEAST_SPREAD_M = 0.03
"""Of the joints in what two clips share: poses held still are alike without being the same."""


class SameMotion:
    """The recorded clips of a database, and how to find the same movement among them."""

    def __init__(
        self, positions: Floats, clips: Sequence[tuple[int, int, str]], names: Sequence[str]
    ) -> None:
        """Takes rows (N, 3 J) m, heading frame, and (begin, end, source) of the clips to search."""
        self._positions, self._names = positions, list(names)
        self._clips = list(clips)
        self._sources: dict[tuple[int, int], frozenset[str]] = {}
        self._tolerance = len(names) * TOLERANCE_M**2

    def sources_with(self, begin: int, end: int) -> frozenset[str]:
        """Returns the files that hold the movement of these rows, or that it holds."""
        if (begin, end) not in self._sources:
            self._sources[begin, end] = self._found(self._positions[begin:end].astype(float))
        return self._sources[begin, end]

    def _found(self, movement: Floats) -> frozenset[str]:
        mirrored = seen_in_a_mirror(movement, self._names)
        found = set()
        for begin, end, source in self._clips:
            rows = self._positions[begin:end].astype(float)
            if any(self._is_same(one, rows) for one in (movement, mirrored)):
                found.add(source)
        return frozenset(found)

    def _is_same(self, one: Floats, other: Floats) -> bool:
        """Whether enough of the shorter clip's poses lie on the way that the longer one takes.

        Poses on the way, in whatever order: so neither rate, tempo nor direction matter.
        """
        shorter, longer = (one, other) if len(one) <= len(other) else (other, one)
        squares = _squares(shorter, longer)
        if squares.min() > _REACH * self._tolerance:
            return False
        shared = _squares_to_way(squares, longer) <= self._tolerance
        if shared.mean() < LEAST_SHARE:
            return False
        spread = shorter[shared].std(axis=0)
        return bool(np.sqrt(np.sum(spread**2) / len(self._names)) > LEAST_SPREAD_M)


_REACH = 100.0
"""No two frames of a clip are so far apart that a pose between them is ten tolerances from both."""


def _squares(one: Floats, other: Floats) -> Floats:
    """Returns the squared distances (M, N) between poses."""
    squares = (one**2).sum(1)[:, None] + (other**2).sum(1)[None, :] - 2.0 * one @ other.T
    return np.asarray(np.maximum(squares, 0.0))


def _squares_to_way(squares: Floats, way: Floats) -> Floats:
    """Returns how near poses (M,) come to the line through others, from their squares (M, N)."""
    if len(way) < 2:
        return np.asarray(squares.min(axis=1))
    steps = np.maximum(((way[1:] - way[:-1]) ** 2).sum(1), 1e-12)
    before, after = squares[:, :-1], squares[:, 1:]
    along = (before - after + steps) / (2.0 * steps)
    part = np.clip(along, 0.0, 1.0)
    return np.asarray((before - (2.0 * along - part) * part * steps).min(axis=1))


def seen_in_a_mirror(positions: Floats, names: Sequence[str]) -> Floats:
    """Returns poses (T, 3 J) with left and right exchanged; x points to the left."""
    names = list(names)
    other = {"l": "r", "r": "l"}
    partners = []
    for name in names:
        swapped = other.get(name[0], name[0]) + name[1:]
        partners.append(names.index(swapped) if swapped in names else names.index(name))
    turned = positions.reshape(len(positions), -1, 3)[:, partners]
    return np.asarray((turned * [-1.0, 1.0, 1.0]).reshape(len(positions), -1))


def same_motion(database: MotionDatabase) -> SameMotion:
    """Returns the search among a database's recorded clips, made once for its rows."""
    rows = database.rows_hash
    if rows not in _made:
        if len(_made) == _MOST_KEPT:
            del _made[next(iter(_made))]
        _made[rows] = SameMotion(
            np.asarray(database.array("positions")),
            [(clip.begin, clip.end, clip.source) for clip in database.clips if not is_copy(clip)],
            list(database.skeleton.names),
        )
    return _made[rows]


_MOST_KEPT = 4
_made: dict[str, SameMotion] = {}
"""By the databases' rows; an open database is not kept, so that its file can be removed."""
