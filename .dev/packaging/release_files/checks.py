# SPDX-License-Identifier: GPL-3.0-or-later
"""What must be true of compiled modules and archives before anybody gets them."""

import csv
import hashlib
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .archives import Files, unzipped
from .errors import PackagingError
from .examined import listed
from .targets import is_module, target_of
from .wheels import record_hash


@dataclass(frozen=True)
class CheckedModule:
    """A compiled module that may be handed out."""

    name: str
    size: int
    sha256: str
    system: str
    """The oldest that loads it."""
    exported: tuple[str, ...]
    needed: tuple[str, ...]


def checked_module(name: str, data: bytes, private: Sequence[str] = ()) -> CheckedModule:
    """Check a compiled module; PackagingError says all that is wrong with it.

    ``private`` are folders of the machine that built it: their names must not stand in it.
    """
    target, python = target_of(name)
    try:
        found = target.examine(data, python)
    except PackagingError as error:
        raise PackagingError(f"{name} is {error}") from error
    faults = found.faults + [
        f"it holds the name of the folder {path}" for path in private if path.encode() in data
    ]
    if faults:
        raise PackagingError("\n".join(f"{name}: {fault}" for fault in faults))
    return CheckedModule(
        name=name,
        size=len(data),
        sha256=hashlib.sha256(data).hexdigest(),
        system=found.system,
        exported=found.exported,
        needed=found.needed,
    )


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
        raise PackagingError(f"{wheel}: its RECORD is wrong about {listed(wrong)}")
    if len(rows) != len(files):
        raise PackagingError(f"{wheel}: its RECORD names a file twice")
    return len(files)


def modules_in(archive: Files) -> dict[str, str]:
    """The hash of each compiled module in an archive, those in its wheels included."""
    found: dict[str, str] = {}
    for name, data in archive.items():
        if name.endswith(".whl"):
            found |= modules_in(unzipped(data))
        elif is_module(file := name.rpartition("/")[2]):
            found[file] = hashlib.sha256(data).hexdigest()
    return found


def check_same_modules(modules: Sequence[CheckedModule], archives: Mapping[str, bytes]) -> None:
    """Check that every module in these zips is one of those checked, and that each holds one."""
    checked = {module.name: module.sha256 for module in modules}
    for name, data in archives.items():
        held = modules_in(unzipped(data))
        if not held:
            raise PackagingError(f"{name} holds no compiled module")
        if wrong := sorted(key for key, value in held.items() if checked.get(key) != value):
            raise PackagingError(f"{name} holds another {listed(wrong)} than was built")
