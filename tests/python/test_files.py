# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that are there whole or not at all, and positions files."""

from __future__ import annotations

import csv
import errno
import gc
import os
import shutil
from pathlib import Path

import numpy as np
import pytest
from sparse_mocap import (
    FormatError,
    MotionDatabase,
    build_database,
    drop_from_database,
    read_motion,
    read_positions,
    write_bvh,
    write_positions,
)
from sparse_mocap.files import remove_folder, replaced, write_text


def test_a_failed_write_leaves_the_old_file(tmp_path: Path) -> None:
    path = tmp_path / "file.txt"
    write_text(path, "old")

    def fail() -> None:
        with replaced(path) as temporary:
            temporary.write_text("half", encoding="utf-8")
            raise RuntimeError("halfway")

    with pytest.raises(RuntimeError, match="halfway"):
        fail()
    assert path.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_full_disk_is_said_of_the_file_that_was_to_be_written(tmp_path: Path) -> None:
    """Not of a temporary one, and not of none."""
    path = tmp_path / "file.txt"
    for said in ((), (None,)):
        with pytest.raises(OSError, match="No space left") as failed, replaced(path) as temporary:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), *(said and (str(temporary),)))
        assert (failed.value.errno, failed.value.filename) == (errno.ENOSPC, str(path))
    with pytest.raises(OSError, match="gone") as failed, replaced(path):
        raise FileNotFoundError(errno.ENOENT, "gone", "another.txt")
    assert failed.value.filename == "another.txt"
    assert list(tmp_path.iterdir()) == []


def test_a_write_replaces_and_keeps_permissions(tmp_path: Path) -> None:
    path = tmp_path / "file.txt"
    write_text(path, "old")
    path.chmod(0o640)
    write_text(path, "new\n")
    assert path.read_bytes() == b"new\n"
    if os.name == "posix":
        assert path.stat().st_mode & 0o777 == 0o640
    assert list(tmp_path.iterdir()) == [path]


def test_what_is_synced_is_open_for_writing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Windows syncs nothing else."""

    def sync(file: int) -> None:
        os.write(file, b"")
        synced.append(file)

    synced: list[int] = []
    monkeypatch.setattr(os, "fsync", sync)
    write_text(tmp_path / "file.txt", "new")
    assert len(synced) == 1
    assert (tmp_path / "file.txt").read_bytes() == b"new"


def test_a_write_waits_while_the_file_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Windows refuses to replace a file that somebody reads."""

    def refuse(source: Path, target: Path) -> None:
        refusals.append(target)
        if len(refusals) <= num_refused:
            raise PermissionError(13, "Access is denied", str(target))
        replace(source, target)

    replace, refusals, num_refused = os.replace, list[Path](), 3
    monkeypatch.setattr(os, "replace", refuse)
    write_text(tmp_path / "file.txt", "new")
    assert len(refusals) == 4
    assert (tmp_path / "file.txt").read_bytes() == b"new"
    num_refused = 9999
    monkeypatch.setattr("sparse_mocap.files._DENIED_FOR_S", 0.05)
    with pytest.raises(PermissionError):
        write_text(tmp_path / "file.txt", "newer")
    assert (tmp_path / "file.txt").read_bytes() == b"new"
    assert list(tmp_path.iterdir()) == [tmp_path / "file.txt"]


def test_what_cannot_be_written_names_the_file_that_was_meant(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"nowhere[/\\]+file\.txt"):
        write_text(tmp_path / "nowhere" / "file.txt", "")
    with pytest.raises(IsADirectoryError):
        write_text(tmp_path, "")


def test_files_may_be_called_in_any_language(library: Path, tmp_path: Path) -> None:
    """A Windows program that does not take care sees only the letters of one region."""
    folder = tmp_path / "Bewegungen für 动作"
    folder.mkdir()
    motion, _ = read_motion(sorted(library.glob("*.bvh"))[0])
    write_bvh(folder / "ü中.bvh", motion)
    again, _ = read_motion(folder / "ü中.bvh")
    assert again.num_frames == motion.num_frames
    build_database([folder], folder / "数据.smdb")
    assert {clip.source for clip in MotionDatabase(folder / "数据.smdb").clips} == {"ü中.bvh"}
    with pytest.raises(FormatError, match=r"für 动作.*没有\.bvh: no such file"):
        read_motion(folder / "没有.bvh")
    assert {path.name for path in folder.iterdir()} == {"ü中.bvh", "数据.smdb"}


