# SPDX-License-Identifier: GPL-3.0-or-later
"""What the checks of each system say about a compiled module."""

from collections.abc import Sequence
from dataclasses import dataclass, field

ENTRY = "PyInit__core"
"""All that a compiled module exports."""


@dataclass(frozen=True)
class Examined:
    """What a module asks of a system, and what is wrong with it."""

    system: str
    """The oldest system that loads it."""
    exported: tuple[str, ...]
    needed: tuple[str, ...]
    faults: list[str] = field(default_factory=list)


def export_faults(exported: Sequence[str]) -> list[str]:
    """A fault if more or less than the entry is exported."""
    if tuple(exported) == (ENTRY,):
        return []
    return [f"it exports {listed(exported)}, which must be {ENTRY} alone"]


def listed(names: Sequence[str]) -> str:
    """At most five of the names."""
    more = f" and {len(names) - 5} more" if len(names) > 5 else ""
    return (", ".join(names[:5]) or "nothing") + more
