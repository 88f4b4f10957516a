# SPDX-License-Identifier: GPL-3.0-or-later
import bpy
import numpy as np
from support import (
    addon,
    choose_files,
    contents,
    error_of,
    evaluated_points,
    expected_performance,
    in_blenders_axes,
    library,
    raised,
    reconstruct,
    settings,
    undo,
)


def _curves(armature):
    return addon("scene.compat").curves_of(armature.animation_data.action)


def _keys(curve):
    values = np.empty(2 * len(curve.keyframe_points))
    curve.keyframe_points.foreach_get("co", values)
    return values.reshape(-1, 2)


def _positions_at_rate(fps, fps_base, **options):
    render = bpy.context.scene.render
    render.fps, render.fps_base = fps, fps_base
    end = bpy.context.scene.frame_end
    choose_files()
    armature = reconstruct(whole_frames=False, **options)
    assert (render.fps, round(render.fps_base, 6)) == (fps, round(fps_base, 6))
    assert bpy.context.scene.frame_end == end
    motion = expected_performance(offline=options.get("offline", False)).motion
    wanted = in_blenders_axes(motion.joint_positions("world"))
    first = options.get("start_frame", 1.0)
    for index in range(motion.num_frames):
        frame = first + index * motion.frame_time_s * fps / fps_base
        found = evaluated_points(armature, frame, motion.skeleton.names)
        error = np.linalg.norm(found - wanted[index], axis=1).max()
        assert error < 1e-3, f"{1000 * error:.2f} mm off at frame {frame}"


def test_positions_at_24_fps():
    _positions_at_rate(24, 1.0)


def test_positions_at_25_fps():
    _positions_at_rate(25, 1.0, offline=True)


def test_positions_at_29_97_fps():
    _positions_at_rate(30, 1.001, start_frame=-20.0)


def test_positions_at_60_fps():
    _positions_at_rate(60, 1.0, start_frame=101.0)


def test_positions_in_a_scene_of_centimetres():
    units = bpy.context.scene.unit_settings
    units.system, units.scale_length = "METRIC", 0.01
    choose_files()
    armature = reconstruct(whole_frames=False)
    motion = expected_performance().motion
    wanted = 100.0 * in_blenders_axes(motion.joint_positions("world"))
    frame = 1.0 + 10 * motion.frame_time_s * 24
    found = evaluated_points(armature, frame, motion.skeleton.names)
    assert np.abs(found - wanted[10]).max() < 0.1


def test_keys_are_grouped_continuous_quaternions():
    choose_files()
    armature = reconstruct(whole_frames=False)
    action = armature.animation_data.action
    assert action.name == "first_walk"
    assert action.use_fake_user
    num_keys = expected_performance().motion.num_frames
    by_path = {}
    for curve in _curves(armature):
        bone = curve.data_path.split('"')[1]
        assert curve.group.name == bone
        keys = _keys(curve)
        assert len(keys) == num_keys
        assert {key.interpolation for key in curve.keyframe_points} == {"LINEAR"}
        by_path.setdefault(curve.data_path, {})[curve.array_index] = keys[:, 1]
    rotations = [path for path in by_path if path.endswith("rotation_quaternion")]
    assert len(rotations) == 27  # with feet, toes and hands
    assert set(by_path) - set(rotations) == {'pose.bones["pelvis"].location'}
    for path in rotations:
        quaternions = np.column_stack([by_path[path][index] for index in range(4)])
        assert np.allclose(np.linalg.norm(quaternions, axis=1), 1.0, atol=1e-4)
        assert (np.einsum("ij,ij->i", quaternions[1:], quaternions[:-1]) > 0.0).all()
    assert {bone.rotation_mode for bone in armature.pose.bones} == {"QUATERNION"}


def test_rest_pose_stands_on_the_ground_and_faces_front():
    choose_files()
    bones = reconstruct().data.bones
    heights = [point.z for bone in bones for point in (bone.head_local, bone.tail_local)]
    assert abs(min(heights)) < 1e-4
    assert 1.3 < max(heights) < 2.2
    assert bones["upper_arm.L"].tail_local.x > 0.2  # the character's left
    assert bones["wrist.L"].parent == bones["forearm.L"]
    assert bones["toe.L"].parent.parent == bones["foot.L"].parent == bones["shin.L"]
    assert bones["toe.L"].tail_local.y < bones["shin.L"].tail_local.y - 0.1
    for bone in bones:
        other = bpy.utils.flip_name(bone.name)
        assert (other != bone.name) == bone.name.endswith((".L", ".R"))
        assert np.allclose(
            np.array(bones[other].head_local) * [-1, 1, 1], bone.head_local, atol=1e-4
        )
    up = bones["pelvis"].tail_local - bones["pelvis"].head_local
    assert up.z > 0.05
    assert abs(up.x) + abs(up.y) < 1e-6


