# SPDX-License-Identifier: GPL-3.0-or-later
import bpy
import numpy as np
from support import (
    addon,
    contents,
    error_of,
    evaluated_points,
    in_blenders_axes,
    library,
    reconstruct,
    settings,
    undo,
)


def _database():
    settings().database = str(library().database)
    return addon("session.database").databases.get(settings().database)


def _preview(**options):
    assert bpy.ops.sparse_mocap.preview_clip(**options) == {"FINISHED"}
    return addon("scene.preview").preview_armature(bpy.context.scene)


def test_preview_shows_the_clip():
    database = _database()
    scene = bpy.context.scene
    scene.frame_start = 5
    before = (scene.frame_start, scene.frame_end, scene.render.fps, scene.use_preview_range)
    for index in (0, 2):
        armature = _preview(index=index)
        motion = database.motions.clip_motion(index, extremities=True)
        assert {"foot.L", "toe.R", "hand.L"} <= set(armature.data.bones.keys())
        wanted = in_blenders_axes(motion.joint_positions("world"))
        for frame in (0, motion.num_frames - 1):
            at = 5 + frame * motion.frame_time_s * 24
            found = evaluated_points(armature, at, motion.skeleton.names)
            assert np.abs(found - wanted[frame]).max() < 1e-3
    after = (scene.frame_start, scene.frame_end, scene.render.fps, scene.use_preview_range)
    assert after == before
    assert bpy.context.window_manager.sparse_mocap_clips.index == 2


def test_one_armature_and_one_action_serve_all_previews():
    _database()
    first = _preview(index=0).name
    assert _preview(index=1).name == _preview(index=3).name == first == "Clip Preview"
    assert len(bpy.data.armatures) == len(bpy.data.actions) == 1
    assert not bpy.data.actions[0].use_fake_user


def test_the_marked_clip_is_previewed():
    database = _database()
    addon("scene.clips").fill(bpy.context)
    shown = bpy.context.window_manager.sparse_mocap_clips
    assert len(shown.items) == database.num_clips
    shown.index = 3
    _preview()
    name = addon("scene.preview").clip_in_preview(bpy.context.scene)
    assert name == database.clips.rows[3].label


def test_kept_previews_are_let_go_of():
    database = _database()
    _preview(index=1)
    assert bpy.ops.sparse_mocap.keep_preview() == {"FINISHED"}
    name = database.clips.rows[1].label[:60]
    kept = bpy.context.view_layer.objects.active
    assert kept.name.startswith(name)
    action = kept.animation_data.action
    assert action.name.startswith(name)
    assert action.use_fake_user
    assert _preview(index=1) != kept
    assert bpy.ops.sparse_mocap.keep_preview() == {"FINISHED"}
    assert len(bpy.data.armatures) == len(bpy.data.actions) == 2
    assert kept.animation_data.action == action
    assert "preview" in error_of(bpy.ops.sparse_mocap.keep_preview)


def test_the_animators_own_armatures_stay_as_they_are():
    _database()
    bpy.ops.sparse_mocap.load_take(filepath=str(library().take))
    mine = reconstruct()
    action = mine.animation_data.action
    own = _preview(index=0)
    assert own != mine
    assert mine.animation_data.action == action
    assert reconstruct(reuse_armature=True) == mine  # never the preview
    own.animation_data.action = action  # the animator's doing
    _preview(index=1)
    assert action.name in bpy.data.actions


def test_loop_sets_the_preview_range_alone():
    _database()
    assert "preview" in error_of(bpy.ops.sparse_mocap.fit_preview_range)
    armature = _preview(index=0)
    scene = bpy.context.scene
    before = (scene.frame_start, scene.frame_end)
    bpy.ops.sparse_mocap.fit_preview_range()
    first, last = armature.animation_data.action.frame_range
    assert scene.use_preview_range
    assert scene.frame_preview_start == int(first)
    assert 0 <= scene.frame_preview_end - last < 1
    assert (scene.frame_start, scene.frame_end) == before


def test_one_undo_removes_the_preview():
    _database()
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window):
        bpy.ops.ed.undo_push(message="before")
    before = contents()
    with bpy.context.temp_override(window=window):
        bpy.ops.sparse_mocap.preview_clip("EXEC_DEFAULT", True, index=0)
    undo()
    assert contents() == before


def test_clips_that_are_not_there_are_said_in_one_line():
    assert "database" in error_of(bpy.ops.sparse_mocap.preview_clip)
    _database()
    assert "99999" in error_of(lambda: bpy.ops.sparse_mocap.preview_clip(index=99999))
