# SPDX-License-Identifier: GPL-3.0-or-later
import json
import os

import bpy
from support import addon, error_of, library


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
