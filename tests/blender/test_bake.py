# SPDX-License-Identifier: GPL-3.0-or-later
"""What is done with a take's action: parts, fewer keys, updates, comparison, the NLA."""

from __future__ import annotations

import bpy
import numpy as np
import rigs
from rig_baking import bake, points_of
from support import addon, choose_files, error_of, settings, undo

_FEET = ("mixamorig:LeftFoot", "mixamorig:RightFoot")
_ENDS = (*_FEET, "mixamorig:LeftHand", "mixamorig:RightHand", "mixamorig:Head")


def _num_keys(action) -> int:
    return sum(len(curve.keyframe_points) for curve in addon("scene.compat").curves_of(action))


def _directions(armature, frames, bones) -> np.ndarray:
    found = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        found.append([np.array(evaluated.pose.bones[name].matrix)[:3, :3] for name in bones])
    return np.array(found)


def test_a_part_of_the_take():
    armature = rigs.named_rig("mixamo")
    whole = bake(armature)
    settings().use_range = True
    settings().range_begin_s, settings().range_end_s = 1.0, 2.0
    part = bake(armature)
    assert part.frame_range[0] == 1.0
    assert abs((part.frame_range[1] - 1.0) / 24.0 - 1.0) < 0.1
    assert part.frame_range[1] < whole.frame_range[1]
    settings().range_begin_s = 100.0
    assert "3.9 s long" in error_of(bpy.ops.sparse_mocap.reconstruct)


def test_fewer_keys_within_the_error():
    for mode in ("QUATERNION", "XYZ"):
        armature = rigs.named_rig("mixamo", rotation_mode=mode)
        bones = [bone.name for bone in armature.pose.bones if "Toe" not in bone.name]
        frames = range(1, 80)
        action = bake(armature)
        before, all_keys = _directions(armature, frames, bones), _num_keys(action)
        places = points_of(armature, frames, ["mixamorig:Hips"])
        settings().reduce_keys = True
        settings().largest_error_deg, settings().largest_error_cm = 1.0, 0.5
        action = bake(armature)
        settings().reduce_keys = False
        after, few_keys = _directions(armature, frames, bones), _num_keys(action)
        parents = [armature.pose.bones[name].parent for name in bones]
        worst = 0.0
        for number, parent in enumerate(parents):
            a, b = before[:, number], after[:, number]
            if parent is not None:  # each bone's own error, not that of what it hangs on
                above = bones.index(parent.name)
                a = np.swapaxes(before[:, above], 1, 2) @ a
                b = np.swapaxes(after[:, above], 1, 2) @ b
            traces = np.einsum("tij,tij->t", a, b)
            worst = max(worst, np.degrees(np.arccos(np.clip((traces - 1) / 2, -1, 1))).max())
        moved = np.abs(points_of(armature, frames, ["mixamorig:Hips"]) - places).max()
        print(f"{mode}: {all_keys} keys, {few_keys} after; off by {worst:.2f} deg, {moved:.4f} m")
        assert few_keys < 0.5 * all_keys
        assert worst <= 1.05
        assert moved <= 0.0055


def test_smoothing_makes_motion_smoother():
    armature = rigs.named_rig("mixamo")

    def roughness() -> float:
        points = points_of(armature, range(1, 90), ["mixamorig:LeftHand"])[:, 0]
        return float(np.linalg.norm(np.diff(points, n=3, axis=0), axis=1).mean())

    bake(armature)
    before = roughness()
    settings().smooth_s = 0.1
    bake(armature)
    assert roughness() < 0.7 * before


def test_an_action_is_updated_without_reconstructing():
    armature = rigs.named_rig("mixamo")
    action = bake(armature, foot_lock=0.0)
    name, frames = action.name, range(1, 60)
    before = points_of(armature, frames, _ENDS)
    num_actions = len(bpy.data.actions)
    window = bpy.context.window_manager.windows[0]
    settings().foot_lock = 1.0
    with bpy.context.temp_override(window=window):
        bpy.ops.ed.undo_push(message="before")
        done = bpy.ops.sparse_mocap.update_action("EXEC_DEFAULT", True)
    assert done == {"FINISHED"}
    armature = bpy.data.objects["mixamo"]
    assert armature.animation_data.action.name == name
    assert len(bpy.data.actions) == num_actions
    after = points_of(armature, frames, _ENDS)
    assert np.abs(after[:, :2] - before[:, :2]).max() > 0.01
    undo()
    armature = bpy.data.objects["mixamo"]
    assert np.abs(points_of(armature, frames, _ENDS) - before).max() < 1e-4


def test_what_cannot_be_updated_is_said_in_one_line():
    armature = rigs.named_rig("mixamo")
    assert "Select a character" in error_of(bpy.ops.sparse_mocap.update_action)
    bake(armature)
    addon("session.reconstruct")._kept.clear()
    assert "earlier session" in error_of(bpy.ops.sparse_mocap.update_action)


def test_two_results_are_compared_with_a_ghost():
    armature = rigs.named_rig("mixamo")
    first = bake(armature)
    second = bake(armature, offline=True)
    assert "Choose the action" in error_of(bpy.ops.sparse_mocap.compare)
    assert bpy.ops.sparse_mocap.compare(action=first.name) == {"FINISHED"}
    ghost = addon("scene.ghost").ghost_of(bpy.context, armature)
    assert ghost.animation_data.action == first
    assert armature.animation_data.action == second
    assert ghost.hide_select
    frames = range(5, 50, 5)
    apart = points_of(ghost, frames, _ENDS) - points_of(armature, frames, _ENDS)
    assert np.abs(apart).max() > 1e-3
    bpy.ops.sparse_mocap.compare(action=second.name)
    assert len([obj for obj in bpy.data.objects if "sparse_mocap_ghost" in obj]) == 1
    ghost = addon("scene.ghost").ghost_of(bpy.context, armature)
    apart = points_of(ghost, frames, _ENDS) - points_of(armature, frames, _ENDS)
    assert np.abs(apart).max() < 1e-5
    assert bpy.ops.sparse_mocap.stop_comparing() == {"FINISHED"}
    assert addon("scene.ghost").ghost_of(bpy.context, armature) is None


def test_a_take_plays_the_same_as_a_strip_of_the_nla():
    armature = rigs.named_rig("mixamo")
    action = bake(armature, start_frame=11.0)
    frames = range(12, 60, 7)
    before = points_of(armature, frames, _ENDS)
    assert bpy.ops.sparse_mocap.push_to_nla() == {"FINISHED"}
    assert armature.animation_data.action is None
    [track] = armature.animation_data.nla_tracks
    assert track.strips[0].action == action
    assert np.abs(points_of(armature, frames, _ENDS) - before).max() < 1e-4
    assert "Select a character" in error_of(bpy.ops.sparse_mocap.push_to_nla)


def test_an_armature_tweaked_in_the_nla_is_left_alone():
    armature = rigs.named_rig("mixamo")
    bake(armature)
    bpy.ops.sparse_mocap.push_to_nla()
    track = armature.animation_data.nla_tracks[0]
    track.select = track.strips[0].select = True
    armature.animation_data.nla_tracks.active = track
    armature.animation_data.use_tweak_mode = True
    settings().target = armature
    choose_files()
    assert "tweak" in error_of(bpy.ops.sparse_mocap.reconstruct)
    armature.animation_data.use_tweak_mode = False
    bake(armature)
