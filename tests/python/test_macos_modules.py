# SPDX-License-Identifier: GPL-3.0-or-later
"""What compiled modules for macOS must be like before `./dev package` hands them out."""

from __future__ import annotations

import struct
from typing import Any

import pytest
from release_files import checks, macho
from release_files.errors import PackagingError

MACOS_311 = "_core.cpython-311-darwin.so"


def mach_o(
    exported: bytes = b"_PyInit__core",
    library: bytes = b"/usr/lib/libSystem.B.dylib",
    undefined: bytes = b"_PyDict_New",
    machine: int = 0x0100000C,
    macos: tuple[int, int] = (11, 0),
    flags: int = 0x85,
    more: tuple[bytes, ...] = (),
    signature: bytes = struct.pack("<4I", 0x1D, 16, 0, 0),
) -> bytes:
    """A library for macOS with nothing but symbols, as Apple's headers lay it out.

    ``more`` are load commands, ``flags`` those of the header. What is exported is one name; it is
    found in two steps, after its first letter.
    """
    path = library + b"\0" * (8 - len(library) % 8)
    commands = [
        struct.pack("<6I", 0x32, 24, 1, macos[0] << 16 | macos[1] << 8, 0, 0),
        struct.pack("<6I", 0xC, 24 + len(path), 24, 0, 0, 0) + path,
        *more,
        *([signature] if signature else []),
    ]
    start = 32 + sum(map(len, commands)) + 24 + 48
    names = b"\0" + undefined + b"\0"
    symbols = struct.pack("<IBBHQ", 1, 0x01, 0, 0xFE << 8, 0)
    child = 2 + 2 + 1
    leaf = child + 2 + len(exported) - 1 + 2
    trie = b"\0\1" + exported[:1] + b"\0" + bytes([child])
    trie += b"\0\1" + exported[1:] + b"\0" + bytes([leaf]) + b"\2\0\x40\0"
    symbol_table = struct.pack("<6I", 0x2, 24, start, 1, start + 16, len(names))
    trie_start = start + 16 + len(names)
    loader = struct.pack("<12I", 0x80000022, 48, *[0] * 8, trie_start, len(trie))
    commands += [symbol_table, loader]
    size = sum(map(len, commands))
    header = struct.pack("<8I", 0xFEEDFACF, machine, 0, 8, len(commands), size, flags, 0)
    return header + b"".join(commands) + symbols + names + trie


def test_a_module_for_macos_passes() -> None:
    found = checks.checked_module(MACOS_311, mach_o())
    assert found.system == "macOS 11.0"
    assert found.exported == ("PyInit__core",)
    assert found.needed == ("/usr/lib/libSystem.B.dylib",)


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"exported": b"__Znwm"}, "it exports _Znwm, which must be PyInit__core alone"),
        ({"library": b"/usr/lib/libc++.1.dylib"}, r"it needs /usr/lib/libc\+\+\.1\.dylib, which"),
        ({"undefined": b"_cblas_dgemm"}, "it needs _cblas_dgemm, which nothing it links has"),
        ({"machine": 0x01000007}, "it is for another processor"),
        ({"macos": (13, 3)}, r"it needs macOS 13\.3, newer than 11\.0"),
        ({"flags": 0x85 | 0x8000}, "functions of it and of other libraries may become one"),
        ({"flags": 0x85 | 0x10000}, "functions of it and of other libraries may become one"),
        ({"more": (struct.pack("<4I", 0x8000001C, 16, 12, 0),)}, "tells the loader where to look"),
        ({"signature": b""}, "it is not signed"),
    ],
)
def test_a_module_that_other_macs_cannot_use_is_refused(change: dict[str, Any], fault: str) -> None:
    with pytest.raises(PackagingError, match=f"^{MACOS_311}: .*{fault}"):
        checks.checked_module(MACOS_311, mach_o(**change))


def test_a_weak_library_is_seen_too() -> None:
    path = b"/usr/lib/libz.dylib\0\0\0\0\0"
    weak = struct.pack("<6I", 0x80000018, 24 + len(path), 24, 0, 0, 0) + path
    assert macho.read_library(mach_o(more=(weak,))).needed[1] == "/usr/lib/libz.dylib"


@pytest.mark.parametrize("length", [0, 3, 20, 40, 150, 200, len(mach_o()) - 1])
def test_a_damaged_module_for_macos_is_refused(length: int) -> None:
    with pytest.raises(PackagingError, match=r"is (not|a damaged)"):
        checks.checked_module(MACOS_311, mach_o()[:length])


def test_symbols_that_lead_in_a_circle_are_refused() -> None:
    whole = mach_o()
    with pytest.raises(PackagingError, match="has a loop"):
        checks.checked_module(
            MACOS_311, whole.replace(b"PyInit__core\0", b"PyInit__core\0\0", 1)[:-1]
        )
