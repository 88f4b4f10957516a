# SPDX-License-Identifier: GPL-3.0-or-later
"""Trying the add-on without files and sensors."""

from __future__ import annotations

import atexit
import shutil
import tempfile
from functools import cache
from pathlib import Path

import addon_utils
import bpy
import numpy as np
from support import Skipped, addon, contents, raised, settings, undo

_NAME = "demo movements.smdb"
_SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")


@cache
def _starter_set() -> Path:
    folder = Path(tempfile.mkdtemp(prefix="sparse_mocap_starter_"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    addon("session.demo").make_starter_set(folder / _NAME, lambda *_: True)
    return folder / _NAME


def _choose_folder(tmp_path: Path) -> None:
    """With a starter set in it."""
    shutil.copy(_starter_set(), tmp_path)
    settings().folder = str(tmp_path)


def _try_it(tmp_path) -> None:
    _choose_folder(tmp_path)
    assert bpy.ops.sparse_mocap.try_it() == {"FINISHED"}


def _has_rigify() -> bool:
    return any(module.__name__ == "rigify" for module in addon_utils.modules())


def test_a_character_follows_a_simulated_performer(tmp_path):
    _try_it(tmp_path)
    armature = bpy.context.view_layer.objects.active
    performer = bpy.data.objects["Simulated Performer"]
    assert settings().database == str(tmp_path / _NAME)
    assert settings().target == (armature if _has_rigify() else None)
    assert [item.num_sensors for item in settings().takes] == [4]
    assert settings().takes[0].match == "good"
    assert len([obj for obj in bpy.data.objects if obj.type == "MESH" and obj.parent]) >= 1
    scene = bpy.context.scene
    last = armature.animation_data.action.frame_range[1]
    assert last > 15.0 * scene.render.fps / scene.render.fps_base
    assert scene.frame_end >= last
    marks = addon("scene.overlay").sensor_marks(bpy.context)
    assert {mark.site for mark in marks} == set(_SITES)
    ends = {"thigh": "shin", "shin": "foot", "upper_arm": "forearm", "forearm": "hand"}
    apart = []
    for frame in range(5, int(last) - 5, 7):
        scene.frame_set(frame)
        for side in "LR":
            for begin, end in ends.items():
                apart.append(_angle_deg(performer, armature, f"{begin}.{side}", f"{end}.{side}"))
    print(f"limbs are {np.mean(apart):.1f} degrees apart")
    assert np.mean(apart) < 8.0


def _angle_deg(performer, character, begin: str, end: str) -> float:
    """Between the performer's limb and the character's, each seen from its own front."""

    def direction(armature, prefix: str, turn: str) -> np.ndarray:
        bones = armature.pose.bones
        along = np.array(bones[prefix + end].head - bones[prefix + begin].head)
        thighs = [np.array(bones[f"{prefix}thigh.{side}"].head)[:2] for side in "LR"]
        left = (thighs[0] - thighs[1]) / np.linalg.norm(thighs[0] - thighs[1])
        x, y = along[:2]
        return np.array([x * left[0] + y * left[1], y * left[0] - x * left[1], along[2]])

    prefix = "DEF-" if "DEF-thigh.L" in character.pose.bones else ""
    a, b = direction(performer, "", ""), direction(character, prefix, "")
    cosine = a @ b / np.linalg.norm(a) / np.linalg.norm(b)
    return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def test_one_undo_removes_everything_but_the_files(tmp_path):
    if not bpy.app.binary_path:
        raise Skipped("as a module Blender may crash when operators call others in an override")
    _choose_folder(tmp_path)
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.ed.undo_push(message="before")
        before = contents()
        assert bpy.ops.sparse_mocap.try_it("EXEC_DEFAULT", True) == {"FINISHED"}
    undo()
    after = contents()
    for kind in ("objects", "armatures", "actions", "meshes", "collections"):
        assert after[kind] == before[kind], kind
    assert (tmp_path / _NAME).exists()


def test_nothing_is_left_when_it_is_stopped_or_fails(tmp_path):
    _choose_folder(tmp_path)
    before = contents()
    demo = addon("ops.try_it")
    perform_steps = demo.perform_steps

    def failing(*_):
        yield 0.5
        raise ValueError("stopped here")

    demo.perform_steps = failing
    try:
        said = raised(RuntimeError, bpy.ops.sparse_mocap.try_it)
    finally:
        demo.perform_steps = perform_steps
    assert "stopped here" in said
    assert contents() == before
    assert not [text for text in bpy.data.texts if text.name.startswith("rig")]


def test_a_starter_set_is_made_and_used(tmp_path):
    import sparse_mocap

    settings().folder = str(tmp_path)
    assert bpy.ops.sparse_mocap.make_starter_set() == {"FINISHED"}
    assert settings().database == str(tmp_path / _NAME)
    database = sparse_mocap.MotionDatabase(settings().database)
    kinds = {clip.name.split("_")[1] for clip in database.clips}
    assert {"walk", "squat", "jogleft", "kickright"} <= kinds
    assert any(clip.is_mirrored for clip in database.clips)


def test_ones_own_database_is_kept_and_a_broken_starter_set_made_anew(tmp_path):
    settings().folder, settings().database = str(tmp_path), str(tmp_path / "mine.smdb")
    (tmp_path / _NAME).write_bytes(b"not a database")
    assert bpy.ops.sparse_mocap.try_it() == {"FINISHED"}
    assert settings().takes[0].match == "good"
    assert settings().database == str(tmp_path / "mine.smdb")
