# SPDX-License-Identifier: GPL-3.0-or-later
"""Joint positions as Blender's own importer of BVH has them."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
from support import Skipped, evaluated_pivots, in_blenders_axes, library, real_data

CENTIMETRE = 0.01
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


def test_blenders_importer_agrees_on_files_of_many_exporters() -> None:
    folder = real_data() / "bvh_exporters"
    sources = sorted(path for path in folder.iterdir() if path.is_dir())
    assert len(sources) > 10
    for source in sources:
        check(min(source.rglob("*.bvh"), key=lambda path: path.stat().st_size))
