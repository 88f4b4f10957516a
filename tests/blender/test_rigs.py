# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes on animators' own characters. Blender's evaluated bones are compared with the solver's."""

from __future__ import annotations

import bpy
import numpy as np
import rigs
from rig_baking import bake, limbs_of, points_of, solved, worst_mean_degrees
from support import addon, choose_files, error_of, reconstruct, settings

_MEAN_DEG, _WORST_M = 1.0, 0.005
_FK_RIGIFY = {
    "lfemur": ("DEF-thigh.L", "DEF-shin.L"),
    "ltibia": ("DEF-shin.L", "DEF-foot.L"),
    "rfemur": ("DEF-thigh.R", "DEF-shin.R"),
    "rtibia": ("DEF-shin.R", "DEF-foot.R"),
    "lhumerus": ("DEF-upper_arm.L", "DEF-forearm.L"),
    "lradius": ("DEF-forearm.L", "DEF-hand.L"),
    "rhumerus": ("DEF-upper_arm.R", "DEF-forearm.R"),
    "rradius": ("DEF-forearm.R", "DEF-hand.R"),
}


def _worst_distance_m(armature, style: str) -> float:
    """Of wrists, ankles and head from the middle of the hips."""
    motion, named = solved(), rigs.STYLES[style]
    joints = list(motion.skeleton.names)
    bones = [named.name(part, side) for part in ("hand", "foot", "thigh") for side in "LR"]
    points = points_of(armature, range(1, 1 + motion.num_frames), [*bones, named.name("head")])
    pivots = rigs.in_blenders_axes(motion.pivot_positions())
    ends = rigs.in_blenders_axes(motion.joint_positions("world"))
    of = {name: number for number, name in enumerate(joints)}
    wanted = [ends[:, of[name]] for name in ("lradius", "rradius", "ltibia", "rtibia")]
    wanted += [pivots[:, of[name]] for name in ("lfemur", "rfemur", "head")]
    wanted = np.stack(wanted, axis=1)
    for positions in (points, wanted):
        positions -= positions[:, 4:6].mean(axis=1, keepdims=True)
    return float(np.linalg.norm(points - wanted, axis=-1).max())


def test_limbs_point_where_the_solvers_do_on_every_programs_names():
    for style in rigs.STYLES:
        for pose in ("t", "a"):
            root = "root" if style == "unreal" else ""
            armature = rigs.named_rig(style, pose=pose, rolls=pose == "a", root=root)
            bake(armature)
            degrees = worst_mean_degrees(armature, limbs_of(style))
            metres = _worst_distance_m(armature, style)
            print(f"{style}, {pose}-pose: {degrees:.2f} degrees, {1e3 * metres:.1f} mm")
            assert degrees <= _MEAN_DEG
            assert metres <= _WORST_M


def test_limbs_point_where_the_solvers_do_on_rigify():
    metarig = rigs.rigify_rig(generated=False)
    bake(metarig)
    plain = {j: tuple(n.removeprefix("DEF-") for n in names) for j, names in _FK_RIGIFY.items()}
    degrees = worst_mean_degrees(metarig, plain)
    print(f"metarig: {degrees:.2f} degrees")
    assert degrees <= _MEAN_DEG
    generated = rigs.rigify_rig()
    character = addon("scene.binding").bind(bpy.context, generated).character
    trunk = ("root", "lowerback", "upperback", "thorax", "lowerneck", "head")
    controls = ("spine_fk", "spine_fk.001", "spine_fk.002", "spine_fk.003", "neck", "head")
    assert tuple(character.joints[joint] for joint in trunk) == controls
    bake(generated)
    degrees = worst_mean_degrees(generated, _FK_RIGIFY)
    print(f"generated, FK: {degrees:.2f} degrees")
    assert degrees <= _MEAN_DEG


