# SPDX-License-Identifier: GPL-3.0-or-later
"""Motions written as Acclaim."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from sparse_mocap import FormatError, Motion, read_motion, standard_motion, write_acclaim

Cli = Callable[..., Result]


def rows_of(path: Path) -> list[tuple[str, list[float]]]:
    """The bone lines of an .amc, read by nothing but str.split."""
    lines = path.read_text(encoding="latin-1").splitlines()
    words = [line.split() for line in lines if line[:1].isalpha()]
    return [(name, [float(value) for value in values]) for name, *values in words]


def test_convert_writes_the_motion_and_its_skeleton(
    cli: Cli, performance: Path, tmp_path: Path
) -> None:
    result = cli("convert", performance, "-o", tmp_path / "out.amc")
    assert result.exit_code == 0, result.output
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.amc", "out.asf"]
    old, new = read_motion(performance)[0], read_motion(tmp_path / "out.amc")[0]
    assert new.num_frames == old.num_frames
    assert new.frame_time_s == pytest.approx(old.frame_time_s)
    leaves = set(range(len(old.skeleton.names))) - set(old.skeleton.parents)
    assert len(leaves) == 5
    for joint in leaves:
        name = old.skeleton.names[joint]
        np.testing.assert_allclose(
            new.joint_positions()[:, new.skeleton.names.index(name)],
            old.joint_positions()[:, joint],
            atol=1e-6,
        )


def test_it_is_the_same_person(cli: Cli, performance: Path, tmp_path: Path) -> None:
    assert cli("convert", performance, "-o", tmp_path / "out.amc").exit_code == 0
    old, _ = standard_motion(read_motion(performance)[0])
    new, _ = standard_motion(read_motion(tmp_path / "out.amc")[0])
    np.testing.assert_allclose(new.joint_positions(), old.joint_positions(), atol=1e-6)


def test_what_acclaim_cannot_hold_is_refused(performance: Path, tmp_path: Path) -> None:
    motion, _ = read_motion(performance)
    slow = Motion(motion.skeleton, 2.0, motion.root_positions, motion.rotations)
    with pytest.raises(FormatError, match=r"cannot be written as Acclaim: .* resample it"):
        write_acclaim(tmp_path / "out.amc", slow)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(FileNotFoundError):
        write_acclaim(tmp_path / "none" / "out.amc", motion)


@pytest.mark.parametrize(
    "name", ["hdm05/HDM_bd_squat1Reps_*.amc", "hdm05/HDM_tr_*.amc", "cmu/asf_amc/0[13]_*.amc"]
)
def test_recorded_rows_come_back(real_data: Path, tmp_path: Path, name: str) -> None:
    """The numbers themselves, but for whole turns and the second triple of angles."""
    path = next(iter(sorted(real_data.glob(name))))
    write_acclaim(tmp_path / "out.amc", read_motion(path)[0])
    old, new = rows_of(path), rows_of(tmp_path / "out.amc")
    assert len(old) == len(new)
    frames = [index for index, row in enumerate(old) if row[0] == "root"]
    same = 0
    for index in range(len(frames)):
        begin = frames[index]
        end = frames[index + 1] if index + 1 < len(frames) else len(old)
        theirs, ours = dict(old[begin:end]), dict(new[begin:end])
        assert theirs.keys() == ours.keys()
        for bone, values in theirs.items():
            assert len(values) == len(ours[bone])
            same += is_same(bone, np.array(values), np.array(ours[bone]))
    assert same / len(old) > 0.9  # the others are the second triple


def is_same(bone: str, old: np.ndarray, new: np.ndarray) -> bool:
    """Whether two rows hold the same numbers; the root's positions must."""
    difference = new - old
    if bone == "root":
        assert np.abs(difference[:3]).max() < 2e-6
        difference = difference[3:]
    return bool(np.abs(difference - 360.0 * np.round(difference / 360.0)).max() < 2e-5)
