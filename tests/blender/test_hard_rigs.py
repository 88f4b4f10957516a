# SPDX-License-Identifier: GPL-3.0-or-later
"""Characters that are linked, overridden, shared, held or oddly built; scenes with odd rates."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import rigs
from rig_baking import bake, limbs_of, points_of, solved, worst_mean_degrees
from support import addon, choose_files, contents, error_of, settings


def _library_file(folder: Path) -> Path:
    armature = rigs.named_rig("mixamo")
    path = folder / "characters.blend"
    bpy.data.libraries.write(str(path), {armature})
    data = armature.data
    bpy.data.objects.remove(armature)
    bpy.data.armatures.remove(data)
    return path


def _linked(folder: Path):
    with bpy.data.libraries.load(str(_library_file(folder)), link=True) as (_, here):
        here.objects = ["mixamo"]
    [armature] = here.objects
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.update()
    return armature


def test_a_linked_character_is_refused_with_what_to_do(tmp_path):
    armature = _linked(tmp_path)
    choose_files()
    settings().target = armature
    line = error_of(bpy.ops.sparse_mocap.reconstruct)
    assert "linked" in line
    assert "local" in line


def test_a_library_override_gets_the_take_and_keeps_its_structure(tmp_path):
    linked = _linked(tmp_path)
    override = linked.override_create(remap_local_usages=True)
    if override.name not in bpy.context.scene.collection.objects:
        bpy.context.scene.collection.objects.link(override)
    if hasattr(override.override_library, "is_system_override"):
        override.override_library.is_system_override = False
    bpy.context.view_layer.update()
    bones = [(bone.name, bone.parent and bone.parent.name) for bone in override.data.bones]
    action = bake(override, foot_lock=1.0)
    assert override.animation_data.action == action
    assert override.data.library is not None  # still the linked bones
    assert bones == [(bone.name, bone.parent and bone.parent.name) for bone in override.data.bones]
    bake(override)
    assert worst_mean_degrees(override, limbs_of("mixamo")) < 1.0


def test_an_action_that_two_characters_share_stays_the_others():
    first, second = rigs.named_rig("mixamo"), rigs.named_rig("mixamo")
    shared = bake(first)
    addon("scene.compat").assign_action(second, shared)
    before = sum(len(c.keyframe_points) for c in addon("scene.compat").curves_of(shared))
    assert bake(first) != shared
    assert second.animation_data.action == shared
    after = sum(len(c.keyframe_points) for c in addon("scene.compat").curves_of(shared))
    assert before == after


def test_bones_that_are_held_are_named_in_a_warning():
    armature = rigs.named_rig("mixamo")
    hold = armature.pose.bones["mixamorig:LeftArm"].constraints.new("COPY_ROTATION")
    hold.target, hold.subtarget = armature, "mixamorig:Head"
    target = addon("scene.binding").bind(bpy.context, armature)
    line = addon("scene.targets").held_warning(target)
    assert "mixamorig:LeftArm" in line
    bake(armature)


def test_bones_that_do_not_inherit_rotation_and_locked_ones():
    armature = rigs.named_rig("mixamo", rolls=True)
    armature.data.bones["mixamorig:LeftForeArm"].use_inherit_rotation = False
    armature.data.bones["mixamorig:Hips"].use_local_location = False
    armature.pose.bones["mixamorig:RightLeg"].lock_rotation = (True, True, True)
    bake(armature)
    assert worst_mean_degrees(armature, limbs_of("mixamo")) < 1.0


def test_odd_frame_rates_and_ranges():
    armature = rigs.named_rig("mixamo")
    scene = bpy.context.scene
    thighs = ["mixamorig:LeftUpLeg", "mixamorig:RightUpLeg"]
    for fps, base, start in ((24, 1.001, -50.0), (1, 1.0, 1.0), (240, 1.0, 7.0)):
        scene.render.fps, scene.render.fps_base = fps, base
        scene.frame_start = -100
        action = bake(armature, start_frame=start)
        motion = solved()
        first, last = action.frame_range
        assert (first, last) == (start, start + motion.num_frames - 1)
        joints = list(motion.skeleton.names)
        both = [joints.index("lfemur"), joints.index("rfemur")]
        wanted = rigs.in_blenders_axes(motion.pivot_positions())[:, both].mean(axis=1)
        found = points_of(armature, [int(first), int(last)], thighs).mean(axis=1)
        way = (found[1] - found[0]) - (wanted[-1] - wanted[0])
        assert np.abs(way).max() < 2e-3


def test_a_scene_of_inches_and_of_centimetres():
    scene = bpy.context.scene
    for system, scale in (("METRIC", 0.01), ("IMPERIAL", 1.0)):
        units = scene.unit_settings
        units.system, units.scale_length = system, scale
        per_metre = 1.0 / scale
        armature = rigs.named_rig("mixamo", size=per_metre)
        bake(armature)
        motion = solved()
        thighs = ["mixamorig:LeftUpLeg", "mixamorig:RightUpLeg"]
        found = points_of(armature, [1, motion.num_frames], thighs).mean(axis=1)
        joints = list(motion.skeleton.names)
        both = [joints.index("lfemur"), joints.index("rfemur")]
        wanted = rigs.in_blenders_axes(motion.pivot_positions())[:, both].mean(axis=1)
        way = np.linalg.norm(found[1] - found[0]) / per_metre
        assert abs(way - np.linalg.norm(wanted[-1] - wanted[0])) < 2e-3


def test_a_character_in_edit_mode_or_without_an_active_object_changes_nothing():
    armature = rigs.named_rig("mixamo")
    choose_files()
    settings().target = armature
    bpy.ops.object.mode_set(mode="EDIT")
    before = contents()
    line = error_of(bpy.ops.sparse_mocap.reconstruct)
    assert "Edit Mode" in line
    assert contents() == before
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = None
    assert bpy.ops.sparse_mocap.reconstruct() == {"FINISHED"}


def test_a_file_of_another_version_has_the_defaults(tmp_path):
    armature = rigs.named_rig("mixamo")
    action = bake(armature)
    action["sparse_mocap"] = {"duration_s": 1.0, "something_new": 2}
    path = tmp_path / "newer.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    [action] = bpy.data.actions
    assert addon("scene.performance").facts_of(action) is None
    assert settings().foot_lock == 0.0
    assert settings().target.name == "mixamo"
    assert bpy.ops.sparse_mocap.reconstruct() == {"FINISHED"}
