# SPDX-License-Identifier: GPL-3.0-or-later
"""Building, changing and describing databases by command."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import Result
from safetensors.numpy import load_file
from sparse_mocap import (
    ConfigError,
    MotionDatabase,
    ProgressReport,
    add_to_database,
    build_database,
    read_motion,
    write_bvh,
)
from sparse_mocap.cli.console import figures_of

Cli = Callable[..., Result]


def info(cli: Cli, path: Path) -> dict[str, Any]:
    result = cli("database", "info", path, "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


@pytest.fixture
def parts(library: Path, tmp_path: Path) -> Path:
    """The library as two folders, ada and bruno."""
    for path in library.iterdir():
        folder = tmp_path / path.name.partition("_")[0]
        folder.mkdir(exist_ok=True)
        shutil.copy(path, folder)
    return tmp_path


def test_add_keeps_the_rows_and_drop_gives_the_file_back(cli: Cli, parts: Path) -> None:
    built, more, less = (parts / f"{name}.smdb" for name in ("built", "more", "less"))
    assert cli("database", "build", parts / "ada", "-o", built, "--mirror").exit_code == 0
    result = cli("database", "add", built, parts / "bruno", "-o", more, "--threads", 2)
    assert result.exit_code == 0, result.output
    assert "from 6 files" in result.output
    before, after = load_file(built), load_file(more)
    for name, rows in before.items():
        np.testing.assert_array_equal(after[name][: len(rows)], rows)
    assert {clip.actor for clip in MotionDatabase(more).clips} == {"ada", "bruno"}
    result = cli("database", "drop", more, "--clips", "bruno_*", "-o", less)
    assert result.exit_code == 0, result.output
    assert "36 clips removed, 36 clips" in result.output
    assert less.read_bytes() == built.read_bytes()


def test_add_and_drop_change_the_database_in_its_place(cli: Cli, parts: Path) -> None:
    database = parts / "db.smdb"
    cli("database", "build", parts / "ada", "-o", database, "--no-tempo-copies")
    assert "6 unchanged" in cli("database", "add", database, parts / "ada").output
    assert cli("database", "add", database, parts / "bruno").exit_code == 0
    assert len(MotionDatabase(database).clips) == 12
    assert cli("database", "drop", database, "--clips", "*_walk_01.bvh").exit_code == 0
    assert len(MotionDatabase(database).clips) == 10
    before = database.read_bytes()
    for arguments in (
        ("drop", database, "--clips", "nobody"),
        ("drop", database, "--clips", "*"),
        ("add", database, parts / "nowhere"),
        ("add", database, parts / "ada", "--metadata", parts / "none.csv"),
        ("add", parts / "none.smdb", parts / "ada"),
    ):
        result = cli("database", *arguments)
        assert result.exit_code == 1
        assert len(result.stderr.splitlines()) == 1
    assert database.read_bytes() == before
    assert cli("database", "drop", database).exit_code == 2


def test_duplicates_are_left_out_and_named(cli: Cli, parts: Path) -> None:
    motion = read_motion(parts / "ada" / "ada_squat_01.bvh")[0]
    write_bvh(parts / "ada" / "slow.bvh", motion.resampled(30.0))
    shutil.copy(parts / "ada" / "ada_walk_01.bvh", parts / "ada" / "zz.bvh")
    database = parts / "db.smdb"
    result = cli("database", "build", parts / "ada", "-o", database, "--no-tempo-copies")
    assert "from 6 files, 2 duplicates" in result.output
    told = info(cli, database)
    assert told["num_sources"] == 6
    assert told["duplicates"] == [
        {"source": "zz.bvh", "reason": "zz.bvh: the same file as ada_walk_01.bvh"},
        {"source": "slow.bvh", "reason": "slow.bvh: the same motion as ada_squat_01.bvh"},
    ]
    arguments = ("database", "build", parts / "ada", "-o", database, "--keep-duplicates")
    assert "from 8 files (" not in cli(*arguments).output
    assert info(cli, database)["num_sources"] == 8


def test_info_tells_where_the_motions_come_from(cli: Cli, parts: Path) -> None:
    (parts / "ada" / "metadata.csv").write_text(
        "file,actor,class,source,license\nada_walk_01,Ada L.,stroll,generated,CC0\nghost,,,,\n",
        encoding="utf-8",
    )
    (parts / "ada" / "broken.bvh").write_text("HIERARCHY\n", encoding="utf-8")
    database = parts / "db.smdb"
    result = cli(
        "database", "build", parts, "-o", database, "--metadata", parts / "ada/metadata.csv"
    )
    assert "metadata.csv:3: no motion file is called" in result.stderr
    told = info(cli, database)
    assert told["actors"] == {"Ada L.": 3, "ada": 15, "bruno": 18}
    assert told["motion_classes"]["stroll"] == 3
    assert told["licenses"] == {"CC0": 1, "not stated": 11}
    assert told["origins"] == {"generated": 1}
    originals = [read_motion(path)[0] for path in parts.rglob("*_*.bvh")]
    hours = sum(motion.num_frames * motion.frame_time_s for motion in originals) / 3600
    assert told["source_hours"] == pytest.approx(hours, rel=1e-6)
    assert sum(told["source_hours_by_actor"].values()) == pytest.approx(hours, rel=1e-6)
    assert sum(told["source_hours_by_class"].values()) == pytest.approx(hours, rel=1e-6)
    assert told["source_frames"] == sum(motion.num_frames for motion in originals)
    (skeleton,) = told["skeletons"]
    assert (skeleton["num_joints"], skeleton["num_files"]) == (23, 12)
    assert skeleton["joints"]["ltibia"] == "LeftLeg"
    assert told["skipped"][0]["source"] == "ada/broken.bvh"
    arrays = load_file(database)
    assert told["array_bytes"]["positions"] == arrays["positions"].nbytes
    assert {clip["source"] for clip in told["clips"]} == {
        path.relative_to(parts).as_posix() for path in parts.rglob("*_*.bvh")
    }
    text = cli("database", "info", database).stdout
    for part in ("CC0 (1)", "ltibia=LeftLeg", "skipped  ada/broken.bvh", "positions"):
        assert part in text


def test_a_bad_table_is_one_line_that_says_where(cli: Cli, parts: Path) -> None:
    (parts / "ada" / "metadata.csv").write_text("file,licence\na,b\n", encoding="utf-8")
    result = cli("database", "build", parts / "ada", "-o", parts / "db.smdb")
    assert result.exit_code == 1
    (line,) = result.stderr.splitlines()
    assert 'metadata.csv:1: unknown column "licence"; did you mean "license"?' in line
    assert not (parts / "db.smdb").exists()


def test_details_tell_files_frames_and_bytes(library: Path, tmp_path: Path) -> None:
    told: list[tuple[int, ...]] = []

    def details(r: ProgressReport) -> None:
        told.append((r.done, r.total, r.files, r.num_files, r.frames, r.bytes, r.num_bytes))
        assert figures_of(r, 2.0).startswith(f"{r.files}/12 files, {r.frames} frames, ")

    report = build_database([library], tmp_path / "db.smdb", details=details, num_threads=2)
    size = sum(path.stat().st_size for path in library.iterdir())
    assert told[0] == (0, 24, 0, 12, 0, 0, 2 * size)
    assert told[-1][:4] == (23, 24, 11, 12)
    assert report.source_bytes == size
    assert report.source_frames == sum(
        read_motion(path)[0].num_frames for path in library.iterdir()
    )
    assert report.elapsed_s > 0


def test_the_number_of_threads_does_not_matter(library: Path, tmp_path: Path) -> None:
    for threads in (1, 3):
        build_database([library], tmp_path / f"{threads}.smdb", num_threads=threads)
    assert (tmp_path / "1.smdb").read_bytes() == (tmp_path / "3.smdb").read_bytes()
    for threads in (-1, 100_000):
        with pytest.raises(ConfigError, match="threads"):
            add_to_database(tmp_path / "1.smdb", [library], num_threads=threads)
