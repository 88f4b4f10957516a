# SPDX-License-Identifier: GPL-3.0-or-later
"""What a caller may say about a motion file that the file does not say itself."""

from pathlib import Path

import numpy as np
import pytest
from sparse_mocap import FormatError, read_motion

BVH = """HIERARCHY
ROOT a
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT b
  {
    OFFSET 0 50 0
    CHANNELS 3 Xposition Yposition Zposition
  }
}
MOTION
Frames: 2
Frame Time: 0.01
1 2 3 0 0 0 0 50 0
4 5 6 0 0 90 0 60 7
"""
ASF = """:units
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name up
    direction 0 1 0
    length 2.0
    axis 0 0 0 XYZ
    dof rz
  end
:hierarchy
  begin
    root up
  end
"""
AMC = ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 1 2 3 0 0 0\nup 90\n"


def test_unit_and_up_axis_of_a_bvh(tmp_path: Path) -> None:
    path = tmp_path / "a.bvh"
    path.write_text(BVH)
    motion, _ = read_motion(path, unit_m=0.5, up="z")
    assert np.allclose(motion.root_positions[1], [2.0, 3.0, -2.5])
    assert np.allclose(read_motion(path)[0].root_positions[1], [0.04, 0.05, 0.06])


def test_joints_that_move_have_tracks(tmp_path: Path) -> None:
    path = tmp_path / "a.bvh"
    path.write_text(BVH)
    ((joint, track),) = read_motion(path, unit_m=1.0)[0].offset_tracks
    assert joint == 1
    assert track.tolist() == [[0.0, 50.0, 0.0], [0.0, 60.0, 7.0]]


def test_unit_up_axis_and_skeleton_of_an_amc(tmp_path: Path) -> None:
    (tmp_path / "walk.amc").write_text(AMC)
    (tmp_path / "one.asf").write_text(ASF)
    (tmp_path / "two.asf").write_text(ASF.replace("length 2.0", "length 4.0"))
    with pytest.raises(FormatError, match=r"\.asf"):
        read_motion(tmp_path / "walk.amc")
    for name, length in (("one", 2.0), ("two", 4.0)):
        asf = tmp_path / f"{name}.asf"
        motion, _ = read_motion(tmp_path / "walk.amc", asf=asf, unit_m=1.0)
        assert np.allclose(motion.joint_positions()[0], [[1, 2, 3], [1 - length, 2, 3]])
        turned, _ = read_motion(tmp_path / "walk.amc", asf=asf, unit_m=1.0, up="z")
        assert np.allclose(turned.joint_positions()[0], [[1, 3, -2], [1 - length, 3, -2]])
        own, _ = read_motion(tmp_path / "walk.amc", asf=asf)
        assert np.allclose(own.root_positions[0], np.array([1, 2, 3]) * 0.0254 / 0.45)


def test_a_skeleton_alone_is_read_when_it_is_allowed(tmp_path: Path) -> None:
    path = tmp_path / "one.asf"
    path.write_text(ASF)
    motion, _ = read_motion(path, allow_no_frames=True)
    assert motion.num_frames == 0
    assert motion.skeleton.names == ["root", "up"]
    with pytest.raises(FormatError, match="is not a motion file"):
        read_motion(path)


def test_an_axis_that_is_none_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.bvh"
    path.write_text(BVH)
    with pytest.raises(ValueError, match="up must be"):
        read_motion(path, up="w")
