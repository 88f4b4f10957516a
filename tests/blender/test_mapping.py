# SPDX-License-Identifier: GPL-3.0-or-later
import json
import os

import bpy
import rigs
from support import addon, error_of, library, settings


def _import(tmp_path, **options):
    os.environ["SPARSE_MOCAP_MAPPINGS"] = str(tmp_path / "mappings")
    path = next(library().motions.iterdir())
    assert bpy.ops.sparse_mocap.import_bvh(filepath=str(path), **options) == {"FINISHED"}
    return bpy.context.window_manager.sparse_mocap_mapping


def test_an_import_shows_the_mapping_of_its_skeleton(tmp_path):
    rows = _import(tmp_path)
    assert len(rows.joints) == 21
    names = set(rows.sources.keys())
    assert {bone.name for bone in bpy.context.object.data.bones} == names
    found = {row.name: row.source for row in rows.joints}
    assert found["lfemur"]
    assert set(found.values()) - {""} <= names


def test_remembered_for_the_skeleton_until_forgotten(tmp_path):
    rows = _import(tmp_path)
    found = {row.name: row.source for row in rows.joints}
    left, right = rows.joints["lfemur"], rows.joints["rfemur"]
    left.source, right.source = right.source, left.source
    for side in ("tibia",):
        left, right = rows.joints[f"l{side}"], rows.joints[f"r{side}"]
        left.source, right.source = right.source, left.source
    assert bpy.ops.sparse_mocap.remember_mapping() == {"FINISHED"}
    rows = _import(tmp_path, standard_skeleton=True)
    assert rows.joints["lfemur"].source == found["rfemur"]
    assert bpy.ops.sparse_mocap.forget_mapping() == {"FINISHED"}
    assert {row.name: row.source for row in _import(tmp_path).joints} == found


def test_saved_and_loaded(tmp_path):
    rows = _import(tmp_path)
    before = {row.name: row.source for row in rows.joints}
    file = tmp_path / "rig.json"
    assert bpy.ops.sparse_mocap.save_mapping(filepath=str(tmp_path / "rig")) == {"FINISHED"}
    assert json.loads(file.read_text())["joints"]["lfemur"] == before["lfemur"]
    rows.joints["lfemur"].source = ""
    assert bpy.ops.sparse_mocap.load_mapping(filepath=str(file)) == {"FINISHED"}
    assert {row.name: row.source for row in rows.joints} == before


def test_what_is_wrong_is_said_in_one_line(tmp_path):
    addon("session.mapping").last_mapped.clear()
    assert "import" in error_of(bpy.ops.sparse_mocap.remember_mapping)
    rows = _import(tmp_path)
    rows.joints["lfemur"].source = "tentacle"
    assert "tentacle" in error_of(bpy.ops.sparse_mocap.remember_mapping)
    bad = tmp_path / "bad.json"
    bad.write_text("{")
    assert "bad.json" in error_of(lambda: bpy.ops.sparse_mocap.load_mapping(filepath=str(bad)))


def test_a_skeleton_that_is_no_person_is_shown_to_be_mended(tmp_path):
    os.environ["SPARSE_MOCAP_MAPPINGS"] = str(tmp_path / "mappings")
    path = tmp_path / "snake.bvh"
    channels = "CHANNELS 3 Zrotation Xrotation Yrotation"
    body = f"JOINT b\n{{\nOFFSET 0 9 0\n{channels}\n}}"
    path.write_text(
        f"HIERARCHY\nROOT a\n{{\nOFFSET 0 0 0\n{channels}\n{body}\n}}\n"
        "MOTION\nFrames: 1\nFrame Time: 0.1\n0 0 0 0 0 0\n"
    )
    line = error_of(
        lambda: bpy.ops.sparse_mocap.import_bvh(filepath=str(path), standard_skeleton=True)
    )
    assert "human" in line
    rows = bpy.context.window_manager.sparse_mocap_mapping
    assert rows.sources.keys() == ["a", "b"]
    assert addon("session.mapping").last_mapped[0].name == "snake"
    assert bpy.ops.sparse_mocap.import_bvh(filepath=str(path)) == {"FINISHED"}


def _character(tmp_path, style="mixamo"):
    os.environ["SPARSE_MOCAP_MAPPINGS"] = str(tmp_path / "mappings")
    armature = rigs.named_rig(style)
    settings().target = armature
    return armature, bpy.context.window_manager.sparse_mocap_mapping


def test_a_characters_mapping_is_shown_and_corrected_by_picking_bones(tmp_path):
    armature, rows = _character(tmp_path)
    assert bpy.ops.sparse_mocap.show_mapping() == {"FINISHED"}
    assert rows.joints["lfemur"].source == "mixamorig:LeftUpLeg"
    assert set(rows.sources.keys()) == {bone.name for bone in armature.data.bones}
    assert "Pose Mode" in error_of(lambda: bpy.ops.sparse_mocap.pick_bone(joint="lowerback"))
    armature.data.bones.active = armature.data.bones["mixamorig:Spine1"]
    bpy.ops.object.mode_set(mode="POSE")
    assert bpy.ops.sparse_mocap.pick_bone(joint="lowerback") == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    rows.joints["upperback"].source = ""
    assert bpy.ops.sparse_mocap.remember_mapping() == {"FINISHED"}
    target = addon("scene.binding").bind(bpy.context, armature)
    assert target.character.joints["lowerback"] == "mixamorig:Spine1"
    assert bpy.ops.sparse_mocap.forget_mapping() == {"FINISHED"}
    target = addon("scene.binding").bind(bpy.context, armature)
    assert target.character.joints["lowerback"] == "mixamorig:Spine"


def test_a_rig_that_is_not_recognised_is_mapped_by_hand(tmp_path):
    armature, rows = _character(tmp_path, "unknown")
    extra = rigs.STYLES["unknown"].name("shank", "L")
    bpy.ops.object.mode_set(mode="EDIT")
    for number in range(3):  # no shape of a body any more
        bone = armature.data.edit_bones.new(f"tail{number}")
        bone.head, bone.tail = (0, 0, number), (0, 0.9, number + 0.5)
        bone.parent = armature.data.edit_bones[extra]
    bpy.ops.object.mode_set(mode="OBJECT")
    named = rigs.STYLES["unknown"]
    error_of(bpy.ops.sparse_mocap.show_mapping)
    for joint, (part, side) in rigs.LIMBS.items():
        rows.joints[joint].source = named.name(part, side)
    rows.joints["head"].source = named.name("head")
    assert bpy.ops.sparse_mocap.remember_mapping() == {"FINISHED"}
    target = addon("scene.binding").bind(bpy.context, armature)
    assert target.character.joints["ltibia"] == extra
