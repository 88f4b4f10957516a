# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads from a Linux shared library what it exports and what it needs (ELF, 64 bit)."""

import struct
from collections.abc import Iterator
from dataclasses import dataclass

from .errors import PackagingError

X86_64 = 62
SYMBOLS, DYNAMIC, EXPORT_SYMBOLS, NEEDED_VERSIONS = 2, 6, 11, 0x6FFFFFFE
SYMBOL_VERSIONS = 0x6FFFFFFF
LIBRARY, LIBRARY_FOLDERS = 1, (15, 29)  # DT_NEEDED; DT_RPATH and DT_RUNPATH
LOCAL, GLOBAL = 0, 1
UNVERSIONED = (0, 1)


@dataclass(frozen=True)
class Library:
    """What the loader sees of a shared library."""

    machine: int
    exported: tuple[str, ...]
    needed: tuple[str, ...]
    versions: tuple[str, ...]
    """The versions of symbols that it asks of others, such as ``GLIBC_2.14``."""
    from_anywhere: tuple[str, ...]
    """The symbols that any library of the process may provide."""
    names_folders: bool
    """Whether it tells the loader where to look for libraries."""
    stripped: bool


@dataclass(frozen=True)
class _Section:
    kind: int
    data: bytes
    link: int
    count: int


def read_library(data: bytes) -> Library:
    """Read a shared library; PackagingError when it is none for 64 bit."""
    if data[:6] != b"\x7fELF\x02\x01":
        raise PackagingError("not a 64 bit ELF file")
    try:
        return _read(data)
    except (struct.error, IndexError, ValueError) as error:
        raise PackagingError(f"a damaged ELF file: {error}") from error


def _read(data: bytes) -> Library:
    sections = _sections(data)
    exported: list[str] = []
    needed: list[str] = []
    versions: list[str] = []
    names_folders = False
    from_anywhere: list[str] = []
    symbol_versions = next((one.data for one in sections if one.kind == SYMBOL_VERSIONS), b"")
    for section in sections:
        names = sections[section.link].data
        if section.kind == EXPORT_SYMBOLS:
            exported += _exported(section.data, names)
            from_anywhere += _from_anywhere(section.data, names, symbol_versions)
        elif section.kind == NEEDED_VERSIONS:
            versions += _needed_versions(section, names)
        elif section.kind == DYNAMIC:
            for tag, value in struct.iter_unpack("<qQ", section.data):
                names_folders |= tag in LIBRARY_FOLDERS
                if tag == LIBRARY:
                    needed.append(_text(names, value))
    return Library(
        machine=struct.unpack_from("<H", data, 18)[0],
        exported=tuple(sorted(exported)),
        needed=tuple(needed),
        versions=tuple(sorted(set(versions))),
        from_anywhere=tuple(sorted(from_anywhere)),
        names_folders=names_folders,
        stripped=not any(section.kind == SYMBOLS for section in sections),
    )


def _sections(data: bytes) -> list[_Section]:
    (start,) = struct.unpack_from("<Q", data, 40)
    size, count = struct.unpack_from("<HH", data, 58)
    found = []
    for index in range(count):
        _, kind, _, _, offset, length, link, number, _, _ = struct.unpack_from(
            "<IIQQQQIIQQ", data, start + index * size
        )
        found.append(_Section(kind, data[offset : offset + length], link, number))
    if not any(section.kind == DYNAMIC for section in found):
        raise ValueError("it has no dynamic section")
    return found


def _exported(symbols: bytes, names: bytes) -> Iterator[str]:
    for name, info, _, section, _, _ in struct.iter_unpack("<IBBHQQ", symbols):
        if section and info >> 4 != LOCAL:
            yield _text(names, name)


def _from_anywhere(symbols: bytes, names: bytes, versions: bytes) -> Iterator[str]:
    """What is not in the library, must be somewhere, and is not of a version of a library."""
    for index, symbol in enumerate(struct.iter_unpack("<IBBHQQ", symbols)):
        name, info, _, section, _, _ = symbol
        version = struct.unpack_from("<H", versions, 2 * index)[0] & 0x7FFF if versions else 0
        if name and not section and info >> 4 == GLOBAL and version in UNVERSIONED:
            yield _text(names, name)


def _needed_versions(section: _Section, names: bytes) -> Iterator[str]:
    """A list of libraries, each with a list of versions; both are linked by distances in bytes."""
    library = 0
    for _ in range(section.count):
        _, count, _, first, following = struct.unpack_from("<HHIII", section.data, library)
        version = library + first
        for _ in range(count):
            _, _, _, name, next_version = struct.unpack_from("<IHHII", section.data, version)
            yield _text(names, name)
            version += next_version
        library += following


def _text(names: bytes, start: int) -> str:
    return names[start : names.index(b"\0", start)].decode()
