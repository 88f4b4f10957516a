# SPDX-License-Identifier: GPL-3.0-or-later
"""What is drawn on the character: where it is, in the world."""

from __future__ import annotations

import bpy
import numpy as np
import rigs
from mathutils import Vector
from rig_baking import bake, points_of
from support import addon, choose_files, error_of, library, reconstruct, settings


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


def test_uncertain_limbs_are_those_whose_retrieved_poses_deviate():
    armature = rigs.named_rig("mixamo")
    action = bake(armature)
    bpy.ops.sparse_mocap.toggle_overlay()
    facts = addon("scene.performance").facts_of(action)
    performance = addon("session.reconstruct").kept(facts.take)
    joints = list(performance.motion.skeleton.names)
    performance.spread_m[:] = 0.0
    performance.spread_m[10:, joints.index("lradius")] = 0.1
    performance.spread_m[10:, joints.index("rtibia")] = 0.2
    uncertain = addon("scene.overlay").uncertain_limbs
    rate = bpy.context.scene.render.fps / bpy.context.scene.render.fps_base
    at_frame_10 = round(1 + 10 * performance.motion.frame_time_s * rate)
    bpy.context.scene.frame_set(at_frame_10 - 2)
    assert uncertain(bpy.context) == []
    bpy.context.scene.frame_set(at_frame_10 + 1)
    found = {limb.joint: limb for limb in uncertain(bpy.context)}
    assert {name: limb.certainty.name for name, limb in found.items()} == {
        "lradius": "UNSURE",
        "rtibia": "GUESSED",
    }
    bones = ["mixamorig:LeftForeArm", "mixamorig:LeftHand"]
    wanted = points_of(armature, [at_frame_10 + 1], bones)[0]
    assert np.abs(np.array(found["lradius"].head) - wanted[0]).max() < 1e-4
    assert np.abs(np.array(found["lradius"].tail) - wanted[1]).max() < 1e-4
    bpy.context.scene.frame_set(10000)
    assert uncertain(bpy.context) == []


def test_dashes_are_even_and_reach_the_first_end():
    dashes = addon("scene.drawing").dashes
    found = dashes(Vector((0, 0, 0)), Vector((0, 0, 1)), 0.25)
    assert [round(place.z, 6) for place in found] == [0.0, 0.25, 0.5, 0.75]
    assert len(dashes(Vector((0, 0, 0)), Vector((0, 0, 0)), 0.1)) == 2
    assert len(dashes(Vector((0, 0, 0)), Vector((0, 0, 1)), 1e-12)) <= 60


def test_the_graph_shows_the_readings_around_the_playhead():
    """Of a part of the take that begins on frame 11, at one second."""
    import sparse_mocap

    armature = rigs.named_rig("mixamo")
    settings().use_range, settings().range_begin_s, settings().range_end_s = True, 1.0, 3.0
    bake(armature, start_frame=11.0)
    settings().use_range = False
    assert bpy.ops.sparse_mocap.toggle_sensor_graph() == {"FINISHED"}
    assert addon("scene.sensor_graph").is_shown()
    bpy.context.scene.frame_set(11 + 12)
    shown = addon("scene.sensor_graph").curves_at_playhead(bpy.context)
    assert set(shown.sites) == {"left_wrist", "right_wrist", "left_ankle", "right_ankle"}
    assert np.abs(shown.times_s).max() <= 2.5
    take = sparse_mocap.read_take(library().take)
    for sensor, site in enumerate(shown.sites):
        record = take.sensors[site]
        wanted_s = 1.5 + shown.times_s
        forces = sparse_mocap.filtered_at(record.times_s, record.specific_force, wanted_s)
        wanted = np.linalg.norm(forces, axis=1)
        inside = (wanted_s > 0.3) & (wanted_s < take.end_s - 0.3)
        assert np.abs(shown.measured[inside, sensor] - wanted[inside]).max() < 0.6
    error = np.nanmedian(np.abs(shown.measured - shown.expected))
    print(f"expected readings are {error:.2f} m/s² off in the median")
    assert error < 2.5
    assert bpy.ops.sparse_mocap.toggle_sensor_graph() == {"FINISHED"}
    assert not addon("scene.sensor_graph").is_shown()


def test_the_graph_says_as_much_as_there_is_room_for():
    import blf

    first_that_fits = addon("scene.sensor_graph")._first_that_fits
    white = (1.0, 1.0, 1.0, 1.0)
    name, long, short = ("Left Wrist", white), ("measured 9.8", white), ("9.8", white)
    blf.size(0, 11.0)
    lengths = {part: blf.dimensions(0, part[0])[0] for part in (name, long, short)}
    room = lengths[name] + lengths[long] + 18.0
    versions = [[name, long], [name, short], [name]]
    assert first_that_fits(versions, room, 18.0) == versions[0]
    assert first_that_fits(versions, room - 1.0, 18.0) == versions[1]
    assert first_that_fits(versions, lengths[name], 18.0) == versions[2]
    assert first_that_fits(versions, 1.0, 18.0) == versions[2]


def test_without_a_take_there_is_no_graph():
    rigs.named_rig("mixamo")
    assert "take" in error_of(bpy.ops.sparse_mocap.toggle_sensor_graph)


def test_without_a_character_it_says_what_to_do():
    settings().target = None
    bpy.context.view_layer.objects.active = None
    assert "Select a character" in error_of(bpy.ops.sparse_mocap.toggle_overlay)
