# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared libraries of a few lines that pass for compiled modules of the package."""

from __future__ import annotations

import itertools
import struct
import subprocess
from pathlib import Path

MODULE_311 = "_core.cpython-311-x86_64-linux-gnu.so"
MODULE_313 = "_core.cpython-313-x86_64-linux-gnu.so"
WINDOWS_311 = "_core.cp311-win_amd64.pyd"
WINDOWS_313 = "_core.cp313-win_amd64.pyd"
ENTRY = "int PyInit__core(void) { return %d; }\n"


def compiled(folder: Path, text: str, *options: str) -> bytes:
    """A shared library of a few lines of C, stripped, without the C library unless asked for."""
    source, built = folder / "module.c", folder / "module.so"
    source.write_text(text)
    command = ["cc", "-shared", "-fPIC", "-O1", "-s", "-o", built, source, *options]
    subprocess.run(command, check=True, cwd=folder)
    return built.read_bytes()


def small_modules(folder: Path) -> dict[str, bytes]:
    """Two modules for Linux."""
    names = (MODULE_311, MODULE_313)
    return {name: compiled(folder, ENTRY % i, "-nostdlib") for i, name in enumerate(names)}


def small_windows_modules() -> dict[str, bytes]:
    return {
        WINDOWS_311: windows_module("python311.dll"),
        WINDOWS_313: windows_module("python313.dll"),
    }


def windows_module(
    python: str,
    *,
    exported: tuple[str, ...] = ("PyInit__core",),
    more: tuple[str, ...] = (),
    machine: int = 0x8664,
    linked_at_s: int = 0,
    num_symbols: int = 0,
    text: bytes = b"",
) -> bytes:
    """A Windows library of one section that holds its two tables and no code."""
    section, address = _Section(0x1000), 0x1000
    imports = section.imports(("KERNEL32.dll", "msvcrt.dll", *more, python))
    exports = section.exports(exported)
    section.data += text
    directories = [exports, (imports, 20)] + [(0, 0)] * 14
    optional = struct.pack(
        "<HBBIIIIIQIIHHHHHHIIIIHHQQQQII",
        *(0x20B, 2, 40, 0, 0x400, 0, address, address, 0x180000000, 0x1000, 0x200),
        *(4, 0, 0, 0, 5, 2, 0, 0x2000, 0x200, 0, 3, 0x160, 1 << 20, 1 << 12, 1 << 20, 1 << 12),
        *(0, 16),
    ) + b"".join(struct.pack("<II", *one) for one in directories)
    head = b"MZ".ljust(0x3C, b"\0") + struct.pack("<I", 0x40) + b"PE\0\0"
    coff = struct.pack("<HHIIIHH", machine, 1, linked_at_s, 0, num_symbols, len(optional), 0x2022)
    size = len(section.data)
    row = struct.pack(
        "<8sIIIIIIHHI", b".rdata", size, address, 0x400, 0x200, 0, 0, 0, 0, 0x40000040
    )
    return (head + coff + optional + row).ljust(0x200, b"\0") + bytes(section.data.ljust(0x400))


class _Section:
    """Grows by tables; gives the addresses at which they are loaded."""

    def __init__(self, address: int) -> None:
        self.data = bytearray()
        self._address = address

    def add(self, data: bytes) -> int:
        at = self._address + len(self.data)
        self.data += data
        return at

    def imports(self, libraries: tuple[str, ...]) -> int:
        names = [self.add(name.encode() + b"\0") for name in libraries]
        empty = self.add(bytes(8))
        return self.add(b"".join(struct.pack("<IIIII", empty, 0, 0, name, empty)
                                 for name in names) + bytes(20))  # fmt: skip

    def exports(self, symbols: tuple[str, ...]) -> tuple[int, int]:
        """The table's address and size, with all that belongs to it."""
        start, count = self._address + len(self.data), len(symbols)
        functions, pointers, ordinals = (start + 40 + offset * count for offset in (0, 4, 8))
        texts = [name.encode() + b"\0" for name in (*sorted(symbols), "_core.pyd")]
        ends = list(itertools.accumulate(map(len, texts), initial=ordinals + 2 * count))
        *names, own = ends[:-1]
        head = (0, 0, 0, 0, own, 1, count, count, functions, pointers, ordinals)
        table = struct.pack("<IIHHIIIIIII", *head)
        table += struct.pack(f"<{2 * count}I{count}H", *names, *names, *range(count))
        self.data += table + b"".join(texts)
        return start, ends[-1] - start