def test_what_the_core_cannot_write_is_an_error_of_the_system(
    library: Path, tmp_path: Path
) -> None:
    motion, _ = read_motion(sorted(library.glob("*.bvh"))[0])
    with pytest.raises(FileNotFoundError) as caught:
        write_bvh(tmp_path / "nowhere" / "ü.bvh", motion)
    assert caught.value.errno == errno.ENOENT
    assert caught.value.strerror == os.strerror(errno.ENOENT)
    assert Path(caught.value.filename).parent == tmp_path / "nowhere"


def test_a_database_is_replaced_while_it_is_open(library: Path, tmp_path: Path) -> None:
    """Its content stays, and nothing is left behind once nobody has the old one open."""
    path = tmp_path / "library.smdb"
    build_database([library], path)
    opened = MotionDatabase(path)
    num_clips, positions = len(opened.clips), opened.array("positions").copy()
    num_dropped = drop_from_database(path, [opened.clips[0].name])
    np.testing.assert_array_equal(opened.array("positions"), positions)
    del opened
    gc.collect()
    assert len(MotionDatabase(path).clips) == num_clips - num_dropped
    assert [entry.name for entry in tmp_path.iterdir()] == ["library.smdb"]


def test_a_folder_is_removed_once_nobody_has_a_file_of_it_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Windows refuses to remove a file that is open."""

    def remove(path: Path, **options: bool) -> None:
        calls.append(path)
        if len(calls) > 3:
            shutil_rmtree(path, **options)

    shutil_rmtree, calls = shutil.rmtree, list[Path]()
    monkeypatch.setattr(shutil, "rmtree", remove)
    folder = tmp_path / "take.capture"
    folder.mkdir()
    (folder / "output.log").write_bytes(b"")
    remove_folder(folder)
    assert len(calls) == 4
    assert list(tmp_path.iterdir()) == []
    remove_folder(folder)
    monkeypatch.setattr(shutil, "rmtree", lambda path, **options: None)
    monkeypatch.setattr("sparse_mocap.files._OPEN_FOR_S", 0.05)
    folder.mkdir()
    remove_folder(folder)


def test_positions_survive_a_file(tmp_path: Path) -> None:
    times, joints = np.arange(4) / 25 + 2.0, ["root", "head"]
    positions = np.random.default_rng(0).normal(size=(4, 2, 3))
    write_positions(tmp_path / "p.csv", times, joints, positions)
    again = read_positions(tmp_path / "p.csv")
    assert again[1] == joints
    np.testing.assert_allclose(again[0], times, atol=1e-6)
    np.testing.assert_allclose(again[2], positions, atol=1e-6)


def test_a_positions_file_is_plain_csv(tmp_path: Path) -> None:
    write_positions(tmp_path / "p.csv", [0.5], ["root"], [[[1, 2, 3]]])
    with open(tmp_path / "p.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["time_s", "root_x", "root_y", "root_z"]
    assert [float(value) for value in rows[1]] == [0.5, 1, 2, 3]


def test_positions_of_a_wrong_shape_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"must be \(2, 1, 3\), got \(1, 1, 3\)"):
        write_positions(tmp_path / "p.csv", [0, 1], ["root"], np.zeros((1, 1, 3)))


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "is empty"),
        ("time_s\n0\n", ":1: the header"),
        ("time_s,root_x,root_z,root_y\n", ":1: the header"),
        ("time_s,root_x,root_y,root_z\n0,1,2\n", ":2: expected 4 numbers"),
        ("# x\ntime_s,root_x,root_y,root_z\n0,1,2,three\n", ":3: expected 4 numbers"),
    ],
)
def test_a_bad_positions_file_is_refused(tmp_path: Path, text: str, problem: str) -> None:
    path = tmp_path / "p.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(FormatError, match=problem):
        read_positions(path)
