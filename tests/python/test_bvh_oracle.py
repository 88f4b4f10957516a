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
from sparse_mocap import Motion, read_motion

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
