# SPDX-License-Identifier: GPL-3.0-or-later
"""Very long takes, places that cannot be written, several scenes, and renders that are running."""

from __future__ import annotations

import bpy
import numpy as np
import rigs
from connected import connected
from rig_baking import bake
from support import addon, choose_files, error_of, library, settings

_NUM_FRAMES = 100_000


def _long_take(armature):
    """A take of more than an hour of which two bones get keys."""
    target = addon("scene.binding").bind(bpy.context, armature)
    retarget = addon("session.retarget")
    angles = np.linspace(0.0, 300.0, _NUM_FRAMES)
    zeros = np.zeros(_NUM_FRAMES)
    turned = np.column_stack([np.cos(angles / 2), np.sin(angles / 2), zeros, zeros])
    places = np.column_stack([angles, zeros, zeros])
    tracks = (
        retarget.Track("mixamorig:Hips", None, places),
        retarget.Track("mixamorig:LeftLeg", turned, None),
    )
    stands = np.zeros((_NUM_FRAMES, 2), dtype=bool)
    times_s = np.arange(_NUM_FRAMES) / 24.0
    return retarget.RigTake(target, times_s, tracks, stands)


def test_a_hundred_thousand_frames_are_set_in_steps_and_stopped_without_a_trace():
    armature = rigs.named_rig("mixamo")
    take, frames = _long_take(armature), np.arange(1.0, _NUM_FRAMES + 1.0)
    steps_of = addon("scene.rig_action").rig_action_steps
    steps = steps_of("long", armature, take, frames)
    fractions = [next(steps) for _ in range(4)]
    assert fractions == sorted(fractions)
    assert 0.0 <= fractions[0] <= fractions[-1] < 1.0
    assert len(bpy.data.actions) == 1
    steps.close()
    assert not bpy.data.actions
    action = addon("session.steps").finished(steps_of("long", armature, take, frames))
    assert action.frame_range[1] == _NUM_FRAMES
    addon("scene.compat").assign_action(armature, action)
    curves = {
        (curve.data_path, curve.array_index): curve
        for curve in addon("scene.compat").curves_of(action)
    }
    quaternion = [
        curves['pose.bones["mixamorig:LeftLeg"].rotation_quaternion', index].evaluate(77_777.0)
        for index in range(4)
    ]
    assert np.abs(np.array(quaternion) - take.tracks[1].quaternions[77_776]).max() < 1e-5


def test_a_folder_that_cannot_be_written_is_said_in_one_line(tmp_path):
    (tmp_path / "file").write_text("")
    settings().folder = str(tmp_path / "file")
    for operator in (bpy.ops.sparse_mocap.make_starter_set, bpy.ops.sparse_mocap.try_it):
        assert str(tmp_path / "file") in error_of(operator)


def test_each_scene_has_its_takes_and_they_share_the_sensors(tmp_path):
    with connected(tmp_path) as session:
        choose_files()
        other = bpy.data.scenes.new("other")
        assert len(other.sparse_mocap.takes) == 0
        assert other.sparse_mocap.database == str(library().database)
        assert "still connected" in error_of(bpy.ops.sparse_mocap.connect_sensors)
        assert session.is_running


def test_nothing_starts_while_a_render_is_running():
    choose_files()
    compat = addon("scene.compat")
    is_rendering, compat.is_rendering = compat.is_rendering, lambda: True
    try:
        assert "render" in error_of(bpy.ops.sparse_mocap.reconstruct)
    finally:
        compat.is_rendering = is_rendering
    bake(rigs.named_rig("mixamo"))
