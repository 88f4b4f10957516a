# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads from a Windows library what it exports and what it needs (PE, 64 bit)."""

import struct
from collections.abc import Iterator
from dataclasses import dataclass

from .errors import PackagingError

X86_64 = 0x8664
PE32_PLUS = 0x20B
EXPORTS, IMPORTS = 0, 1
DIRECTORIES = 112
"""Where in the optional header the directories begin."""


@dataclass(frozen=True)
class Library:
    """What Windows sees of a library."""

    machine: int
    linked_at_s: int
    exported: tuple[str, ...]
    needed: tuple[str, ...]
    stripped: bool


@dataclass(frozen=True)
class _Section:
    address: int
    size: int
    offset: int


def read_library(data: bytes) -> Library:
    """Read a library; PackagingError when it is none for 64 bit."""
    try:
        return _read(data)
    except (struct.error, IndexError, ValueError) as error:
        raise PackagingError(f"a damaged PE file: {error}") from error


def _read(data: bytes) -> Library:
    if data[:2] != b"MZ":
        raise PackagingError("not a PE file")
    (start,) = struct.unpack_from("<I", data, 0x3C)
    if data[start : start + 4] != b"PE\0\0":
        raise PackagingError("not a PE file")
    machine, num_sections, linked_at_s, _, num_symbols, header_size = struct.unpack_from(
        "<HHIIIH", data, start + 4
    )
    header = start + 24
    if struct.unpack_from("<H", data, header) != (PE32_PLUS,):
        raise PackagingError("not a 64 bit PE file")
    sections = list(_sections(data, header + header_size, num_sections))
    exports, imports = (
        struct.unpack_from("<I", data, header + DIRECTORIES + 8 * index)[0]
        for index in (EXPORTS, IMPORTS)
    )
    return Library(
        machine=machine,
        linked_at_s=linked_at_s,
        exported=tuple(_exported(data, sections, exports)) if exports else (),
        needed=tuple(_needed(data, sections, imports)) if imports else (),
        stripped=num_symbols == 0,
    )


def _sections(data: bytes, at: int, count: int) -> Iterator[_Section]:
    for index in range(count):
        size, address, in_file, offset = struct.unpack_from("<IIII", data, at + 40 * index + 8)
        yield _Section(address, max(size, in_file), offset)


def _exported(data: bytes, sections: list[_Section], address: int) -> Iterator[str]:
    at = _offset(sections, address)
    (count,) = struct.unpack_from("<I", data, at + 24)
    (names,) = struct.unpack_from("<I", data, at + 32)
    if count:
        for name in struct.unpack_from(f"<{count}I", data, _offset(sections, names)):
            yield _text(data, _offset(sections, name))


def _needed(data: bytes, sections: list[_Section], address: int) -> Iterator[str]:
    at = _offset(sections, address)
    while name := struct.unpack_from("<I", data, at + 12)[0]:
        yield _text(data, _offset(sections, name))
        at += 20


def _offset(sections: list[_Section], address: int) -> int:
    """Where in the file the byte is that is loaded at the address."""
    for section in sections:
        if section.address <= address < section.address + section.size:
            return section.offset + address - section.address
    raise ValueError(f"no section holds the address {address:#x}")


def _text(data: bytes, at: int) -> str:
    return data[at : data.index(b"\0", at)].decode("ascii")
