# SPDX-License-Identifier: GPL-3.0-or-later
"""What a bug report says of an installation, without names of people; needs no bpy, no NumPy."""

from __future__ import annotations

import platform
import sys
from pathlib import Path

from . import log_file
from .installation import Problem, compiled_modules, one_python_line, this_host
from .installation_paths import PACKAGE, addon_version, entries_with_package, home_hidden

_NUM_LOG_LINES = 60


def report(
    problem: Problem | None,
    addon: Path,
    addon_name: str,
    searched: list[Path],
    facts: tuple[str, ...] = (),
) -> str:
    """The lines of the report.

    problem: None where everything works. facts: what is open and chosen, one line each.
    addon: the add-on's folder. addon_name: the name by which Blender enables it.
    searched: the folders in which the package that belongs to it may be.
    """
    host = this_host()
    bits = 64 if sys.maxsize > 2**32 else 32
    numpy = sys.modules.get("numpy")
    compiled = sys.modules.get(f"{PACKAGE}._core")
    lines = [
        f"Sparse Mocap {addon_version(addon) or '(unknown version)'} as {addon_name} in {addon}",
        f"Blender {host.blender or 'none'}",
        f"Python {platform.python_version()}, {bits}-bit, for {host.target.place}",
        f"System {platform.platform()}, machine {platform.machine()}",
        f"NumPy {getattr(numpy, '__version__', 'not loaded')}",
        f"Compiled core {getattr(compiled, '__version__', 'not loaded')}",
        f"Reason: {problem.reason}" if problem is not None else "The add-on works",
        *facts,
    ]
    if problem is not None and problem.error is not None:
        lines.append(f"Python said: {one_python_line(problem.error)}")
    lines += ["Looked in:", *(_described(folder / PACKAGE) for folder in searched)]
    lines += ["Found by Python's search path:", *map(_described, entries_with_package())]
    logged = log_file.last_lines(_NUM_LOG_LINES)
    if logged:
        lines += ["Log:", *logged]
    return home_hidden("\n".join(lines))


def _described(package: Path) -> str:
    """The package's folder, and the compiled modules in it."""
    if not package.is_dir():
        return f"  {package}: not there"
    return f"  {package}: {', '.join(compiled_modules(package)) or 'no compiled module'}"
