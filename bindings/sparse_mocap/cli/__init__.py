# SPDX-License-Identifier: GPL-3.0-or-later
"""The command ``sparse-mocap``."""

from __future__ import annotations

import sys
from collections.abc import Sequence

__all__ = ["main"]

_EXTRA = ("click", "rich")


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command and returns its exit code: 0, 1 (wrong input) or 2 (wrong usage)."""
    try:
        from .app import run
    except ModuleNotFoundError as error:
        if error.name not in _EXTRA:
            raise
        print(
            f"sparse-mocap: the command line needs {error.name}; "
            "install it with: pip install 'sparse-mocap[cli]'",
            file=sys.stderr,
        )
        return 1
    return run(arguments)
