# SPDX-License-Identifier: GPL-3.0-or-later
"""JSON objects whose keys occur once."""

from __future__ import annotations

from typing import Any

__all__ = ["unique_keys"]


def unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Returns the object, as json's ``object_pairs_hook``. Raises ValueError for a repeated key."""
    found: dict[str, Any] = {}
    for key, value in pairs:
        if key in found:
            raise ValueError(f"repeats the key {key!r}")
        found[key] = value
    return found
