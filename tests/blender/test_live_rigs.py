# SPDX-License-Identifier: GPL-3.0-or-later
"""The live preview on animators' own characters, which are as they were afterwards."""

from __future__ import annotations

import time

import bpy
import numpy as np
import rigs
from connected import connected
from live_support import until
from support import addon, library, settings, undo


def _ticked(num_poses: int) -> list:
    """The poses that were shown, and the seconds that each took."""
    scene, shown = addon("scene.live"), []

    def has_enough() -> bool:
        begin = time.perf_counter()
        pose = scene.tick()
        if pose is not None:
            shown.append((pose, time.perf_counter() - begin))
        return len(shown) >= num_poses

    until(has_enough)
    return shown


def _state(armature) -> dict:
    found = {}
    for bone in armature.pose.bones:
        values = (*bone.location, *bone.rotation_quaternion, *bone.rotation_euler, *bone.scale)
        kept = {k: v for k, v in bone.items() if isinstance(v, int | float)}
        found[bone.name] = (bone.rotation_mode, np.round(values, 6).tolist(), kept)
    data = armature.animation_data
    found[""] = (data.action.name, data.use_nla) if data and data.action else None
    return found


def _go_live(armature):
    settings().target = armature
    assert bpy.ops.sparse_mocap.go_live() == {"FINISHED"}
    assert addon("scene.live").followed() == armature


def _with_action(armature, bone: str) -> None:
    armature.pose.bones[bone].location.x = 0.3
    armature.pose.bones[bone].keyframe_insert("location", frame=1)


def test_a_rigify_character_follows_and_is_as_before_afterwards(tmp_path):
    import sparse_mocap

    armature = rigs.rigify_rig()
    settings().foot_lock = 0.0  # limbs are compared with the solver's
    with connected(tmp_path) as session:
        _with_action(armature, "torso")
        before = _state(armature)
        _go_live(armature)
        assert armature.animation_data.action is None
        shown = _ticked(40)
        print(f"tick: median {1e3 * np.median([s for _, s in shown]):.2f} ms")
        pose = shown[-1][0]
        skeleton = sparse_mocap.with_extremities(rigs.standard_skeleton())
        motion = sparse_mocap.Motion(skeleton, 0.04, pose.root_position[None], pose.rotations[None])
        limbs = {
            "lfemur": ("DEF-thigh.L", "DEF-shin.L"),
            "rradius": ("DEF-forearm.R", "DEF-hand.R"),
        }
        bpy.context.view_layer.update()
        evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        for joint, (begin, end) in limbs.items():
            heads = [np.array(evaluated.pose.bones[name].head) for name in (begin, end)]
            wanted = rigs.wanted_directions(motion)[joint]
            assert rigs.degrees(wanted, (heads[1] - heads[0])[None])[0] < 1.0
        assert bpy.ops.sparse_mocap.leave_live() == {"FINISHED"}
        assert _state(armature) == before
        assert session.is_running


def test_the_feet_stand_on_the_floor(tmp_path):
    with connected(tmp_path):
        armature = rigs.named_rig("unreal", size=0.8)
        named = rigs.STYLES["unreal"]
        feet = [named.name("foot", side) for side in "LR"]
        standing = armature.data.bones[feet[0]].head_local.z
        sole = armature.data.bones[named.name("toe", "L")].tail_local.z
        _go_live(armature)
        lows = []
        for _ in range(30):
            _ticked(1)
            bpy.context.view_layer.update()
            lows.append(min(armature.pose.bones[name].head.z for name in feet))
        assert abs(min(lows) - (standing - sole)) < 1e-3


def test_standing_feet_stay_where_they_are(tmp_path):
    """In the same live preview of a walk, with and without foot lock."""
    speeds = {}
    with connected(tmp_path):
        armature = rigs.named_rig("mixamo")
        feet = ("mixamorig:LeftFoot", "mixamorig:RightFoot")
        for lock in (0.0, 1.0):
            settings().foot_lock = lock
            _go_live(armature)
            times, places, stands = [], [], []
            for _ in range(60):
                pose = _ticked(1)[0][0]
                bpy.context.view_layer.update()
                times.append(pose.time_s)
                places.append([np.array(armature.pose.bones[name].head) for name in feet])
                stands.append([contact > 0.6 for contact in pose.contacts])
            steps = np.linalg.norm(np.diff(places, axis=0), axis=-1)
            fast = steps / np.diff(times)[:, None]
            both = np.array(stands)[1:] & np.array(stands)[:-1] & (fast < 0.5)
            speeds[lock] = fast[both]
            assert bpy.ops.sparse_mocap.leave_live() == {"FINISHED"}
    medians = {lock: 100 * np.median(found) for lock, found in speeds.items()}
    print(f"standing feet live: {medians[0.0]:.1f} cm/s, locked {medians[1.0]:.1f} cm/s")
    assert len(speeds[1.0]) > 20
    assert medians[1.0] < 1.0
    assert medians[1.0] < medians[0.0]


