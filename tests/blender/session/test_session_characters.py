# SPDX-License-Identifier: GPL-3.0-or-later
"""Characters, keys and stages without Blender."""

from __future__ import annotations

from concurrent.futures import Future
from types import SimpleNamespace

import numpy as np
import pytest
import sparse_mocap
from scipy.spatial.transform import Rotation

from blender_addon.session import key_reduction, sensors
from blender_addon.session.bake import Placement
from blender_addon.session.character import Character, FootLock, RestBone
from blender_addon.session.errors import InputError
from blender_addon.session.live_poses import Pose
from blender_addon.session.methods import MethodChoice
from blender_addon.session.retarget import on_scene_frames, quaternions_of, without_jumps
from blender_addon.session.stage import Stage


def _person() -> list[RestBone]:
    """A person of 1.8 m in T-pose who faces +z, with an armature's root below the hips."""
    places = {
        "root": ("", (0, 0, 0)),
        "hips": ("root", (0, 0.95, 0)),
        "spine": ("hips", (0, 1.1, 0)),
        "chest": ("spine", (0, 1.3, 0)),
        "neck": ("chest", (0, 1.5, 0)),
        "head": ("neck", (0, 1.6, 0)),
    }
    for side, sign in (("L", 1.0), ("R", -1.0)):
        places |= {
            f"shoulder.{side}": ("chest", (0.03 * sign, 1.45, 0)),
            f"upper_arm.{side}": (f"shoulder.{side}", (0.2 * sign, 1.45, 0)),
            f"forearm.{side}": (f"upper_arm.{side}", (0.48 * sign, 1.45, 0)),
            f"hand.{side}": (f"forearm.{side}", (0.74 * sign, 1.45, 0)),
            f"thigh.{side}": ("hips", (0.1 * sign, 0.9, 0)),
            f"shin.{side}": (f"thigh.{side}", (0.1 * sign, 0.5, 0.01)),
            f"foot.{side}": (f"shin.{side}", (0.1 * sign, 0.08, 0)),
            f"toe.{side}": (f"foot.{side}", (0.1 * sign, 0.0, 0.15)),
        }
    names = list(places)
    bones = []
    for name, (parent, head) in places.items():
        below = [other for other in names if places[other][0] == name]
        tail = places[below[0]][1] if below else np.add(head, (0, 0, 0.07))
        index = names.index(parent) if parent else -1
        bones.append(RestBone(name, index, np.array(head, float), np.array(tail, float)))
    return bones


def _standing(num_frames: int = 30):
    skeleton = sparse_mocap.body_of_height(1.75).skeleton
    joints = len(skeleton.names)
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (num_frames, joints, 1))
    roots = np.tile([0.0, 0.95, 0.0], (num_frames, 1))
    return sparse_mocap.Motion(skeleton, 0.04, roots, rotations)


def test_the_body_hangs_on_the_hips_and_feet_are_turned_too():
    character = Character("someone", _person())
    assert character.top == character.pelvis == "hips"
    assert {"foot.L", "foot.R", "thigh.L", "hand.R", "head"} <= set(character.turned)
    assert character.ends["ltibia"] == "foot.L"
    assert character.ends["rradius"] == "hand.R"


def test_feet_stand_where_the_soles_are():
    character = Character("someone", _person())
    moved = character.standing(character.on_rig(_standing()))
    assert np.abs(character.world(moved).above_floor_m).max() < 1e-9
    names = list(moved.skeleton.names)
    toes = moved.pivot_positions()[:, names.index("toe.L")]
    assert np.abs(toes[:, 1]).max() < 0.02


def test_without_strength_nothing_is_locked():
    character = Character("someone", _person())
    moved = character.standing(character.on_rig(_standing()))
    same, stands = character.with_locked_feet(moved, np.ones((30, 2)), FootLock(strength=0.0))
    assert same is moved
    assert not stands.any()
    _, stands = character.with_locked_feet(moved, np.ones((30, 2)), FootLock())
    assert stands.all()


def test_bones_of_no_person_are_refused_by_name():
    with pytest.raises(InputError, match='"lamp"'):
        Character("lamp", _person()[:6])


def test_fewer_keys_miss_no_value_by_more():
    random = np.random.default_rng(1)
    times = np.arange(400.0)
    values = np.cumsum(random.normal(0.0, 0.1, (400, 3)), axis=0)
    kept = key_reduction.kept_keys(times, values, 0.5)
    assert 2 < len(kept) < 200
    columns = [np.interp(times, times[kept], values[kept, axis]) for axis in range(3)]
    assert np.linalg.norm(np.column_stack(columns) - values, axis=1).max() <= 0.5 + 1e-12
    line = np.column_stack([times, 2.0 * times])
    assert list(key_reduction.kept_keys(times, line, 1e-9)) == [0, 399]
    assert len(key_reduction.kept_keys(times, values, 0.0)) == 400