def test_the_figure_gets_a_body_that_moves_with_it():
    choose_files()
    armature = reconstruct()
    assert bpy.ops.sparse_mocap.add_body() == {"FINISHED"}
    [body] = armature.children
    found = []
    for frame in (1, 40):
        bpy.context.scene.frame_set(frame)
        evaluated = body.evaluated_get(bpy.context.evaluated_depsgraph_get())
        found.append(np.array([tuple(vertex.co) for vertex in evaluated.data.vertices]))
    assert np.abs(found[0] - found[1]).max() > 0.05
    rest = np.array([tuple(vertex.co) for vertex in body.data.vertices])
    assert -0.03 < rest[:, 2].min() <= 0.0
    assert 1.4 < rest[:, 2].max() < 2.0
    assert not bpy.ops.sparse_mocap.add_body.poll()


def test_an_armature_of_the_release_before_takes_takes():
    choose_files()
    motion = expected_performance().motion
    armature_module = addon("scene.armature")
    old = armature_module.new_armature(bpy.context, motion.skeleton, is_figure=False).armature
    assert "lfemur" in old.data.bones
    assert reconstruct(reuse_armature=True, whole_frames=False) == old
    wanted = in_blenders_axes(motion.joint_positions("world"))[0]
    assert np.abs(evaluated_points(old, 1.0, motion.skeleton.names) - wanted).max() < 1e-3


def test_armature_is_selected_alone():
    mesh = bpy.data.objects.new("other", bpy.data.meshes.new("other"))
    bpy.context.scene.collection.objects.link(mesh)
    mesh.select_set(True)
    bpy.context.view_layer.objects.active = mesh
    choose_files()
    armature = reconstruct()
    assert armature.select_get()
    assert not mesh.select_get()
    assert bpy.context.view_layer.objects.active == armature
    assert mesh.matrix_world.is_identity


def test_one_undo_removes_everything():
    choose_files()
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window):
        bpy.ops.ed.undo_push(message="before")
    before = contents()
    with bpy.context.temp_override(window=window):
        done = bpy.ops.sparse_mocap.reconstruct("EXEC_DEFAULT", True)
    assert done == {"FINISHED"}
    assert len(bpy.data.armatures) == len(bpy.data.actions) == 1
    undo()
    assert contents() == before


def test_second_take_goes_on_the_same_armature_and_actions_swap():
    choose_files()
    settings().whole_frames = False
    first_armature = reconstruct().name
    armature = reconstruct(reuse_armature=True, offline=True)
    assert armature.name == first_armature
    assert [len(bpy.data.objects), len(bpy.data.armatures), len(bpy.data.actions)] == [1, 1, 2]
    first, second = bpy.data.actions["first_walk"], bpy.data.actions["first_walk.001"]
    assert armature.animation_data.action == second
    names = list(expected_performance().motion.skeleton.names)
    frame = 1.0 + 20 * 24 / 25
    found = {}
    for action in (first, second, first):
        armature.animation_data.action = action  # as the user's menu does, slot and all
        if hasattr(armature.animation_data, "action_slot"):
            assert armature.animation_data.action_slot is not None
        found[action.name] = evaluated_points(armature, frame, names)
        motion = expected_performance(offline=action == second).motion
        wanted = in_blenders_axes(motion.joint_positions("world"))[20]
        assert np.abs(found[action.name] - wanted).max() < 1e-3
    assert np.abs(found[first.name] - found[second.name]).max() > 1e-3


def test_a_new_armature_is_made_unless_told_otherwise():
    choose_files()
    names = {reconstruct().name, reconstruct().name}
    assert len(names) == len(bpy.data.armatures) == 2
    bpy.context.view_layer.objects.active = None
    line = error_of(lambda: bpy.ops.sparse_mocap.reconstruct(reuse_armature=True))
    assert "select the one" in line


