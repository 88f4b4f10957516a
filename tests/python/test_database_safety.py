# SPDX-License-Identifier: GPL-3.0-or-later
"""Databases that several programs change at once, or whose writer is killed."""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from safetensors.numpy import load_file
from sparse_mocap import MotionDatabase, add_to_database, build_database

Cli = Callable[..., Result]

TIMES = int(os.environ.get("SPARSE_MOCAP_REPEATS", "6"))
ADD = "import sys; import sparse_mocap; sparse_mocap.add_to_database(sys.argv[1], sys.argv[2:])"


@pytest.fixture
def folders(library: Path, tmp_path: Path) -> Path:
    """The library as folders ada and bruno, and a database start.smdb of one file of ada's."""
    for path in library.iterdir():
        folder = tmp_path / path.name.partition("_")[0]
        folder.mkdir(exist_ok=True)
        shutil.copy(path, folder)
    build_database([min((tmp_path / "ada").iterdir())], tmp_path / "start.smdb")
    return tmp_path


def _adding(database: Path, *sources: Path) -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [sys.executable, "-c", ADD, str(database), *map(str, sources)], stderr=subprocess.PIPE
    )


def _sources(database: Path) -> set[str]:
    return {clip.source for clip in MotionDatabase(database).clips}


def test_two_that_add_at_once_are_both_in(folders: Path) -> None:
    database = folders / "db.smdb"
    files = {path.name for name in ("ada", "bruno") for path in (folders / name).iterdir()}
    for _ in range(TIMES):
        shutil.copy(folders / "start.smdb", database)
        both = [_adding(database, folders / name) for name in ("ada", "bruno")]
        for process in both:
            _, errors = process.communicate()
            assert process.returncode == 0, errors
        assert _sources(database) == files
    assert {path.name for path in folders.iterdir() if path.is_file()} == {"db.smdb", "start.smdb"}


def test_a_killed_add_loses_and_leaves_nothing(folders: Path) -> None:
    database = folders / "db.smdb"
    shutil.copy(folders / "start.smdb", database)
    before = database.read_bytes()
    process = _adding(database, folders / "bruno")
    start = time.monotonic()
    process.communicate()
    takes_s = time.monotonic() - start
    after = database.read_bytes()
    assert after != before
    moments = random.Random(5)
    for _ in range(TIMES):
        database.write_bytes(before)
        process = _adding(database, folders / "bruno")
        time.sleep(moments.uniform(0.3, 1.0) * takes_s)
        process.kill()
        process.communicate()
        assert database.read_bytes() in (before, after)
    add_to_database(database, [folders / "bruno"])
    assert database.read_bytes() == after
    assert {path.name for path in folders.iterdir() if path.is_file()} == {"db.smdb", "start.smdb"}


def test_what_a_killed_writer_left_is_removed(folders: Path) -> None:
    # A name that only a writer of db.smdb gives; the next one removes it.
    (folders / "db.smdb.tmp.4194303.0").write_bytes(b"half a database")
    shutil.copy(folders / "start.smdb", folders / "db.smdb")
    add_to_database(folders / "db.smdb", [folders / "bruno"])
    assert not list(folders.glob("*.tmp.*"))


