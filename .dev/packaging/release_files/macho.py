# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads from a macOS shared library what it exports and what it needs (Mach-O, 64 bit)."""

import struct
from collections.abc import Iterator
from dataclasses import dataclass

from .errors import PackagingError

ARM64 = 0x0100000C
MAGIC = b"\xcf\xfa\xed\xfe"
HEADER_SIZE = 32
# Load commands; the highest bit says that the loader must understand one.
SYMBOLS, LIBRARY, SIGNATURE, BUILD_VERSION = 0x2, 0xC, 0x1D, 0x32
OTHER_LIBRARIES = (0x80000018, 0x8000001F, 0x80000023)  # weak, re-exported, upward
LIBRARY_FOLDER, DYLD_INFO, EXPORTS = 0x8000001C, 0x80000022, 0x80000033
MERGES_SYMBOLS = 0x8000 | 0x10000  # MH_WEAK_DEFINES, MH_BINDS_TO_WEAK
ANY_LIBRARY = 0xFE  # a symbol that is looked up in whatever is loaded


@dataclass(frozen=True)
class Library:
    """What the loader sees of a shared library."""

    machine: int
    exported: tuple[str, ...]
    needed: tuple[str, ...]
    from_anywhere: tuple[str, ...]
    """The symbols that any library of the process may provide."""
    oldest_macos: tuple[int, int]
    names_folders: bool
    """Whether it tells the loader where to look for libraries."""
    is_signed: bool
    merges_symbols: bool
    """Whether its functions and those of that name in other libraries become one."""


def read_library(data: bytes) -> Library:
    """Read a shared library; PackagingError when it is none for one 64-bit processor."""
    if data[:4] != MAGIC:
        raise PackagingError("not a 64 bit Mach-O file")
    try:
        return _read(data)
    except (struct.error, IndexError, ValueError) as error:
        raise PackagingError(f"a damaged Mach-O file: {error}") from error


def _read(data: bytes) -> Library:
    _, machine, _, _, _, _, flags, _ = struct.unpack_from("<8I", data)
    commands = list(_commands(data))
    kinds = [kind for kind, _ in commands]
    exported: list[str] = []
    for kind, body in commands:
        if kind == DYLD_INFO:
            exported += _exported(data, *struct.unpack_from("<II", body, 40))
        elif kind == EXPORTS:
            exported += _exported(data, *struct.unpack_from("<II", body, 8))
    libraries = [body for kind, body in commands if kind in (LIBRARY, *OTHER_LIBRARIES)]
    (build,) = (body for kind, body in commands if kind == BUILD_VERSION)
    (symbols,) = (body for kind, body in commands if kind == SYMBOLS)
    (version,) = struct.unpack_from("<I", build, 12)
    return Library(
        machine=machine,
        exported=tuple(sorted(exported)),
        needed=tuple(_text(body, struct.unpack_from("<I", body, 8)[0]) for body in libraries),
        from_anywhere=tuple(sorted(_from_anywhere(data, symbols))),
        oldest_macos=(version >> 16, version >> 8 & 0xFF),
        names_folders=LIBRARY_FOLDER in kinds,
        is_signed=SIGNATURE in kinds,
        merges_symbols=bool(flags & MERGES_SYMBOLS),
    )


def _commands(data: bytes) -> Iterator[tuple[int, bytes]]:
    (count,) = struct.unpack_from("<I", data, 16)
    start = HEADER_SIZE
    for _ in range(count):
        kind, size = struct.unpack_from("<II", data, start)
        if size < 8 or start + size > len(data):
            raise ValueError("a load command goes beyond the end")
        yield kind, data[start : start + size]
        start += size


def _from_anywhere(data: bytes, command: bytes) -> Iterator[str]:
    table, count, names, size = struct.unpack_from("<4I", command, 8)
    text = data[names : names + size]
    for index in range(count):
        name, kind, _, description, _ = struct.unpack_from("<IBBHQ", data, table + 16 * index)
        is_undefined = kind & 0x0E == 0 and kind & 0xE0 == 0
        if is_undefined and description >> 8 == ANY_LIBRARY:
            yield _text(text, name)


def _exported(data: bytes, start: int, size: int) -> Iterator[str]:
    """The names in a trie: each node says whether a name ends there, and how it may go on."""
    trie = data[start : start + size]
    if len(trie) != size:
        raise ValueError("the list of exported symbols goes beyond the end")
    nodes = [(0, "")] if size else []
    seen = set()
    while nodes:
        place, name = nodes.pop()
        if place in seen:
            raise ValueError("the list of exported symbols has a loop")
        seen.add(place)
        length, place = _number(trie, place)
        if length:
            yield name
        place += length
        branches = trie[place]
        place += 1
        for _ in range(branches):
            more = _text(trie, place)
            child, place = _number(trie, place + len(more.encode()) + 1)
            nodes.append((child, name + more))


def _number(data: bytes, place: int) -> tuple[int, int]:
    """A number of seven bits a byte, lowest first, and where it ends."""
    value = shift = 0
    while True:
        byte = data[place]
        value |= (byte & 0x7F) << shift
        place, shift = place + 1, shift + 7
        if byte < 0x80:
            return value, place


def _text(data: bytes, start: int) -> str:
    return data[start : data.index(b"\0", start)].decode()
