# SPDX-License-Identifier: GPL-3.0-or-later
"""Other motions that the readings of a take leave possible, from Python and the command line."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from sparse_mocap import (
    MotionDatabase,
    Reconstruction,
    Take,
    read_motion,
    read_positions,
    read_take,
    reconstruct,
    write_take,
)

Cli = Callable[..., Result]


@pytest.fixture(scope="module")
def doubtful_path(take_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The take as one ankle's sensor alone measured it, which leaves much open."""
    path = tmp_path_factory.mktemp("doubtful") / "ankle.csv"
    write_take(path, Take({"right_ankle": read_take(take_path).sensors["right_ankle"]}))
    return path


@pytest.fixture(scope="module")
def solved(doubtful_path: Path, database: MotionDatabase) -> Reconstruction:
    take = read_take(doubtful_path)
    return reconstruct(take, database, best_quality=True, options={"alternatives": 2})


def distances_m(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The mean distance of the joints in each frame."""
    return np.linalg.norm(a - b, axis=2).mean(axis=1)


def check(apart_m: np.ndarray, rate_hz: float, parts: list[tuple[float, float, float]]) -> None:
    """Two motions are apart as told in these parts, and the same half a second away from them."""
    is_same = np.ones(len(apart_m), bool)
    for begin_s, end_s, distance_m in parts:
        begin, end = round(begin_s * rate_hz), round(end_s * rate_hz)
        assert apart_m[begin:end].mean() == pytest.approx(distance_m, abs=0.02)
        is_same[max(0, begin - round(0.5 * rate_hz)) : end + round(0.5 * rate_hz)] = False
    assert is_same.any()
    assert apart_m[is_same].max() < 1e-4


def test_an_alternative_differs_where_it_says(
    solved: Reconstruction, database: MotionDatabase
) -> None:
    assert solved.differences == []
    assert solved.alternatives
    count = len(database.skeleton.names)
    first = solved.motion.joint_positions("heading")[:, :count]
    for other in solved.alternatives:
        assert other.differences
        assert all(distance > 0.08 for _, _, distance in other.differences)
        assert other.motion.num_frames == solved.motion.num_frames
        assert other.contacts.shape == solved.contacts.shape
        assert set(other.diagnostics) == set(solved.diagnostics)
        assert other.alternatives == []
        positions = other.motion.joint_positions("heading")[:, :count]
        check(distances_m(first, positions), solved.rate_hz, other.differences)


def test_alternatives_must_be_asked_for(
    solved: Reconstruction, doubtful_path: Path, database: MotionDatabase
) -> None:
    plain = reconstruct(read_take(doubtful_path), database, best_quality=True)
    assert plain.alternatives == []
    np.testing.assert_array_equal(plain.motion.rotations, solved.motion.rotations)
    live = reconstruct(read_take(doubtful_path), database, options={"alternatives": 2})
    assert live.alternatives == []


def test_the_command_writes_alternatives_beside_the_output(
    cli: Cli, doubtful_path: Path, database_path: Path, tmp_path: Path
) -> None:
    out, table = tmp_path / "out.bvh", tmp_path / "table.csv"
    result = cli(
        "reconstruct", "--database", database_path, doubtful_path, "-o", out, "--offline",
        "--alternatives", 1, "--positions", table,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    lines = [line for line in result.stdout.splitlines() if "differs from" in line]
    assert [line.split(":")[0] for line in lines] == [str(tmp_path / "out_b.bvh")]
    parts = [
        (float(begin), float(end), 0.01 * float(cm))
        for begin, end, cm in re.findall(r"([\d.]+) to ([\d.]+) s \((\d+) cm\)", lines[0])
    ]
    times, _, first = read_positions(table)
    _, _, other = read_positions(tmp_path / "table_b.csv")
    check(distances_m(first, other), 1.0 / float(np.diff(times).mean()), parts)
    assert read_motion(tmp_path / "out_b.bvh")[0].num_frames == len(times)
    assert not (tmp_path / "out_c.bvh").exists()


def test_the_command_says_when_nothing_else_fits(
    cli: Cli, take_path: Path, database_path: Path, tmp_path: Path
) -> None:
    arguments = (
        "reconstruct", "--database", database_path, take_path, "-o", tmp_path / "out.bvh",
        "--alternatives", 2,
    )  # fmt: skip
    result = cli(*arguments, "--offline")
    assert result.exit_code == 0, result.output
    assert "No other motion fits the sensors almost as well." in result.stdout
    assert [path.name for path in tmp_path.iterdir()] == ["out.bvh"]
    assert cli(*arguments).exit_code == 2
    assert "--offline" in cli(*arguments).output
