# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np

from blender_addon.scene.axes import (
    AXES_BLENDER_CORE,
    bone_quaternions,
    continuous,
    rest_pivots_and_ends,
    to_blender,
)


def _matrix(quaternion):
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _random_quaternions(count, seed=0):
    values = np.random.default_rng(seed).normal(size=(count, 4))
    return values / np.linalg.norm(values, axis=1, keepdims=True)


def test_up_front_and_left():
    assert to_blender([0, 1, 0]).tolist() == [0, 0, 1]
    assert to_blender([0, 0, 1]).tolist() == [0, -1, 0]
    assert to_blender([1, 0, 0]).tolist() == [1, 0, 0]
    assert np.linalg.det(AXES_BLENDER_CORE) == 1.0


def test_a_bone_turns_as_its_joint_whatever_its_rest():
    turns, rests = _random_quaternions(50), _random_quaternions(50, seed=1)
    axes = AXES_BLENDER_CORE
    for turn, rest in zip(turns, map(_matrix, rests), strict=True):
        wanted = rest.T @ axes @ _matrix(turn) @ axes.T @ rest
        assert np.allclose(_matrix(bone_quaternions(turn, rest)), wanted, atol=1e-12)


def test_signs_never_jump():
    angles = np.linspace(0.0, 20.0, 400)
    spin = np.column_stack([np.cos(angles / 2), np.zeros((400, 2)), np.sin(angles / 2)])
    flipped = spin * np.random.default_rng(2).choice([-1.0, 1.0], size=(400, 1))
    result = continuous(flipped)
    assert np.allclose(result, spin)
    assert (np.einsum("ij,ij->i", result[1:], result[:-1]) > 0).all()
    assert continuous(np.empty((0, 4))).shape == (0, 4)


def test_rest_pose_of_acclaim_bones_and_bvh_joints():
    parents = [-1, 0, 1]
    bones = [[0, 0, 0], [0, 1, 0], [0, 2, 0]]
    pivots, ends = rest_pivots_and_ends(parents, np.zeros((3, 3)), bones)
    assert pivots[:, 1].tolist() == [0, 0, 1]
    assert ends[:, 1].tolist() == [0, 1, 3]
    pivots, ends = rest_pivots_and_ends(parents, bones, np.zeros((3, 3)))
    assert pivots[:, 1].tolist() == ends[:, 1].tolist() == [0, 1, 3]
