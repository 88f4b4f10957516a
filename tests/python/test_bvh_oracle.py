# SPDX-License-Identifier: GPL-3.0-or-later
"""Joint positions against public readers of BVH, which share no code with ours.

pybvh computes in doubles and reads most exporters' files; bvhio computes in floats and reads all.
"""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pybvh
import pytest
from scipy.spatial.transform import Rotation
from sparse_mocap import (
    Motion,
    MotionDatabase,
    read_motion,
    read_take,
    reconstruct,
    standard_joint_names,
    write_bvh,
)

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # it imports its own dependency by an old name
    import bvhio

CENTIMETRES = 100.0  # a metre; the readers give the file's own unit
Points = npt.NDArray[np.float64]


def positions_of(motion: Motion) -> tuple[Points, list[int]]:
    """(frames, joints, 3) in the file's unit, and the joints without a bone: End Sites are ends."""
    plain = [joint for joint, bone in enumerate(motion.skeleton.bones) if not bone.any()]
    return motion.joint_positions("world") * CENTIMETRES, plain


def positions_by_pybvh(path: Path) -> tuple[list[str], Points]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        clip = pybvh.read_bvh_file(path)
    joints = [clip.node_index[name] for name in clip.joint_names]
    return clip.joint_names, np.asarray(clip.node_positions())[:, joints]


def positions_by_bvhio(path: Path, frames: list[int]) -> tuple[list[str], Points]:
    root = bvhio.readAsHierarchy(str(path))
    joints = [joint for joint, _, _ in root.layout()]
    poses = []
    for frame in frames:
        root.loadPose(frame)
        poses.append([joint.PositionWorld.to_tuple() for joint in joints])
    return [joint.Name for joint in joints], np.array(poses)


def some_frames(motion: Motion) -> list[int]:
    last = motion.num_frames - 1
    return sorted({0, last // 3, last // 2, last})


def check_against_bvhio(path: Path) -> None:
    motion, _ = read_motion(path)
    ours, plain = positions_of(motion)
    frames = some_frames(motion)
    names, theirs = positions_by_bvhio(path, frames)
    assert [name.replace(" ", "_") for name in names] == motion.skeleton.names
    size = np.abs(theirs).max()
    np.testing.assert_allclose(ours[frames][:, plain], theirs[:, plain], atol=2e-6 * size + 1e-6)


def check_against_pybvh(path: Path) -> None:
    motion, _ = read_motion(path)
    ours, plain = positions_of(motion)
    names, theirs = positions_by_pybvh(path)
    assert names == motion.skeleton.names
    np.testing.assert_allclose(ours[:, plain], theirs[:, plain], atol=1e-9)


def is_for_pybvh(path: Path) -> bool:
    """It refuses joints other than the root with position channels."""
    try:
        positions_by_pybvh(path)
    except ValueError:
        return False
    return True


ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")


def chain_of_all_orders(positions_first: bool) -> str:
    """Six joints, each with another order; the values are all different."""
    random = np.random.default_rng(5)
    lines, columns = ["HIERARCHY"], 0
    for joint, order in enumerate(ORDERS):
        rotations = [f"{axis}rotation" for axis in order]
        positions = ["Xposition", "Yposition", "Zposition"] if joint == 0 else []
        channels = positions + rotations if positions_first else rotations + positions
        columns += len(channels)
        lines += [
            f"{'JOINT' if joint else 'ROOT'} joint{joint}",
            "{",
            "OFFSET " + " ".join(f"{value:.3f}" for value in random.normal(size=3) * 20),
            f"CHANNELS {len(channels)} " + " ".join(channels),
        ]
    lines += ["End Site", "{", "OFFSET 0 5 0", "}", *"}" * len(ORDERS)]
    rows = random.uniform(-180.0, 180.0, (20, columns))
    lines += ["MOTION", f"Frames: {len(rows)}", "Frame Time: 0.01"]
    lines += [" ".join(f"{value:.4f}" for value in row) for row in rows]
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("positions_first", [True, False])
def test_every_order_of_rotations(tmp_path: Path, positions_first: bool) -> None:
    path = tmp_path / "chain.bvh"
    path.write_text(chain_of_all_orders(positions_first), encoding="utf-8")
    check_against_pybvh(path)
    check_against_bvhio(path)


def test_generated_motion(library: Path) -> None:
    path = next(iter(sorted(library.glob("*.bvh"))))
    check_against_pybvh(path)
    check_against_bvhio(path)


def world_rotations(motion: Motion) -> Points:
    """(frames, joints, 3, 3) from the rotations in the parents."""
    local = matrices_of(np.asarray(motion.rotations))
    turned = local.copy()
    for joint, parent in enumerate(motion.skeleton.parents):
        if parent >= 0:
            turned[:, joint] = turned[:, parent] @ local[:, joint]
    return turned


def matrices_of(quaternions: Points) -> Points:
    """(..., 3, 3) of (..., 4), w x y z, by SciPy."""
    flat = Rotation.from_quat(quaternions.reshape(-1, 4)[:, [1, 2, 3, 0]]).as_matrix()
    return np.asarray(flat.reshape(*quaternions.shape[:-1], 3, 3))


def rotations_by_bvhio(root: bvhio.Joint, names: list[str]) -> Points:
    """(joints, 3, 3) in the world, of the pose that is loaded."""
    found = {joint.Name: joint.RotationWorld for joint, _, _ in root.layout()}
    return matrices_of(np.array([[q.w, q.x, q.y, q.z] for q in map(found.__getitem__, names)]))


def test_a_reconstruction_with_feet_and_hands_turns_alike_in_public_readers(
    database: MotionDatabase, take_path: Path, tmp_path: Path
) -> None:
    motion = reconstruct(read_take(take_path), database).motion
    path = tmp_path / "take.bvh"
    write_bvh(path, motion)
    names = motion.skeleton.names
    assert len(names) == len(standard_joint_names()) + 6
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        clip = pybvh.read_bvh_file(path)
    _, local = clip.to_rotmat()
    by_name = [clip.joint_names.index(name) for name in names]
    ours = matrices_of(np.asarray(motion.rotations))
    np.testing.assert_allclose(np.asarray(local)[:, by_name], ours, atol=1e-6)
    root = bvhio.readAsHierarchy(str(path))
    root.loadRestPose()
    in_rest = rotations_by_bvhio(root, names)  # it lays its axes along the bones
    for frame in some_frames(motion):
        root.loadPose(frame)
        turned = rotations_by_bvhio(root, names) @ in_rest.swapaxes(1, 2)
        np.testing.assert_allclose(turned, world_rotations(motion)[frame], atol=2e-5)


def test_files_of_many_exporters(real_data: Path) -> None:
    files = sorted((real_data / "bvh_exporters").rglob("*.bvh"))
    assert len({path.relative_to(real_data).parts[1] for path in files}) > 10
    for path in files:
        check_against_bvhio(path)
    exact = [path for path in files if is_for_pybvh(path)]
    assert len(exact) >= 50
    for path in exact:
        check_against_pybvh(path)


def test_recordings_of_cmu(real_data: Path) -> None:
    files = sorted((real_data / "cmu" / "bvh").glob("*.bvh"))[::10]
    assert files
    for path in files:
        check_against_pybvh(path)
