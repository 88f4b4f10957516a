# SPDX-License-Identifier: GPL-3.0-or-later
"""What must be true of a module for Linux."""

from .elf import X86_64, Library, read_library
from .examined import Examined, export_faults, listed

NEWEST_GLIBC = (2, 28)
C_LIBRARIES = frozenset(
    {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "ld-linux-x86-64.so.2"}
)
"""What comes with every glibc; the last, its loader, gives each thread its own variables."""

PYTHON_NAMES = ("Py", "_Py")
"""How the names of CPython's functions begin."""


def examine(data: bytes, python: str) -> Examined:
    """Check a module; PackagingError when it is none."""
    library = read_library(data)
    newest = max(map(_glibc, library.versions), default=(0,))
    return Examined(
        system=f"glibc {'.'.join(map(str, newest))}",
        exported=library.exported,
        needed=library.needed,
        faults=_faults(library),
    )


def _faults(library: Library) -> list[str]:
    faults = []
    if library.machine != X86_64:
        faults.append("it is for another processor than x86-64")
    faults += export_faults(library.exported)
    if others := [name for name in library.needed if name not in C_LIBRARIES]:
        faults.append(f"it needs {listed(others)}, which other machines may not have")
    if lost := [name for name in library.from_anywhere if not name.startswith(PYTHON_NAMES)]:
        faults.append(f"it needs {listed(lost)}, which nothing it links has")
    if strange := [name for name in library.versions if not name.startswith("GLIBC_")]:
        faults.append(f"it needs {listed(strange)}, which is not of the C library")
    glibc = [name for name in library.versions if name.startswith("GLIBC_")]
    if newer := [name for name in glibc if _glibc(name) > NEWEST_GLIBC]:
        allowed = ".".join(map(str, NEWEST_GLIBC))
        faults.append(f"it needs {listed(newer)}, newer than glibc {allowed}")
    if library.names_folders:
        faults.append("it tells the loader where to look for libraries")
    if not library.stripped:
        faults.append("it still holds the symbols of the linker: strip it")
    return faults


def _glibc(version: str) -> tuple[int, ...]:
    """``GLIBC_2.2.5`` as numbers; a name without numbers is newer than all."""
    numbers = version.removeprefix("GLIBC_").split(".")
    return tuple(int(number) if number.isdigit() else 9999 for number in numbers)
