# SPDX-License-Identifier: GPL-3.0-or-later
"""The demonstration: simulated sensors on a motion, reconstructed and shown in Blender.

``python -m sparse_mocap_demo [--database DIR] [--output DIR]``
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the demonstration; returns 0, 1 (something is at fault or was left out) or 2 (usage)."""
    options = _options(arguments)
    try:
        import click
        from sparse_mocap.cli.faults import as_faults

        from .story import play
    except ImportError as error:
        print(f"demo: {error}{_remedy(error)}", file=sys.stderr)
        return 1
    try:
        with as_faults():
            return play(options.output, options.database, options.blender, not options.no_blender)
    except click.ClickException as fault:
        fault.show()
        return fault.exit_code


def _remedy(error: ImportError) -> str:
    is_extra = (error.name or "").partition(".")[0] in ("click", "matplotlib", "rich")
    return "; install it with: pip install 'sparse-mocap[cli]'" if is_extra else ""


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m sparse_mocap_demo", description=__doc__)
    parser.add_argument(
        "--database",
        type=Path,
        metavar="DIR",
        help="motion capture to use; one clip of it is performed and left out. "
        "Without it motions are generated.",
    )
    parser.add_argument(
        "--output",
        type=Path,
        metavar="DIR",
        default=Path("demo"),
        help="where the results go (default: %(default)s)",
    )
    parser.add_argument(
        "--blender",
        type=Path,
        metavar="PATH",
        help="the Blender to use (default: $BLENDER or PATH)",
    )
    parser.add_argument(
        "--no-blender", action="store_true", help="leave out the Blender file and the picture"
    )
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main())
