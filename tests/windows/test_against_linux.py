# SPDX-License-Identifier: GPL-3.0-or-later
"""What Windows makes of the same files as Linux."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from conftest import Windows
from solve import main as solve
from sparse_mocap.demo_motions import generate_library, generate_performance

HERE = Path(__file__).resolve().parent
FARTHEST_M = 1e-9


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("files")
    library = folder / "library"
    library.mkdir()
    for path in generate_library(folder / "all")[::10]:
        shutil.copy(path, library)
    return library, generate_performance(folder / "performance.bvh")


@pytest.fixture(scope="module")
def on_linux(files: tuple[Path, Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("linux") / "solved.npz"
    solve(*files, path)
    return path


def test_positions_are_those_of_linux(
    windows: Windows, files: tuple[Path, Path], on_linux: Path, tmp_path: Path
) -> None:
    print(windows(HERE / "solve.py", *files, tmp_path / "solved.npz"))
    here, there = np.load(on_linux), np.load(tmp_path / "solved.npz")
    assert set(here) == set(there)
    assert here["clips"] == there["clips"]
    np.testing.assert_array_equal(here["take"], there["take"])
    for name in sorted(set(here) - {"clips", "take"}):
        error = np.abs(here[name].astype(float) - there[name]).max()
        print(f"{name}: {error:.1e}")
        assert here[name].size > 1000
        assert error <= FARTHEST_M, name
