# SPDX-License-Identifier: GPL-3.0-or-later
"""Names that Blender or Windows accept unchanged, and names as the panel shows them."""

from __future__ import annotations

import re

MOST_BYTES = 63

_NOT_ON_WINDOWS = re.compile(r'[<>:"/\\|?*\x00-\x1f]')
_DEVICES = re.compile(r"(?:con|prn|aux|nul|com\d|lpt\d)(?:\.|$)", re.IGNORECASE)


def fitting(names: list[str]) -> list[str]:
    """The names, shortened to Blender's limit and made unique by a number."""
    taken: set[str] = set()
    return [_free(name, taken) for name in names]


def file_name(name: str) -> str:
    """The name of a file or folder that is as much like this one as Windows allows."""
    allowed = _NOT_ON_WINDOWS.sub("_", name).rstrip(" .")
    return f"_{allowed}" if not allowed or _DEVICES.match(allowed) else allowed


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
