# SPDX-License-Identifier: GPL-3.0-or-later
"""SMPL and MVNX against forward kinematics that share no code with the readers."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import Result
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from sparse_mocap import (
    FormatError,
    MotionDatabase,
    build_database,
    read_motion,
    to_standard,
    write_bvh,
)
from sparse_mocap.further_formats.smpl import JOINTS

Cli = Callable[..., Result]
Floats = NDArray[np.float64]


def performance(num_frames: int = 60, num_joints: int = 52, seed: int = 3) -> dict[str, Any]:
    """AMASS arrays of a body that sways on its way; z up."""
    random = np.random.default_rng(seed)
    amplitudes, phases = random.normal(0.0, 0.25, (num_joints, 3)), random.uniform(0, 6, num_joints)
    time_s = np.arange(num_frames)[:, None, None] / 60.0
    poses = amplitudes * np.sin(4.0 * time_s + phases[None, :, None])
    poses[:, 0] = [np.pi / 2, 0.0, 0.0]  # SMPL rests with y up
    walked = np.linspace(0.0, 1.0, num_frames)
    trans = np.stack([0.1 * np.sin(3 * walked), -walked, 1.12 + 0.02 * np.cos(9 * walked)], 1)
    return {
        "poses": poses.reshape(num_frames, -1), "trans": trans, "gender": np.array("neutral"),
        "mocap_framerate": np.array(60.0), "betas": np.zeros(16),
    }  # fmt: skip


def pivots(arrays: dict[str, Any]) -> Floats:
    """(T, J, 3) m with y up: rotation vectors applied down the tree by SciPy."""
    poses = arrays["poses"].reshape(len(arrays["trans"]), -1, 3)
    points = np.zeros((len(poses), len(JOINTS), 3))
    turns: list[Rotation] = []
    for joint, (_, parent, place) in enumerate(JOINTS):
        own = Rotation.from_rotvec(poses[:, joint])
        if parent < 0:
            turns.append(own)
            points[:, joint] = arrays["trans"] + place
        else:
            turns.append(turns[parent] * own)
            points[:, joint] = points[:, parent] + turns[parent].apply(place)
    return points[..., [0, 2, 1]] * [1.0, 1.0, -1.0]


def test_smpl_is_where_its_joints_say(tmp_path: Path) -> None:
    arrays = performance()
    for name, changed in {
        "smplh.npz": arrays,
        "smpl.npz": arrays | {"poses": arrays["poses"][:, :72]},
        "smplx.npz": {
            "root_orient": arrays["poses"][:, :3], "pose_body": arrays["poses"][:, 3:66],
            "trans": arrays["trans"], "mocap_frame_rate": np.array([60.0]),
        },
    }.items():  # fmt: skip
        np.savez_compressed(tmp_path / name, **changed)
        motion, warnings = read_motion(tmp_path / name)
        assert motion.frame_time_s == pytest.approx(1 / 60)
        np.testing.assert_allclose(motion.pivot_positions(), pivots(arrays), atol=1e-9)
        assert any("average person's bone lengths" in warning for warning in warnings)


def test_smpl_becomes_the_clip_that_its_bvh_becomes(tmp_path: Path) -> None:
    for folder in ("npz", "bvh"):
        (tmp_path / folder).mkdir()
    np.savez(tmp_path / "npz" / "sway_01.npz", **performance())
    motion, _ = read_motion(tmp_path / "npz" / "sway_01.npz")
    write_bvh(tmp_path / "bvh" / "sway_01.bvh", motion)
    databases = []
    for folder in ("npz", "bvh"):
        build_database([tmp_path / folder], tmp_path / f"{folder}.smdb")
        databases.append(MotionDatabase(tmp_path / f"{folder}.smdb"))
    assert databases[0].clips[0].source == "sway_01.npz"
    assert databases[0].num_frames == databases[1].num_frames > 20
    standards = [to_standard(read_motion(tmp_path / kind / f"sway_01.{kind}")[0])[0]
                 for kind in ("npz", "bvh")]  # fmt: skip
    points = [standard.joint_positions("world") for standard in standards]
    np.testing.assert_allclose(points[0], points[1], atol=1e-5)


def test_what_is_no_smpl_motion_is_refused_in_one_line(tmp_path: Path) -> None:
    arrays = performance()
    path = tmp_path / "a.npz"

    def refused(message: str, **changes: Any) -> None:
        kept = {name: value for name, value in (arrays | changes).items() if value is not None}
        np.savez(path, **kept)
        with pytest.raises(FormatError, match=message) as caught:
            read_motion(path)
        assert "\n" not in str(caught.value)
        assert str(caught.value).startswith(str(path))

    refused("neither poses nor root_orient", poses=None)
    refused("holds no trans", trans=None)
    refused("66 or more columns", poses=arrays["poses"][:, :63])
    refused("trans of shape", trans=arrays["trans"][:-1])
    refused("no table of finite numbers", trans=np.full((60, 3), np.nan))
    refused("no frame rate from 1", mocap_framerate=np.array(0.0))
    refused("not a NumPy archive of numbers", poses=np.array([{}], dtype=object))
    path.write_bytes(b"PK\x03\x04 nothing")
    with pytest.raises(FormatError, match="not a NumPy archive"):
        read_motion(path)
    path.write_bytes(pickle.dumps(arrays))
    with pytest.raises(FormatError, match="not a NumPy archive"):
        read_motion(path)


def test_bad_archives_are_skipped_by_a_build(cli: Cli, tmp_path: Path) -> None:
    folder = tmp_path / "in"
    folder.mkdir()
    np.savez(folder / "good.npz", **performance())
    np.savez(folder / "shape.npz", betas=np.zeros(10))
    result = cli("database", "build", folder, "-o", tmp_path / "db.smdb", "--threads", "2")
    assert result.exit_code == 0, result.output
    assert "skipped: " + str(folder / "shape.npz") + ": holds no SMPL motion" in result.stderr


# --- MVNX ----------------------------------------------------------------------------------------

SEGMENTS = {
    "Pelvis": (None, (0, 0, 0)), "L5": ("Pelvis", (0, 0, 0.1)), "L3": ("L5", (0, 0, 0.1)),
    "T12": ("L3", (0, 0, 0.1)), "T8": ("T12", (0, 0, 0.1)), "Neck": ("T8", (0, 0, 0.15)),
    "Head": ("Neck", (0, 0, 0.1)),
    "RightShoulder": ("T8", (0, -0.03, 0.1)), "RightUpperArm": ("RightShoulder", (0, -0.14, 0)),
    "RightForeArm": ("RightUpperArm", (0, -0.29, 0)), "RightHand": ("RightForeArm", (0, -0.25, 0)),
    "LeftShoulder": ("T8", (0, 0.03, 0.1)), "LeftUpperArm": ("LeftShoulder", (0, 0.14, 0)),
    "LeftForeArm": ("LeftUpperArm", (0, 0.29, 0)), "LeftHand": ("LeftForeArm", (0, 0.25, 0)),
    "RightUpperLeg": ("Pelvis", (0, -0.09, -0.04)),
    "RightLowerLeg": ("RightUpperLeg", (0, 0, -0.42)),
    "RightFoot": ("RightLowerLeg", (0, 0, -0.4)), "RightToe": ("RightFoot", (0.14, 0, -0.06)),
    "LeftUpperLeg": ("Pelvis", (0, 0.09, -0.04)), "LeftLowerLeg": ("LeftUpperLeg", (0, 0, -0.42)),
    "LeftFoot": ("LeftLowerLeg", (0, 0, -0.4)), "LeftToe": ("LeftFoot", (0.14, 0, -0.06)),
}  # fmt: skip


def mvnx(num_frames: int = 40) -> tuple[str, Floats]:
    """The text of a file and (T, S, 3) where its segments are with y up, facing z."""
    random = np.random.default_rng(2)
    names = list(SEGMENTS)
    amplitude = random.normal(0.0, 0.3, (len(names), 3))
    frames, placed = [], []
    for t in range(num_frames):
        turns: dict[str, Rotation] = {}
        places: dict[str, Floats] = {}
        for index, (name, (parent, offset)) in enumerate(SEGMENTS.items()):
            own = Rotation.from_rotvec(amplitude[index] * np.sin(0.2 * t + index))
            turns[name] = own if parent is None else turns[parent] * own
            places[name] = (
                np.array([0.02 * t, 0.0, 0.95]) if parent is None
                else places[parent] + turns[parent].apply(offset)
            )  # fmt: skip
        orientations = np.concatenate([turns[n].as_quat()[[3, 0, 1, 2]] for n in names])
        positions = np.concatenate([places[n] for n in names])
        placed.append(positions.reshape(-1, 3)[:, [1, 2, 0]])
        turned, put = (" ".join(map(repr, values.tolist())) for values in (orientations, positions))
        frames.append(
            f'<frame type="normal" time="{t}"><orientation>{turned}</orientation>'
            f"<position>{put}</position></frame>"
        )
    segments = "".join(f'<segment label="{name}" id="{i}"/>' for i, name in enumerate(names, 1))
    text = (
        '<?xml version="1.0"?><mvnx version="4" xmlns="http://www.xsens.com/mvn/mvnx">'
        f'<subject label="x" frameRate="60" segmentCount="23"><segments>{segments}</segments>'
        f'<frames segmentCount="23"><frame type="tpose"/>{"".join(frames)}</frames>'
        "</subject></mvnx>"
    )
    return text, np.array(placed)


def test_mvnx_is_where_its_segments_say(tmp_path: Path) -> None:
    text, placed = mvnx()
    path = tmp_path / "walk.mvnx"
    path.write_text(text)
    motion, _ = read_motion(path)
    assert motion.frame_time_s == pytest.approx(1 / 60)
    names = motion.skeleton.names
    for index, name in enumerate(SEGMENTS):
        found = motion.pivot_positions()[:, names.index(name)]
        np.testing.assert_allclose(found, placed[:, index], atol=1e-9)
    build_database([tmp_path], tmp_path / "db.smdb")


def test_a_damaged_mvnx_is_refused_in_one_line(tmp_path: Path) -> None:
    text, _ = mvnx(3)
    path = tmp_path / "walk.mvnx"
    for changed, message in (
        (text[: len(text) // 2], "not whole XML"),
        (text.replace('frameRate="60"', 'frameRate="fast"'), "frame rate"),
        (text.replace('label="Neck"', 'label="Nack"'), "lacks the segment Neck"),
        (text.replace("<position>", "<position>1.0 "), "has 70 numbers for 23 segments"),
        (text.replace('type="normal"', 'type="npose"'), "no frames of the type normal"),
    ):
        path.write_text(changed)
        with pytest.raises(FormatError, match=message):
            read_motion(path)
