# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion files as exporters, hand editing and downloads make them, each kind read or refused."""

from __future__ import annotations

import gzip
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from made_bvh import PERSON, bvh, row, walking
from sparse_mocap import FormatError, build_database, find_motion_files, read_motion
from test_read_options import AMC, ASF

Cli = Callable[..., Result]

# --- Text ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("tail", [b"\x1a", b"\0\0\0", b"\r\n\x1a\0", b"\0\n\n"])
def test_bytes_that_old_programs_put_at_the_end(tmp_path: Path, tail: bytes) -> None:
    path = tmp_path / "a.bvh"
    path.write_bytes(bvh().encode() + tail)
    assert read_motion(path)[0].num_frames == 4
    (tmp_path / "a.asf").write_bytes(ASF.encode() + tail)
    (tmp_path / "a.amc").write_bytes(AMC.encode() + tail)
    assert read_motion(tmp_path / "a.amc")[0].num_frames == 1


@pytest.mark.parametrize("end_site", ["End Site", "EndSite", "End site", "ENDSITE", "End Site tip"])
def test_end_sites_however_written(tmp_path: Path, end_site: str) -> None:
    path = tmp_path / "a.bvh"
    path.write_text(bvh(end_site=end_site))
    np.testing.assert_allclose(read_motion(path)[0].skeleton.bones[4], [0.0, 0.18, 0.0])


def test_remarks_before_the_hierarchy(tmp_path: Path) -> None:
    path = tmp_path / "a.bvh"
    path.write_text("# made by hand\n  # twice\n\n" + bvh())
    assert read_motion(path)[0].num_frames == 4


def test_one_cut_row_after_all_that_are_declared_is_left_out(tmp_path: Path) -> None:
    path = tmp_path / "a.bvh"
    path.write_text(bvh() + "1.0 2.0 3.0\n")
    motion, warnings = read_motion(path)
    assert motion.num_frames == 4
    assert any("it is left out" in warning for warning in warnings)
    path.write_text(bvh().replace("Frames: 4", "Frames: 5") + "1.0 2.0 3.0\n")
    with pytest.raises(FormatError, match="the file may be cut off"):
        read_motion(path)
    path.write_text(bvh() + "1.0 2.0 3.0\n" + row(PERSON, (0, 94, 0)) + "\n")
    with pytest.raises(FormatError, match="has 3 values"):
        read_motion(path)


def test_a_pose_needs_no_frame_time(tmp_path: Path) -> None:
    path = tmp_path / "a.bvh"
    path.write_text(bvh(frames=[((0, 94, 0), {})], frame_time="0"))
    motion, warnings = read_motion(path)
    assert (motion.num_frames, motion.frame_time_s) == (1, pytest.approx(1 / 30))
    assert any("frame time of these poses is 0" in warning for warning in warnings)
    path.write_text(bvh(frames=[((0, 94, 0), {})] * 11, frame_time="0"))
    with pytest.raises(FormatError, match=r"must be from 0\.0001 to 1 s"):
        read_motion(path)


@pytest.mark.parametrize(
    ("written", "said"),
    [("30", "30 frames per second are 0.0333 s"), ("120", "120 frames per second are 0.00833 s"),
     ("33.333", "33.3 ms are 0.0333 s"), ("8.333", "8.33 ms are 0.00833 s")],
)  # fmt: skip
def test_a_frame_time_in_other_units_is_worked_out(tmp_path: Path, written: str, said: str) -> None:
    path = tmp_path / "a.bvh"
    path.write_text(bvh(frame_time=written))
    with pytest.raises(FormatError, match=said):
        read_motion(path)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"Kaydara FBX Binary  \x00\x1a\x00", "is a binary FBX file; import it with Blender"),
        (b"; FBX 7.4.0 project file\n", "is an FBX file"),
        (b"glTF\x02\x00\x00\x00", "is a GLB file"),
        (gzip.compress(b"HIERARCHY", mtime=0), "is compressed"),
        (b"PK\x03\x04rest", "is a zip archive; unpack it"),
        (b"\n<!DOCTYPE html><html>", "is a web page"),
        (b"<HTML><body>404", "is a web page"),
        (b"version https://git-lfs.github.com/spec/v1\n", "Git LFS"),
    ],
)
@pytest.mark.parametrize("ending", [".bvh", ".amc", ".asf"])
def test_other_formats_under_this_ones_name(
    tmp_path: Path, content: bytes, said: str, ending: str
) -> None:
    path = tmp_path / f"a{ending}"
    path.write_bytes(content)
    (tmp_path / "a.asf").write_bytes(content if ending == ".asf" else ASF.encode())
    with pytest.raises(FormatError, match=said):
        read_motion(path, allow_no_frames=True)


# --- Finding files -------------------------------------------------------------------------------


@pytest.mark.parametrize("joint", ["_", ".", " ", "-"])
def test_the_skeleton_of_an_amc_whatever_joins_its_name(tmp_path: Path, joint: str) -> None:
    (tmp_path / "other.asf").write_text(ASF.replace("2.0", "5.0"))
    (tmp_path / "02.asf").write_text(ASF)
    path = tmp_path / f"02{joint}01.amc"
    path.write_text(AMC)
    motion, warnings = read_motion(path)
    assert motion.skeleton.bones[1][1] == pytest.approx(2.0 * 0.0254 / 0.45)
    assert not any("only .asf" in warning for warning in warnings)


def test_the_skeleton_of_another_actor_gets_into_no_database(tmp_path: Path) -> None:
    (tmp_path / "35.asf").write_text(ASF)
    (tmp_path / "02_01.amc").write_text(AMC)
    _, warnings = read_motion(tmp_path / "02_01.amc")
    assert any("seems to be of another actor" in warning for warning in warnings)
    with pytest.raises(FormatError, match=r"35\.asf, is of another actor"):
        build_database([tmp_path], tmp_path / "db.smdb")
    (tmp_path / "skeleton.asf").write_text(ASF)
    (tmp_path / "35.asf").unlink()
    _, warnings = read_motion(tmp_path / "02_01.amc")  # a name that is no actor's
    assert not any("another actor" in warning for warning in warnings)


def test_files_of_other_formats_are_counted(cli: Cli, tmp_path: Path) -> None:
    folder = tmp_path / "in"
    folder.mkdir()
    for name in ("a.fbx", "b.FBX", "c.c3d", "d.txt", "e.trc"):
        (folder / name).write_text("x")
    with pytest.raises(FormatError, match=r"4 files of other formats were not read: 1 \.c3d"):
        find_motion_files([folder])
    with pytest.raises(FormatError, match="holds markers in space"):
        find_motion_files([folder / "c.c3d"])
    (folder / "walk.bvh").write_text(walking())
    result = cli("database", "build", folder, "-o", tmp_path / "db.smdb")
    assert result.exit_code == 0, result.output
    assert "4 files of other formats were not read" in result.stderr
    assert ".c3d, .trc: solve it onto a skeleton" in result.stderr
