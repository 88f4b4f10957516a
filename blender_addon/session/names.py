# SPDX-License-Identifier: GPL-3.0-or-later
"""Names that Blender accepts unchanged, and names as the panel shows them."""

from __future__ import annotations

MOST_BYTES = 63


def fitting(names: list[str]) -> list[str]:
    """The names, shortened to Blender's limit and made unique by a number."""
    taken: set[str] = set()
    return [_free(name, taken) for name in names]


def _free(name: str, taken: set[str]) -> str:
    candidate, number = _shortened(name, MOST_BYTES), 0
    while candidate in taken:
        number += 1
        ending = f".{number:03}"
        candidate = _shortened(name, MOST_BYTES - len(ending)) + ending
    taken.add(candidate)
    return candidate


def _shortened(name: str, num_bytes: int) -> str:
    """The longest start of the name within that many bytes of UTF-8."""
    return name.encode(errors="replace")[:num_bytes].decode(errors="ignore")


def shown_site(site: str) -> str:
    """A sensor location as the panel shows it: Left Wrist."""
    return site.replace("_", " ").title()
