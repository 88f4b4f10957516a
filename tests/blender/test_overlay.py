# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn on the character: where it is, in the world."""

from __future__ import annotations

import bpy
import numpy as np
import rigs
from rig_baking import bake, points_of
from support import addon, choose_files, error_of, reconstruct, settings


def _places() -> dict[str, np.ndarray]:
    bpy.context.view_layer.update()
    marks = addon("scene.overlay").sensor_marks(bpy.context)
    assert not any(mark.is_silent for mark in marks)
    return {mark.site: np.array(mark.place) for mark in marks}


def test_sensors_are_where_they_are_worn():
    armature = rigs.named_rig("mixamo", rolls=True)
    armature.location = (1.0, 2.0, 0.0)
    bake(armature)
    assert bpy.ops.sparse_mocap.toggle_overlay() == {"FINISHED"}
    for frame in (1, 30):
        bones = ("LeftHand", "RightHand", "LeftFoot", "RightFoot")
        wanted = points_of(armature, [frame], [f"mixamorig:{name}" for name in bones])[0]
        places = _places()
        sites = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
        assert set(places) == set(sites)
        assert np.abs(np.array([places[site] for site in sites]) - wanted).max() < 1e-4
    assert bpy.ops.sparse_mocap.toggle_overlay() == {"FINISHED"}
    assert addon("scene.overlay").sensor_marks(bpy.context) == []


def test_sensors_on_the_add_ons_own_figure():
    choose_files()
    armature = reconstruct()
    bpy.ops.sparse_mocap.toggle_overlay()
    assert set(_places()) == {"left_wrist", "right_wrist", "left_ankle", "right_ankle"}
    bpy.data.objects.remove(armature)
    assert addon("scene.overlay").sensor_marks(bpy.context) == []


def test_feet_that_stand_are_marked_on_the_floor():
    armature = rigs.named_rig("mixamo")
    bake(armature, foot_lock=1.0)
    bpy.ops.sparse_mocap.toggle_overlay()
    counts = []
    for frame in range(1, 60):
        bpy.context.scene.frame_set(frame)
        feet = addon("scene.overlay").standing_feet(bpy.context)
        assert all(abs(place.z) < 1e-6 for place in feet)
        counts.append(len(feet))
    assert {0, 1, 2} >= set(counts)
    assert len(set(counts)) > 1


def test_without_a_character_it_says_what_to_do():
    settings().target = None
    bpy.context.view_layer.objects.active = None
    assert "Select a character" in error_of(bpy.ops.sparse_mocap.toggle_overlay)


def test_advice_follows_the_match():
    advice = addon("session.reconstruct").advice_for
    assert advice("good", is_guess=False) == ""
    assert "calibrat" in advice("fair", is_guess=False)
    assert "calibrate" in advice("poor", is_guess=False)
    assert "add clips" in advice("good", is_guess=True)
