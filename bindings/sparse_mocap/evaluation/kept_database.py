# SPDX-License-Identifier: GPL-3.0-or-later
"""Databases that evaluations build once and keep."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from pathlib import Path
from typing import Any

from .. import _core, build_database, mapping_folder
from .protocol import motion_files

__all__ = ["fingerprint", "kept_database"]

DEFAULT_RATE_HZ = 25.0


def kept_database(
    sources: Sequence[Path],
    folder: Path,
    *,
    rate_hz: float = DEFAULT_RATE_HZ,
    progress: Callable[[int, int, str], bool | None] | None = None,
    workers: Executor | None = None,
    **options: Any,
) -> Path:
    """Returns the path of the sources' database with mirrored copies, built if it is not there.

    It is built anew when a file, an option of build_database() or this package has changed.
    """
    folder.mkdir(parents=True, exist_ok=True)
    rate = "" if rate_hz == DEFAULT_RATE_HZ else f"{rate_hz:g}_hz_"
    marks = "".join(f"{name}_" for name, value in sorted(options.items()) if value is True)
    path = folder.absolute() / f"evaluation_{rate}{marks}{fingerprint(sources, options)}.smdb"
    if not path.exists():
        build_database(
            sources,
            path,
            rate_hz=rate_hz,
            mirror=True,
            mappings=mapping_folder(),
            progress=progress,
            workers=workers,
            **options,
        )
    return path


def fingerprint(sources: Sequence[Path], options: Any = None) -> str:
    """Returns what tells these files, as they are now, from others."""
    seen: list[Any] = []
    for source in sources:
        files = {path for same_name in motion_files(source).values() for path in same_name}
        files |= set(source.rglob("*.[aA][sS][fF]"))
        seen += [
            [str(path), path.stat().st_size, path.stat().st_mtime_ns] for path in sorted(files)
        ]
    core = Path(_core.__file__)  # another version may build a different database
    seen.append([str(core), core.stat().st_size, core.stat().st_mtime_ns])
    if options:
        seen.append(sorted(options.items()))
    return hashlib.sha256(json.dumps(seen).encode()).hexdigest()[:12]
