# SPDX-License-Identifier: GPL-3.0-or-later
"""What must be true of a module for Windows."""

from .examined import Examined, export_faults, listed
from .pe import X86_64, Library, read_library

SYSTEM_LIBRARIES = frozenset({"kernel32.dll", "msvcrt.dll"})
"""What comes with every Windows; names in small letters."""


def examine(data: bytes, python: str) -> Examined:
    """Check a module for a CPython such as ``cp311``; PackagingError when it is none."""
    library = read_library(data)
    return Examined(
        system="Windows",
        exported=library.exported,
        needed=library.needed,
        faults=_faults(library, f"python{python.removeprefix('cp')}.dll"),
    )


def _faults(library: Library, python_library: str) -> list[str]:
    faults = []
    if library.machine != X86_64:
        faults.append("it is for another processor than x86-64")
    faults += export_faults(library.exported)
    needed = {name.lower(): name for name in library.needed}
    if python_library not in needed:
        faults.append(f"it does not need {python_library}, which its name promises")
    if others := sorted(needed.keys() - SYSTEM_LIBRARIES - {python_library}):
        names = [needed[name] for name in others]
        faults.append(f"it needs {listed(names)}, which other machines may not have")
    if library.linked_at_s:
        faults.append("it holds the time at which it was linked: link it without")
    if not library.stripped:
        faults.append("it still holds the symbols of the linker: strip it")
    return faults