def test_quaternions_that_far_apart_differ_by_that_angle():
    for degrees in (0.5, 5.0, 60.0):
        turned = Rotation.from_euler("x", degrees, degrees=True).as_quat()
        distance = np.linalg.norm(turned - [0.0, 0.0, 0.0, 1.0])
        assert abs(key_reduction.quaternion_distance(degrees) - distance) < 1e-12


def test_smoothing_keeps_what_is_straight_and_calms_what_is_not():
    motion = _standing(60)
    roots = np.array(motion.root_positions)
    roots[:, 0] = np.linspace(0.0, 1.0, 60)
    rough = roots + np.random.default_rng(2).normal(0.0, 0.01, roots.shape)
    for given, far in ((roots, 1e-9), (rough, 0.01)):
        moving = sparse_mocap.Motion(motion.skeleton, 0.04, given, motion.rotations)
        smooth = key_reduction.smoothed(moving, 0.12)
        assert np.abs(np.array(smooth.root_positions)[15:45] - roots[15:45]).max() <= far
    assert key_reduction.smoothed(motion, 0.0) is motion


def test_quaternions_of_matrices():
    rotations = Rotation.random(200, random_state=3)
    half_turns = Rotation.from_rotvec(np.pi * np.eye(3))
    for given in (rotations, half_turns):
        found = quaternions_of(given.as_matrix())
        back = Rotation.from_quat(np.roll(found, -1, axis=-1))
        assert (back * given.inv()).magnitude().max() < 1e-7
    turns = np.radians(np.linspace(0.0, 1000.0, 400))[:, None] * [0.0, 1.0, 0.0]
    path = Rotation.from_rotvec(turns).as_matrix()
    steady = without_jumps(quaternions_of(path))
    assert (np.einsum("ti,ti->t", steady[1:], steady[:-1]) > 0.0).all()


def test_contacts_follow_the_scenes_frames():
    motion = _standing(25)
    contacts = np.column_stack([np.linspace(0.0, 1.0, 25), np.ones(25)])
    placed, found = on_scene_frames(motion, contacts, 50.0)
    assert placed.num_frames == len(found)
    assert np.abs(found[::2, 0] - contacts[: len(found[::2]), 0]).max() < 1e-9
    assert on_scene_frames(motion, contacts, 25.0)[0] is motion


def test_the_stage_recentres_turns_and_keeps_in_place():
    turned = np.roll(Rotation.from_euler("y", 70.0, degrees=True).as_quat(), 1)
    pose = Pose(1, np.tile(turned, (3, 1)), np.array([2.0, 0.9, -1.0]), 0.0)
    stage = Stage()
    shown = stage.shown(pose, in_place=False)
    assert np.allclose(shown.root_position, pose.root_position)
    assert np.allclose(shown.rotations, pose.rotations)
    assert np.allclose(stage.shown(pose, in_place=True).root_position, [0.0, 0.9, 0.0])
    stage.face_front()
    shown = stage.shown(pose, in_place=False)
    assert np.allclose(shown.root_position, [0.0, 0.9, 0.0])
    assert np.allclose(np.abs(shown.rotations[0]), [1.0, 0.0, 0.0, 0.0], atol=1e-9)
    ahead = Rotation.from_euler("y", 70.0, degrees=True).apply([0.0, 0.0, 1.0])
    later = Pose(2, pose.rotations, pose.root_position + ahead, 0.1)
    assert np.allclose(stage.shown(later, in_place=False).root_position, [0.0, 0.9, 1.0])


def test_a_recording_that_is_cancelled_is_saved_all_the_same(tmp_path, monkeypatch):
    """Esc while the take is reconstructed: the file is there, and the word is cancelled."""

    def cancelled(*_: object, **__: object) -> None:
        raise sparse_mocap.Cancelled("Cancelled")

    future: Future[tuple[object, int]] = Future()
    future.set_result((tmp_path, 1))
    session = SimpleNamespace(stop_recording=lambda: future, tell_saved=lambda _: None)
    monkeypatch.setattr(sensors, "_save", lambda *_: (str(tmp_path / "take.csv"), ()))
    monkeypatch.setattr(sensors, "reconstruct", cancelled)
    monkeypatch.setattr(sensors.databases, "get", lambda _: None)
    monkeypatch.setattr(sensors.takes, "get", lambda _: None)
    placement = Placement(1.0, 24.0, is_on_frames=True)
    choice = MethodChoice()
    job = sensors.save_take_job(session, "some.smdb", "", tmp_path, choice, placement)
    saved = job.run()
    assert (saved.path, saved.placed, saved.reason) == (
        str(tmp_path / "take.csv"),
        None,
        "cancelled",
    )