def test_a_full_disk_is_told_of_the_users_own_file(folders: Path) -> None:
    resource = pytest.importorskip("resource", reason="needs a limit of the size of files")
    database = folders / "db.smdb"
    shutil.copy(folders / "start.smdb", database)
    before = database.read_bytes()

    def little_space() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))

    result = subprocess.run(
        [sys.executable, "-m", "sparse_mocap", "database", "add", str(database),
         str(folders / "bruno")],
        preexec_fn=little_space, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert result.returncode == 1
    assert result.stderr.splitlines()[-1] == f"sparse-mocap: {database}: File too large"
    assert database.read_bytes() == before
    assert not list(folders.glob("*.tmp.*"))


def test_a_folder_that_is_not_there_is_told_of_the_users_own_file(cli: Cli, folders: Path) -> None:
    output = folders / "nowhere" / "db.smdb"
    result = cli("database", "build", folders / "ada", "-o", output)
    assert result.exit_code == 1
    assert result.stderr == f"sparse-mocap: {output}: No such file or directory\n"


def test_a_motion_file_is_never_written_over(cli: Cli, folders: Path) -> None:
    motion = min((folders / "ada").iterdir())
    before = motion.read_bytes()
    for arguments in (
        ("database", "build", folders / "ada", "-o", motion),
        ("database", "add", folders / "start.smdb", folders / "bruno", "-o", motion),
        ("database", "drop", folders / "start.smdb", "--clips", "*", "-o", motion),
        ("inspect", motion, "--json", motion),
        ("inspect", motion, "--save-mapping", motion),
        ("inspect", motion, "--save-mapping", motion.with_suffix(".AMC")),
    ):
        result = cli(*arguments)
        assert result.exit_code in (1, 2), arguments
        assert "motion file" in result.stderr, arguments
    assert motion.read_bytes() == before


@pytest.mark.skipif(sys.platform == "win32", reason="all names are Unicode there")
def test_names_that_are_not_utf8_end_no_folder(cli: Cli, folders: Path) -> None:
    source = min((folders / "ada").iterdir())
    odd = os.fsencode(folders / "ada") + b"/ada_caf\xe9_07.bvh"
    shutil.copy(source, odd)
    os.mkdir(os.fsencode(folders / "ada") + b"/d\xe9j\xe0")
    shutil.copy(folders / "start.smdb", folders / "db.smdb")
    result = cli("database", "build", folders / "ada", "-o", folders / "new.smdb",
                 "--keep-duplicates")  # fmt: skip
    assert result.exit_code == 0, result.output
    assert "from 7 files" in result.output
    listing = folders / "list.json"
    result = cli("inspect", folders / "ada", "--json", listing)
    assert result.exit_code == 0, result.output
    assert "ada_caf\\udce9_07.bvh" in result.output
    assert os.fsdecode(odd) in [entry["path"] for entry in json.loads(listing.read_text())]
    (odd_alone,) = [path for path in (folders / "ada").iterdir() if path.name.endswith("_07.bvh")]
    for arguments in (("convert", odd_alone, "-o", odd_alone.with_suffix(".csv")),
                      ("inspect", odd_alone)):  # fmt: skip
        assert cli(*arguments).exit_code == 0, arguments
    assert cli("database", "info", folders / "new.smdb", "--json").exit_code == 0
    assert any("ada_caf" in clip.source for clip in MotionDatabase(folders / "new.smdb").clips)


def test_new_bodies_are_told_and_averaged_by_a_rebuild(cli: Cli, folders: Path) -> None:
    database, rebuilt, whole = (folders / f"{name}.smdb" for name in ("db", "rebuilt", "whole"))
    ada, bruno = folders / "ada", folders / "bruno"
    (ada / "metadata.csv").write_text("file,class\n" + min(ada.glob("*.bvh")).name + ",strolling\n")
    assert cli("database", "build", ada, "-o", database).exit_code == 0
    added = cli("database", "add", database, bruno)
    assert added.exit_code == 0
    assert cli("database", "build", ada, bruno, "-o", whole).exit_code == 0
    change = np.abs(_end_points(whole) - _end_points(database)).max()
    assert change > 1e-3
    assert "would change the database's averaged skeleton by up to" in added.stderr
    (ada / "metadata.csv").unlink()
    result = cli("database", "add", database, ada, bruno, "--rebuild", "-o", rebuilt)
    assert result.exit_code == 0, result.output
    for name, rows in load_file(whole).items():
        np.testing.assert_array_equal(load_file(rebuilt)[name], rows)
    assert "strolling" in {clip.motion_class for clip in MotionDatabase(rebuilt).clips}
    missing = cli("database", "add", database, bruno, "--rebuild")
    assert missing.exit_code == 1
    assert "which is not among the sources" in missing.stderr


def _end_points(database: Path) -> np.ndarray:
    """The ends of the joints at rest, m."""
    skeleton = MotionDatabase(database).skeleton
    begins: list[np.ndarray] = []
    ends = []
    for joint in range(len(skeleton.names)):
        parent = skeleton.parents[joint]
        begin = np.asarray(skeleton.offsets[joint]) + (begins[parent] if parent >= 0 else 0.0)
        begins.append(begin)
        ends.append(begin + np.asarray(skeleton.bones[joint]))
    return np.array(ends)