def test_playing_the_timeline_leaves_the_live_pose(tmp_path):
    with connected(tmp_path):
        armature = rigs.named_rig("mixamo")
        _go_live(armature)
        _ticked(5)
        bpy.context.view_layer.update()
        before = np.array(armature.pose.bones["mixamorig:LeftFoot"].matrix)
        for frame in range(1, 6):
            bpy.context.scene.frame_set(frame)
        assert (
            np.abs(np.array(armature.pose.bones["mixamorig:LeftFoot"].matrix) - before).max() < 1e-6
        )
        _ticked(2)


def test_a_renamed_or_deleted_bone_ends_it_with_a_word(tmp_path):
    with connected(tmp_path) as session:
        armature = rigs.named_rig("mixamo")
        _go_live(armature)
        _ticked(2)
        armature.data.bones["mixamorig:LeftLeg"].name = "knee"
        assert addon("scene.live").tick() is None
        assert not session.is_live_wanted
        assert "mixamorig:LeftLeg" in addon("scene.live").ended_because()
        assert session.is_running


def test_an_action_given_meanwhile_ends_it(tmp_path):
    with connected(tmp_path) as session:
        armature = rigs.named_rig("mixamo")
        _go_live(armature)
        _ticked(2)
        addon("scene.compat").assign_action(armature, bpy.data.actions.new("mine"))
        assert addon("scene.live").tick() is None
        assert not session.is_live_wanted
        assert armature.animation_data.action.name == "mine"
        assert "action" in addon("scene.live").ended_because()


def test_undo_and_redo_meanwhile_do_no_harm(tmp_path):
    with connected(tmp_path) as session:
        _go_live(rigs.named_rig("mixamo"))
        _ticked(2)
        window = bpy.context.window_manager.windows[0]
        with bpy.context.temp_override(window=window):
            bpy.ops.ed.undo_push(message="one")
            bpy.ops.ed.undo_push(message="two")
        undo()
        _ticked(2)
        with bpy.context.temp_override(window=window):
            bpy.ops.ed.redo()
        _ticked(2)
        assert session.is_live_wanted


def test_a_file_saved_meanwhile_has_the_characters_own_pose_and_action(tmp_path):
    with connected(tmp_path):
        armature = rigs.named_rig("mixamo", rotation_mode="XYZ")
        _with_action(armature, "mixamorig:Hips")
        before = _state(armature)
        _go_live(armature)
        _ticked(5)
        bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "saved.blend"), copy=True)
        assert armature.animation_data.action is None
        _ticked(2)
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "saved.blend"))
        assert _state(bpy.data.objects[armature_name()]) == before
        assert addon("session.live").current() is None


def armature_name() -> str:
    return next(obj.name for obj in bpy.data.objects if obj.type == "ARMATURE")


def test_recentred_turned_to_the_front_and_kept_in_place(tmp_path):
    with connected(tmp_path):
        armature = rigs.named_rig("mixamo")
        _go_live(armature)
        _ticked(25)
        assert bpy.ops.sparse_mocap.recentre() == {"FINISHED"}
        _ticked(1)
        hips = armature.pose.bones["mixamorig:Hips"]
        bpy.context.view_layer.update()
        assert np.hypot(hips.head.x, hips.head.y) < 0.15
        settings().in_place = True
        places = []
        for _ in range(20):
            _ticked(1)
            bpy.context.view_layer.update()
            places.append(np.array(hips.head)[:2])
        assert np.abs(np.array(places) - places[0]).max() < 0.08
        assert bpy.ops.sparse_mocap.face_front() == {"FINISHED"}
        _ticked(1)
        bpy.context.view_layer.update()
        thighs = [
            np.array(armature.pose.bones[f"mixamorig:{s}UpLeg"].head) for s in ("Left", "Right")
        ]
        left = thighs[0] - thighs[1]
        assert np.degrees(np.arctan2(abs(left[1]), left[0])) < 10.0


def test_a_recording_becomes_an_action_on_the_live_character(tmp_path):
    with connected(tmp_path) as session:
        armature = rigs.named_rig("vrm")
        _go_live(armature)
        assert bpy.ops.sparse_mocap.record_take() == {"FINISHED"}
        until(lambda: session.state.recording and session.state.recording["samples"] > 800)
        assert bpy.ops.sparse_mocap.stop_take() == {"FINISHED"}
        action = armature.animation_data.action
        assert action is not None
        assert not session.is_live_wanted
        paths = {curve.data_path for curve in addon("scene.compat").curves_of(action)}
        assert any("J_Bip_L_UpperLeg" in path for path in paths)
        assert str(library().database) == settings().database


def test_a_recording_starts_on_the_frame_where_it_began(tmp_path):
    with connected(tmp_path) as session:
        armature = rigs.named_rig("vrm")
        settings().target, settings().record_plays = armature, True
        bpy.context.scene.frame_set(42)
        assert bpy.ops.sparse_mocap.record_or_stop() == {"FINISHED"}
        until(lambda: session.state.recording and session.state.recording["samples"] > 800)
        assert bpy.ops.sparse_mocap.stop_take() == {"FINISHED"}
        assert armature.animation_data.action.frame_range[0] == 42.0
