# SPDX-License-Identifier: GPL-3.0-or-later
"""The demonstration, all but what Blender does."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

FILES = {"database.smdb", "take.csv", "take.bvh", "performed.bvh", "errors.png"}


def demo(*arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "sparse_mocap_demo", *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
        stdin=subprocess.DEVNULL,
    )


def told_errors(output: str) -> tuple[float, float]:
    found = re.search(r"Error ([\d.]+) cm .*: ([\d.]+) cm", output)
    assert found is not None
    return float(found[1]), float(found[2])


def test_without_data_everything_is_made_here(tmp_path: Path) -> None:
    done = demo("--output", tmp_path, "--no-blender")
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert {path.name for path in tmp_path.iterdir()} >= FILES | {"library", "performance.bvh"}
    for name in FILES - {"database.smdb"}:
        assert str(tmp_path / name) in done.stdout
    error, oracle = told_errors(done.stdout)
    assert oracle < error
    recorded = re.search(r"Recorded (\d+) of (\d+) samples", done.stdout)
    assert recorded is not None
    assert 0.99 * int(recorded[2]) <= int(recorded[1]) <= int(recorded[2])


def test_with_data_a_clip_is_performed_that_the_database_lacks(
    library: Path, tmp_path: Path
) -> None:
    done = demo("--output", tmp_path, "--database", library, "--no-blender")
    assert done.returncode == 0, done.stderr
    performed = re.search(r"Performing (\S+),", done.stdout)
    assert performed is not None
    from sparse_mocap import MotionDatabase

    sources = {clip.source for clip in MotionDatabase(tmp_path / "database.smdb").clips}
    assert len(sources) == 11
    assert performed[1] not in sources
    assert (library / performed[1]).exists()
    assert {path.name for path in tmp_path.iterdir()} == FILES


@pytest.mark.parametrize("blender", ["/nonexistent/blender", sys.executable])
def test_without_a_working_blender_one_line_says_what_is_missing(
    library: Path, tmp_path: Path, blender: str
) -> None:
    done = demo("--output", tmp_path, "--database", library, "--blender", blender)
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1
    assert "Left out take.blend and figures.png" in done.stderr
    assert not (tmp_path / "take.blend").exists()


def test_a_folder_without_motion_is_one_line_and_code_1(tmp_path: Path) -> None:
    done = demo("--output", tmp_path / "out", "--database", tmp_path, "--no-blender")
    assert done.returncode == 1
    assert len(done.stderr.splitlines()) == 1
    assert str(tmp_path) in done.stderr


def test_wrong_usage_is_code_2() -> None:
    assert demo("--nothing").returncode == 2
