# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared libraries of a few lines that pass for compiled modules of the package."""

from __future__ import annotations

import subprocess
from pathlib import Path

MODULE_311 = "_core.cpython-311-x86_64-linux-gnu.so"
MODULE_313 = "_core.cpython-313-x86_64-linux-gnu.so"
ENTRY = "int PyInit__core(void) { return %d; }\n"


def compiled(folder: Path, text: str, *options: str) -> bytes:
    """A shared library of a few lines of C, stripped, without the C library unless asked for."""
    source, built = folder / "module.c", folder / "module.so"
    source.write_text(text)
    command = ["cc", "-shared", "-fPIC", "-O1", "-s", "-o", built, source, *options]
    subprocess.run(command, check=True, cwd=folder)
    return built.read_bytes()


def small_modules(folder: Path) -> dict[str, bytes]:
    names = (MODULE_311, MODULE_313)
    return {name: compiled(folder, ENTRY % i, "-nostdlib") for i, name in enumerate(names)}
