# SPDX-License-Identifier: GPL-3.0-or-later
"""What must be true of a module for macOS on Apple's processors."""

from .examined import Examined, export_faults, listed
from .macho import ARM64, Library, read_library

NEWEST_MACOS = (11, 0)
SYSTEM = "/usr/lib/libSystem.B.dylib"
"""The C library; what else a system has differs from one to the next."""
PYTHON_NAMES = ("_Py", "__Py")
"""How the names of CPython's functions begin; macOS puts one more _ before every name."""


def examine(data: bytes, python: str) -> Examined:
    """Check a module; PackagingError when it is none."""
    library = read_library(data)
    exported = tuple(name.removeprefix("_") for name in library.exported)
    return Examined(
        system=f"macOS {_version(library.oldest_macos)}",
        exported=exported,
        needed=library.needed,
        faults=export_faults(exported) + _faults(library),
    )


def _faults(library: Library) -> list[str]:
    faults = []
    if library.machine != ARM64:
        faults.append("it is for another processor than Apple's own")
    if others := [name for name in library.needed if name != SYSTEM]:
        faults.append(f"it needs {listed(others)}, which other machines may not have")
    if strange := [name for name in library.from_anywhere if not name.startswith(PYTHON_NAMES)]:
        faults.append(f"it needs {listed(strange)}, which nothing it links has")
    if library.oldest_macos > NEWEST_MACOS:
        needed, allowed = _version(library.oldest_macos), _version(NEWEST_MACOS)
        faults.append(f"it needs macOS {needed}, newer than {allowed}")
    if library.names_folders:
        faults.append("it tells the loader where to look for libraries")
    if library.merges_symbols:
        faults.append("functions of it and of other libraries may become one")
    if not library.is_signed:
        faults.append("it is not signed, and these Macs load only what is")
    return faults


def _version(numbers: tuple[int, int]) -> str:
    return ".".join(map(str, numbers))
