# SPDX-License-Identifier: GPL-3.0-or-later
"""Batches: many takes, each solved once, one bad take leaving the others."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
import sparse_mocap
from click.testing import Result
from sparse_mocap.batch import BatchSettings, Solved, outputs, solve_batch
from sparse_mocap.databases import content_hash
from sparse_mocap.workers import processors

Cli = Callable[..., Result]


@pytest.fixture
def takes(tmp_path: Path, take_path: Path) -> Path:
    """A folder with two takes, one of them in a folder of its own, and a file that is none."""
    folder = tmp_path / "takes"
    (folder / "day 2").mkdir(parents=True)
    shutil.copy(take_path, folder / "first.csv")
    lines = take_path.read_text(encoding="utf-8").splitlines(keepends=True)
    (folder / "day 2" / "second.csv").write_text("".join(lines[: len(lines) // 2]), "utf-8")
    (folder / "broken.csv").write_text("time_s,sensor\nno,number\n", "utf-8")
    return folder


def test_solves_all_takes_but_the_broken_one(
    cli: Cli, tmp_path: Path, takes: Path, database_path: Path
) -> None:
    result = cli("batch", takes, "-o", tmp_path / "out", "--database", database_path)
    assert result.exit_code == 1
    assert "1 of 3 takes were not solved" in result.output
    (broken,) = [line for line in result.output.splitlines() if line.startswith("not solved")]
    assert "broken.csv" in broken
    made = sorted(
        p.relative_to(tmp_path / "out").as_posix() for p in (tmp_path / "out").rglob("*.bvh")
    )
    assert made == ["day 2/second.bvh", "first.bvh"]


def test_gives_what_reconstruct_gives(
    cli: Cli, tmp_path: Path, take_path: Path, database_path: Path
) -> None:
    single = tmp_path / "single.bvh"
    options = ("--database", database_path, "--offline")
    assert cli("reconstruct", take_path, "-o", single, *options).exit_code == 0
    assert cli("batch", take_path, "-o", tmp_path / "out", *options).exit_code == 0
    (made,) = (tmp_path / "out").glob("*.bvh")
    assert made.read_bytes() == single.read_bytes()


def test_solves_again_only_what_has_changed(
    cli: Cli, tmp_path: Path, takes: Path, database_path: Path
) -> None:
    (takes / "broken.csv").unlink()
    out = tmp_path / "out"
    options = ("batch", takes, "-o", out, "--database", database_path)

    def there() -> list[str]:
        result = cli(*options)
        assert result.exit_code == 0, result.output
        return [line for line in result.output.splitlines() if line.endswith("there already")]

    assert there() == []
    assert len(there()) == 2
    (out / "first.bvh").unlink()
    assert len(there()) == 1
    shutil.copy(takes / "first.csv", takes / "day 2" / "second.csv")
    assert len(there()) == 1
    assert len(there()) == 2
    options = (*options, "--set", "num_paths=64")
    assert there() == []
    (out / "first.batch.json").write_text("{ torn", "utf-8")
    assert len(there()) == 1


def test_another_database_under_the_same_name_is_refused(
    tmp_path: Path, take_path: Path, database_path: Path, library: Path
) -> None:
    path = tmp_path / "library.smdb"
    shutil.copy(database_path, path)
    settings = BatchSettings(str(path), content_hash(path))
    sparse_mocap.build_database([library], path, tempo_copies=())
    assert content_hash(path) != settings.database_hash
    with processors(1) as workers:
        (solved,) = solve_batch(outputs([take_path], tmp_path / "out"), settings, workers)
    assert solved.error is not None
    assert "has changed since the work began" in solved.error
    assert not (tmp_path / "out").exists()


def test_cancels_and_keeps_what_is_solved(tmp_path: Path, takes: Path, database_path: Path) -> None:
    settings = BatchSettings(str(database_path), content_hash(database_path))
    solved: list[Solved] = []

    def stop_after_one(one: Solved, count: int) -> bool:
        solved.append(one)
        return count < 1

    files = outputs([takes], tmp_path / "out")
    with pytest.raises(sparse_mocap.Cancelled), processors(1) as workers:
        solve_batch(files, settings, workers, stop_after_one)
    assert len(solved) == 1
    notes = list((tmp_path / "out").rglob("*.batch.json")) if (tmp_path / "out").exists() else []
    for note in notes:
        assert json.loads(note.read_text("utf-8"))["num_frames"] > 0
        assert note.with_name(note.name.replace(".batch.json", ".bvh")).exists()


@pytest.mark.parametrize(
    ("names", "words"),
    [
        (["gone.csv"], "no such file"),
        (["empty"], "there are no takes"),
        (["a/walk.csv", "b/walk.csv"], "would both become"),
    ],
)
def test_refuses_what_cannot_be_a_batch(tmp_path: Path, names: list[str], words: str) -> None:
    (tmp_path / "empty").mkdir()
    for name in names:
        if "/" in name:
            (tmp_path / name).parent.mkdir()
            (tmp_path / name).touch()
    with pytest.raises(sparse_mocap.ConfigError, match=words):
        outputs([tmp_path / name for name in names], tmp_path / "out")


def test_the_same_take_given_twice_is_solved_once(tmp_path: Path, takes: Path) -> None:
    files = outputs([takes, takes / "day 2", takes / "first.csv"], tmp_path)
    assert sorted(path.name for path in files) == ["broken.csv", "first.csv", "second.csv"]