def test_scaled_rotated_and_parented_characters_move_in_metres():
    for scale in (0.01, 100.0):
        armature = rigs.named_rig("mixamo", scale=scale)
        parent = bpy.data.objects.new("parent", None)
        bpy.context.scene.collection.objects.link(parent)
        parent.location, parent.rotation_euler.z = (3.0, -2.0, 0.0), np.radians(90.0)
        armature.parent = parent
        bpy.context.view_layer.update()
        bake(armature)
        turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        assert worst_mean_degrees(armature, limbs_of("mixamo"), turn) <= _MEAN_DEG
        motion = solved()
        frames = [1, motion.num_frames]
        thighs = [rigs.STYLES["mixamo"].name("thigh", side) for side in "LR"]
        begin, end = points_of(armature, frames, thighs).mean(axis=1)
        joints = list(motion.skeleton.names)
        both = [joints.index("lfemur"), joints.index("rfemur")]
        wanted = rigs.in_blenders_axes(motion.pivot_positions())[:, both].mean(axis=1)
        assert np.abs((end - begin) - turn @ (wanted[-1] - wanted[0])).max() < 0.002


def test_an_armature_with_y_up_turned_upright_by_its_object():
    armature = rigs.named_rig("motionbuilder")
    bpy.ops.object.mode_set(mode="EDIT")
    for bone in armature.data.edit_bones:
        bone.head, bone.tail = (
            (point[0], point[2], -point[1]) for point in (bone.head.copy(), bone.tail.copy())
        )
    bpy.ops.object.mode_set(mode="OBJECT")
    armature.rotation_euler.x = np.radians(90.0)
    bpy.context.view_layer.update()
    bake(armature)
    assert worst_mean_degrees(armature, limbs_of("motionbuilder")) <= _MEAN_DEG
    assert _worst_distance_m(armature, "motionbuilder") <= _WORST_M


def test_each_bone_keeps_its_rotation_mode_and_angles_do_not_jump():
    for mode in ("XYZ", "ZXY", "AXIS_ANGLE"):
        armature = rigs.named_rig("vrm", rolls=True, rotation_mode=mode)
        action = bake(armature)
        assert {bone.rotation_mode for bone in armature.pose.bones} == {mode}
        assert worst_mean_degrees(armature, limbs_of("vrm")) <= _MEAN_DEG
        curves = addon("scene.compat").curves_of(action)
        wanted = "rotation_axis_angle" if mode == "AXIS_ANGLE" else "rotation_euler"
        turning = [curve for curve in curves if "rotation" in curve.data_path]
        assert turning
        for curve in turning:
            assert curve.data_path.endswith(wanted)
            if mode != "AXIS_ANGLE":
                values = [key.co.y for key in curve.keyframe_points]
                assert np.abs(np.diff(values)).max() < np.pi / 2


def test_other_proportions_scale_the_way_and_keep_the_feet_on_the_floor():
    small, large = (rigs.named_rig("unreal", size=size) for size in (0.6, 1.4))
    foot = [rigs.STYLES["unreal"].name("foot", side) for side in "LR"]
    ways, lows = [], []
    for armature in (small, large):
        rest = np.mean([armature.data.bones[name].head_local.z for name in foot])
        sole = armature.data.bones[rigs.STYLES["unreal"].name("toe", "L")].tail_local.z
        bake(armature)
        points = points_of(armature, range(1, 1 + solved().num_frames), foot)
        lows.append(np.quantile(points[..., 2].min(axis=1), 0.05) - (rest - sole))
        ways.append(np.linalg.norm((points[-1] - points[0]).mean(axis=0)))
    assert np.abs(lows).max() < 0.005
    assert abs(ways[0] / ways[1] - 0.6 / 1.4) < 0.01


def test_only_mapped_bones_are_keyed_and_the_fingers_animation_is_kept():
    armature = rigs.rigify_rig()
    finger = armature.pose.bones["f_index.01.L"]
    finger.rotation_mode = "XYZ"
    for frame, angle in ((1, 0.0), (20, 1.0)):
        finger.rotation_euler.x = angle
        finger.keyframe_insert("rotation_euler", frame=frame)
    bones = {bone.name: [c.type for c in bone.constraints] for bone in armature.pose.bones}
    old = armature.animation_data.action
    action = bake(armature)
    assert action != old
    assert old.name in bpy.data.actions
    bpy.context.scene.frame_set(20)
    assert abs(finger.rotation_euler.x - 1.0) < 1e-6
    paths = {curve.data_path for curve in addon("scene.compat").curves_of(action)}
    assert any("f_index.01.L" in path for path in paths)
    assert not any("DEF-" in path or "MCH-" in path or "f_ring" in path for path in paths)
    assert bones == {bone.name: [c.type for c in bone.constraints] for bone in armature.pose.bones}
    again = bake(armature)
    assert any("f_index.01.L" in c.data_path for c in addon("scene.compat").curves_of(again))


