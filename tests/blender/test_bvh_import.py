# SPDX-License-Identifier: GPL-3.0-or-later
"""Joint positions and rotations as Blender's own importer of BVH has them."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
from support import Skipped, evaluated_pivots, in_blenders_axes, library, real_data

CENTIMETRE = 0.01
UP_Z = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])  # to Blender's axes from those of the file
FLOATS = 2e-5  # of rotations
FLOATS_M = 1e-4  # what Blender's single precision leaves after a chain of bones


def imported(path: Path):
    """The armature that Blender makes of the file; its bones' heads are the joints' pivots."""
    if bpy.app.version < (4, 0):
        raise Skipped("the importer of Blender 3.4 asks for open(..., 'rU'), which is no more")
    bpy.ops.import_anim.bvh(
        filepath=str(path), global_scale=CENTIMETRE, rotate_mode="NATIVE", frame_start=1,
        axis_forward="-Z", axis_up="Y", update_scene_fps=False, update_scene_duration=False,
    )  # fmt: skip
    return bpy.context.view_layer.objects.active


def check(path: Path) -> None:
    """Joints without a bone end at their pivot, which is what both sides are asked for."""
    from sparse_mocap import read_motion

    motion, _ = read_motion(path)
    armature = imported(path)
    names = motion.skeleton.names
    plain = [joint for joint, bone in enumerate(motion.skeleton.bones) if not bone.any()]
    ours = in_blenders_axes(motion.joint_positions("world"))
    for frame in sorted({0, motion.num_frames // 2, motion.num_frames - 1}):
        theirs = evaluated_pivots(armature, frame + 1, [names[joint] for joint in plain])
        np.testing.assert_allclose(ours[frame, plain], theirs, atol=FLOATS_M, err_msg=str(path))


def test_blenders_importer_agrees_on_generated_motion() -> None:
    check(sorted(library().motions.glob("*.bvh"))[0])


def test_blenders_importer_turns_feet_and_hands_of_a_reconstruction_alike(tmp_path: Path) -> None:
    import sparse_mocap

    take = sparse_mocap.read_take(library().take)
    motion = sparse_mocap.reconstruct(take, library().database).motion
    path = tmp_path / "take.bvh"
    sparse_mocap.write_bvh(path, motion)
    check(path)
    armature = bpy.context.view_layer.objects.active
    ours = world_rotations(motion)
    assert ours.shape[1] == 27
    for frame in sorted({0, motion.num_frames // 2, motion.num_frames - 1}):
        bpy.context.scene.frame_set(frame + 1)
        posed = armature.evaluated_get(bpy.context.evaluated_depsgraph_get()).pose.bones
        for joint, name in enumerate(motion.skeleton.names):
            turn = posed[name].matrix @ posed[name].bone.matrix_local.inverted()
            in_files_axes = UP_Z.T @ np.array(turn.to_3x3()) @ UP_Z
            np.testing.assert_allclose(in_files_axes, ours[frame, joint], atol=FLOATS, err_msg=name)


def world_rotations(motion) -> np.ndarray:
    """(T, J, 3, 3) from the quaternions in the parents."""
    w, x, y, z = np.moveaxis(np.asarray(motion.rotations), -1, 0)
    local = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip
    world = np.moveaxis(local, (0, 1), (-2, -1)).copy()
    for joint, parent in enumerate(motion.skeleton.parents):
        if parent >= 0:
            world[:, joint] = world[:, parent] @ world[:, joint]
    return world


def test_blenders_importer_agrees_on_files_of_many_exporters() -> None:
    folder = real_data() / "bvh_exporters"
    sources = sorted(path for path in folder.iterdir() if path.is_dir())
    assert len(sources) > 10
    for source in sources:
        check(min(source.rglob("*.bvh"), key=lambda path: path.stat().st_size))
