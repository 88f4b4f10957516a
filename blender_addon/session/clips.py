# SPDX-License-Identifier: GPL-3.0-or-later
"""The clips of a motion database as a list to search and sort."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

SORT_KEYS = ("name", "length", "actor")


@dataclass(frozen=True)
class ClipRow:
    """A clip in the list."""

    name: str
    actor: str
    motion_class: str
    length_s: float
    copy: str
    """How it differs from the recorded clip ("mirrored, 0.8x"); empty for the recorded one."""

    @property
    def label(self) -> str:
        """The name, and for a copy which kind."""
        return f"{self.name} ({self.copy})" if self.copy else self.name


class ClipTable:
    """All clips of a database, in the database's order."""

    def __init__(self, rows: Sequence[ClipRow]) -> None:
        self.rows = tuple(rows)
        self._texts = [f"{row.name} {row.actor} {row.motion_class}".lower() for row in self.rows]
        self.chosen = lru_cache(maxsize=16)(self._chosen)
        self.order = lru_cache(maxsize=16)(self._order)

    @property
    def has_copies(self) -> bool:
        """Whether some clips are mirrored, reversed or at another tempo."""
        return any(row.copy for row in self.rows)

    def _chosen(self, text: str, shows_copies: bool) -> tuple[bool, ...]:
        """For each clip, whether its name, actor or class contains all words of the text."""
        words = text.lower().split()
        return tuple(
            (shows_copies or not row.copy) and all(word in known for word in words)
            for row, known in zip(self.rows, self._texts, strict=True)
        )

    def _order(self, key: str) -> tuple[int, ...]:
        """For each clip, its rank when sorted by name, length or actor."""
        columns: dict[str, Callable[[ClipRow], tuple[str, ...] | tuple[float]]] = {
            "name": lambda row: (row.label.lower(),),
            "length": lambda row: (row.length_s,),
            "actor": lambda row: (row.actor.lower(), row.label.lower()),
        }
        value = columns[key]
        ranked = sorted(range(len(self.rows)), key=lambda index: value(self.rows[index]))
        ranks = [0] * len(ranked)
        for rank, index in enumerate(ranked):
            ranks[index] = rank
        return tuple(ranks)


def table_of(clips: Sequence[Any], rate_hz: float) -> ClipTable:
    """The table of a database's clips (sparse_mocap.Clip)."""
    return ClipTable(
        [
            ClipRow(
                name=clip.name,
                actor=clip.actor,
                motion_class=clip.motion_class,
                length_s=(clip.end - clip.begin) / rate_hz,
                copy=_copy_of(clip),
            )
            for clip in clips
        ]
    )


def _copy_of(clip: Any) -> str:
    parts = ["mirrored"] if clip.is_mirrored else []
    if clip.is_reversed:
        parts.append("reversed")
    if clip.tempo != 1.0:
        parts.append(f"{clip.tempo:g}x")
    return ", ".join(parts)