def test_several_characters_at_once():
    first, second = rigs.named_rig("mixamo"), rigs.named_rig("vrm", size=0.8)
    choose_files()
    settings().target, settings().to_selected, settings().foot_lock = first, True, 0.0
    second.select_set(True)
    reconstruct()
    assert first.animation_data.action != second.animation_data.action
    assert worst_mean_degrees(first, limbs_of("mixamo")) <= _MEAN_DEG
    assert worst_mean_degrees(second, limbs_of("vrm")) <= _MEAN_DEG
    assert not any("sparse_mocap" in armature for armature in bpy.data.armatures)


def test_keys_lie_on_whole_frames_and_the_scene_ends_with_the_take():
    armature = rigs.named_rig("mixamo")
    scene = bpy.context.scene
    scene.render.fps, scene.frame_end = 30, 10
    action = bake(armature, extend_scene=True)
    curve = addon("scene.compat").curves_of(action)[0]
    frames = np.array([key.co.x for key in curve.keyframe_points])
    assert np.array_equal(frames, 1.0 + np.arange(solved().num_frames))
    assert scene.frame_end == frames[-1]
    assert scene.render.fps == 30
    scene.frame_end = 10
    action = bake(armature, whole_frames=False)
    curve = addon("scene.compat").curves_of(action)[0]
    assert abs(curve.keyframe_points[1].co.x - (1.0 + 30.0 / 25.0)) < 1e-4
    assert scene.frame_end == 10


def test_a_character_that_cannot_be_used_is_named_with_what_to_do():
    choose_files()
    armature = rigs.named_rig("mixamo")
    settings().target = armature
    armature.scale = (-1.0, 1.0, 1.0)
    assert "negative scale" in error_of(bpy.ops.sparse_mocap.reconstruct)
    armature.scale = (1.0, 1.0, 2.0)
    assert "unevenly" in error_of(bpy.ops.sparse_mocap.reconstruct)
    armature.scale = (1.0, 1.0, 1.0)
    armature.data.pose_position = "REST"
    assert "rest position" in error_of(bpy.ops.sparse_mocap.reconstruct)
    armature.data.pose_position = "POSE"
    armature.hide_set(True)
    assert "hidden" in error_of(bpy.ops.sparse_mocap.reconstruct)
    empty = bpy.data.objects.new("empty", bpy.data.armatures.new("empty"))
    bpy.context.scene.collection.objects.link(empty)
    settings().target = empty
    assert "no bones" in error_of(bpy.ops.sparse_mocap.reconstruct)
    snake = rigs.named_rig("mixamo")
    bpy.ops.object.mode_set(mode="EDIT")
    for bone in list(snake.data.edit_bones)[8:]:
        snake.data.edit_bones.remove(bone)
    bpy.ops.object.mode_set(mode="OBJECT")
    settings().target = snake
    assert "human" in error_of(bpy.ops.sparse_mocap.reconstruct)


def test_binding_a_character_leaves_its_pose_and_action():
    armature = rigs.named_rig("mixamo", rotation_mode="XYZ")
    hips = armature.pose.bones["mixamorig:Hips"]
    hips.rotation_euler.x = 0.5
    hips.keyframe_insert("rotation_euler", frame=1)
    arm = armature.pose.bones["mixamorig:LeftArm"]
    arm.rotation_euler.y, arm.scale.x = 0.25, 1.5
    action = armature.animation_data.action
    was_fake = action.use_fake_user
    addon("scene.binding").bind(bpy.context, armature)
    assert armature.animation_data.action == action
    assert action.use_fake_user == was_fake
    assert abs(hips.rotation_euler.x - 0.5) < 1e-6
    assert abs(arm.rotation_euler.y - 0.25) < 1e-6
    assert abs(arm.scale.x - 1.5) < 1e-6
