# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion databases from the armatures of the open file, also those that came by FBX."""

import bpy
import numpy as np
import rigs
from rig_baking import bake
from support import Skipped, addon, error_of, settings


def _built(path):
    assert bpy.ops.sparse_mocap.build_from_file(filepath=str(path)) == {"FINISHED"}
    assert settings().database == str(path)
    return addon("session.database").databases.get(str(path)).motions


def _originals(database) -> list:
    """The clips that are no copies."""
    return [
        clip for clip in database.clips
        if not clip.is_mirrored and not clip.is_reversed and clip.tempo == 1.0
    ]  # fmt: skip


def _limbs(database) -> tuple[np.ndarray, np.ndarray]:
    """(T, L, 3) directions of forearms and shanks in the database's only clip that is no copy.

    And by how many degrees elbows and knees bend, (T, L).
    """
    import sparse_mocap

    (clip,) = _originals(database)
    names = sparse_mocap.standard_joint_names()
    points = database.array("positions")[clip.begin : clip.end].reshape(-1, len(names), 3)
    chains = [
        ("lhipjoint", "lfemur", "ltibia"),
        ("rhipjoint", "rfemur", "rtibia"),
        ("lclavicle", "lhumerus", "lradius"),
        ("rclavicle", "rhumerus", "rradius"),
    ]
    above, joint, end = (
        np.stack([points[:, names.index(chain[k])] for chain in chains], 1) for k in range(3)
    )
    bends = rigs.degrees((end - joint).reshape(-1, 3), (joint - above).reshape(-1, 3))
    return end - joint, bends.reshape(-1, len(chains))


def _blenders_bvh(armature, path) -> None:
    """The action as Blender's own exporter writes it."""
    first, last = bpy.context.scene.frame_start, bpy.context.scene.frame_end
    bpy.context.view_layer.objects.active = armature
    bpy.ops.export_anim.bvh(
        filepath=str(path), frame_start=first, frame_end=last, global_scale=100.0,
        root_transform_only=True, rotate_mode="NATIVE",
    )  # fmt: skip


def test_fbx_of_a_character_is_the_clip_that_its_bvh_is(tmp_path):
    import sparse_mocap

    if not hasattr(bpy.ops.export_scene, "fbx") or "fbx" not in dir(bpy.ops.export_scene):
        raise Skipped("this Blender has no FBX")
    armature = rigs.named_rig("mixamo")
    action = bake(armature)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = (int(frame) for frame in action.frame_range)
    folder = tmp_path / "bvh"
    folder.mkdir()
    _blenders_bvh(armature, folder / "walk.bvh")
    bpy.ops.object.select_all(action="DESELECT")
    armature.select_set(True)
    bpy.ops.export_scene.fbx(
        filepath=str(tmp_path / "walk.fbx"), use_selection=True, add_leaf_bones=False,
        bake_anim_use_all_actions=False, bake_anim_use_nla_strips=False,
        bake_anim_simplify_factor=0,
    )  # fmt: skip
    fps = bpy.context.scene.render.fps
    bpy.ops.wm.read_homefile(use_empty=True)
    bpy.context.scene.render.fps = fps
    bpy.ops.import_scene.fbx(filepath=str(tmp_path / "walk.fbx"))
    (imported,) = [obj for obj in bpy.context.scene.objects if obj.type == "ARMATURE"]
    before = imported.animation_data.action.name, bpy.context.scene.frame_current
    from_fbx = _built(tmp_path / "fbx.smdb")
    assert (imported.animation_data.action.name, bpy.context.scene.frame_current) == before
    sparse_mocap.build_database([folder], tmp_path / "bvh.smdb")
    expected, bends = _limbs(sparse_mocap.MotionDatabase(tmp_path / "bvh.smdb"))
    found, _ = _limbs(from_fbx)
    assert abs(len(found) - len(expected)) <= 1
    frames = min(len(found), len(expected))
    assert frames > 50
    off = rigs.degrees(found[:frames].reshape(-1, 3), expected[:frames].reshape(-1, 3))
    print(f"limbs differ by {off.mean():.3f} degrees, at most {off.max():.3f}")
    assert off.mean() < 0.2
    # How an upper arm is twisted is a guess while the elbow is nearly straight.
    is_bent = bends[:frames].ravel() > 12.0
    assert is_bent.mean() > 0.5
    assert off[is_bent].max() < 0.5
    assert off.max() < 2.0


def test_every_action_of_every_armature_becomes_a_clip(tmp_path):
    first = rigs.named_rig("mixamo")
    bake(first)
    again = first.animation_data.action.copy()
    again.name = "Another/one"
    for curve in addon("scene.compat").curves_of(again):
        if "rotation" in curve.data_path:
            for key in curve.keyframe_points:
                key.co.y *= 0.9 if curve.array_index else 1.0
    second = rigs.named_rig("vrm", scale=0.01, pose="a")
    bake(second)
    bpy.context.scene.frame_set(7)
    played = second.animation_data.action
    database = _built(tmp_path / "all.smdb")
    sources = {clip.source for clip in database.clips}
    assert any(source.startswith(f"{first.name}/") for source in sources)
    assert any("Another" in source for source in sources)
    assert len(_originals(database)) == 2  # the second character's motion is there already
    assert second.animation_data.action == played
    assert bpy.context.scene.frame_current == 7
    assert [path.name for path in tmp_path.iterdir()] == ["all.smdb"]


def test_without_motion_there_is_one_line(tmp_path):
    rigs.named_rig("mixamo")
    line = error_of(lambda: bpy.ops.sparse_mocap.build_from_file(filepath=str(tmp_path / "x.smdb")))
    assert "No armature in this scene has an action" in line
    assert list(tmp_path.iterdir()) == []