def test_scaled_and_moved_armature_takes_a_second_take():
    choose_files()
    settings().whole_frames = False
    armature = reconstruct()
    armature.location, armature.scale = (1.0, 2.0, 3.0), (2.0, 2.0, 2.0)
    reconstruct(reuse_armature=True)
    motion = expected_performance().motion
    wanted = 2.0 * in_blenders_axes(motion.joint_positions("world"))[0] + [1.0, 2.0, 3.0]
    found = evaluated_points(armature, 1.0, motion.skeleton.names)
    assert np.abs(found - wanted).max() < 2e-3


def test_bones_that_were_made_to_turn_otherwise_turn_by_the_keys():
    choose_files()
    settings().whole_frames = False
    armature = reconstruct()
    armature.pose.bones["upper_arm.L"].rotation_mode = "XYZ"
    reconstruct(reuse_armature=True)
    motion = expected_performance().motion
    wanted = in_blenders_axes(motion.joint_positions("world"))[0]
    assert np.abs(evaluated_points(armature, 1.0, motion.skeleton.names) - wanted).max() < 1e-3


def test_what_is_not_given_comes_from_the_panel():
    choose_files()
    settings().start_frame, settings().offline = 40.0, True
    first = reconstruct().animation_data.action
    assert round(first.frame_range[0], 4) == 40.0
    second = reconstruct(start_frame=7.0).animation_data.action
    assert round(second.frame_range[0], 4) == 7.0


def test_works_from_another_mode():
    choose_files()
    armature = reconstruct()
    bpy.ops.object.mode_set(mode="POSE")
    assert reconstruct().name != armature.name
    assert bpy.context.mode == "OBJECT"


def test_hidden_collection_still_gets_a_visible_armature():
    layer = bpy.context.view_layer
    collection = bpy.data.collections.new("hidden")
    bpy.context.scene.collection.children.link(collection)
    layer.active_layer_collection = layer.layer_collection.children["hidden"]
    layer.layer_collection.children["hidden"].hide_viewport = True
    choose_files()
    assert reconstruct().visible_get()


def test_what_is_missing_is_said_in_one_line(tmp_path):
    def line(**options):
        return error_of(lambda: bpy.ops.sparse_mocap.reconstruct(**options))

    assert "motion database" in line()
    settings().database = str(library().database)
    assert "take" in line()
    settings().take = str(tmp_path / "gone.csv")
    assert "gone.csv" in line()
    settings().take = str(library().take)
    assert "reuse" in line(reuse_armature=True).lower()
    settings().database = str(library().take)
    assert "first_walk.csv" in line()


def test_armatures_that_do_not_fit_are_refused():
    choose_files()
    armature = reconstruct()
    bpy.ops.object.mode_set(mode="EDIT")
    armature.data.edit_bones["thigh.L"].tail.z -= 0.1
    bpy.ops.object.mode_set(mode="OBJECT")
    line = error_of(lambda: bpy.ops.sparse_mocap.reconstruct(reuse_armature=True))
    assert "proportions" in line
    bpy.ops.object.mode_set(mode="EDIT")
    armature.data.edit_bones.remove(armature.data.edit_bones["thigh.L"])
    bpy.ops.object.mode_set(mode="OBJECT")
    assert "thigh.L" in error_of(lambda: bpy.ops.sparse_mocap.reconstruct(reuse_armature=True))


def test_numbers_that_are_none_leave_nothing_behind():
    performance_module = addon("scene.performance")
    choose_files()
    good = expected_performance()
    motion = type("Motion", (), {})()
    motion.skeleton, motion.frame_time_s = good.motion.skeleton, good.motion.frame_time_s
    motion.num_frames, motion.offset_tracks = good.motion.num_frames, []
    motion.root_positions = np.full((motion.num_frames, 3), np.nan)
    motion.rotations = np.asarray(good.motion.rotations)
    match = addon("session.match").Match()
    bad = addon("session.reconstruct").Performance("bad", motion, good.contacts, 1.0, match)
    bake = addon("session.bake")
    take = bake.PlacedTake(bad, bake.Placement(1.0, 24.0, False), motion, ())
    before = contents()
    steps = performance_module.perform_steps(bpy.context, take, None)
    assert "not finite numbers" in raised(ValueError, lambda: list(steps))
    assert contents() == before
