# SPDX-License-Identifier: GPL-3.0-or-later
"""What must be true of compiled modules and archives before anybody gets them."""

import csv
import hashlib
import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .archives import Files, unzipped
from .elf import X86_64, Library, read_library
from .errors import PackagingError
from .wheels import record_hash

ENTRY = "PyInit__core"
NEWEST_GLIBC = (2, 28)
C_LIBRARIES = frozenset(
    {"libc.so.6", "libm.so.6", "libpthread.so.0", "libdl.so.2", "ld-linux-x86-64.so.2"}
)
"""What comes with every glibc; the last, its loader, gives each thread its own variables."""
MODULE_NAME = re.compile(r"(?:.*/)?(_core\.cpython-(\d)(\d+)-x86_64-linux-gnu\.so)")


@dataclass(frozen=True)
class CheckedModule:
    """A compiled module that may be handed out."""

    name: str
    size: int
    sha256: str
    newest_glibc: str
    exported: tuple[str, ...]
    needed: tuple[str, ...]


def python_tag(module: str) -> str:
    """The tag of the CPython that a module is for, such as ``cp311``, by the module's file name."""
    found = MODULE_NAME.fullmatch(module)
    if not found:
        raise PackagingError(f"{module} is not called as CPython on Linux x86-64 looks for it")
    return f"cp{found[2]}{found[3]}"


def checked_module(name: str, data: bytes, private: Sequence[str] = ()) -> CheckedModule:
    """Check a compiled module; PackagingError says all that is wrong with it.

    ``private`` are folders of the machine that built it: their names must not stand in it.
    """
    python_tag(name)
    try:
        library = read_library(data)
    except PackagingError as error:
        raise PackagingError(f"{name} is {error}") from error
    faults = _faults(library)
    faults += [
        f"it holds the name of the folder {path}" for path in private if path.encode() in data
    ]
    if faults:
        raise PackagingError("\n".join(f"{name}: {fault}" for fault in faults))
    newest = max(map(_glibc, library.versions), default=(0,))
    return CheckedModule(
        name=name,
        size=len(data),
        sha256=hashlib.sha256(data).hexdigest(),
        newest_glibc=".".join(map(str, newest)),
        exported=library.exported,
        needed=library.needed,
    )


def _faults(library: Library) -> list[str]:
    faults = []
    if library.machine != X86_64:
        faults.append("it is for another processor than x86-64")
    if library.exported != (ENTRY,):
        faults.append(f"it exports {_listed(library.exported)}, which must be {ENTRY} alone")
    if others := [name for name in library.needed if name not in C_LIBRARIES]:
        faults.append(f"it needs {_listed(others)}, which other machines may not have")
    if strange := [name for name in library.versions if not name.startswith("GLIBC_")]:
        faults.append(f"it needs {_listed(strange)}, which is not of the C library")
    glibc = [name for name in library.versions if name.startswith("GLIBC_")]
    if newer := [name for name in glibc if _glibc(name) > NEWEST_GLIBC]:
        allowed = ".".join(map(str, NEWEST_GLIBC))
        faults.append(f"it needs {_listed(newer)}, newer than glibc {allowed}")
    if library.names_folders:
        faults.append("it tells the loader where to look for libraries")
    if not library.stripped:
        faults.append("it still holds the symbols of the linker: strip it")
    return faults


def _glibc(version: str) -> tuple[int, ...]:
    """``GLIBC_2.2.5`` as numbers; a name without numbers is newer than all."""
    numbers = version.removeprefix("GLIBC_").split(".")
    return tuple(int(number) if number.isdigit() else 9999 for number in numbers)


def _listed(names: Sequence[str]) -> str:
    """At most five of the names."""
    more = f" and {len(names) - 5} more" if len(names) > 5 else ""
    return (", ".join(names[:5]) or "nothing") + more


def check_record(wheel: str, data: bytes) -> int:
    """Check that a wheel's RECORD lists just its files, truly; return how many it holds."""
    files = unzipped(data)
    records = [name for name in files if name.endswith(".dist-info/RECORD")]
    if len(records) != 1:
        raise PackagingError(f"{wheel} has {len(records)} files called RECORD")
    rows = [tuple(row) for row in csv.reader(io.StringIO(files[records[0]].decode()))]
    true: list[tuple[str, ...]] = [
        (name, f"sha256={record_hash(held)}", str(len(held)))
        for name, held in files.items()
        if name != records[0]
    ]
    true.append((records[0], "", ""))
    if wrong := sorted({row[0] for row in set(rows) ^ set(true)}):
        raise PackagingError(f"{wheel}: its RECORD is wrong about {_listed(wrong)}")
    if len(rows) != len(files):
        raise PackagingError(f"{wheel}: its RECORD names a file twice")
    return len(files)


def modules_in(archive: Files) -> dict[str, str]:
    """The hash of each compiled module in an archive, those in its wheels included."""
    found: dict[str, str] = {}
    for name, data in archive.items():
        if name.endswith(".whl"):
            found |= modules_in(unzipped(data))
        elif match := MODULE_NAME.fullmatch(name):
            found[match[1]] = hashlib.sha256(data).hexdigest()
    return found


def check_same_modules(modules: Sequence[CheckedModule], archives: Mapping[str, bytes]) -> None:
    """Check that every module in these zips is one of those checked, and that each holds one."""
    checked = {module.name: module.sha256 for module in modules}
    for name, data in archives.items():
        held = modules_in(unzipped(data))
        if not held:
            raise PackagingError(f"{name} holds no compiled module")
        if wrong := sorted(key for key, value in held.items() if checked.get(key) != value):
            raise PackagingError(f"{name} holds another {_listed(wrong)} than was built")
