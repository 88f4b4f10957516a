# SPDX-License-Identifier: GPL-3.0-or-later
"""What threads keep for themselves, as the core's workspaces, when they end on Windows."""

from __future__ import annotations

import subprocess
from pathlib import Path

from conftest import ROOT, Windows

COMPILER = "x86_64-w64-mingw32-g++-posix"
RUN = "import subprocess, sys; print(subprocess.check_output(sys.argv[1:], text=True))"


def test_what_a_thread_kept_is_whole_when_it_is_destroyed(windows: Windows, tmp_path: Path) -> None:
    program = tmp_path / "kept.exe"
    sources = (
        ROOT / "tests" / "windows" / "kept_by_threads.cpp",
        ROOT / "core" / "sparse_mocap" / "base" / "thread_exit_mingw.cpp",
    )
    subprocess.run([COMPILER, "-std=c++20", "-static", *sources, "-o", program], check=True)
    assert windows("-c", RUN, program).split() == ["whole"] * 4
