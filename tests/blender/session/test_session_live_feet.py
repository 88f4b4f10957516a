# SPDX-License-Identifier: GPL-3.0-or-later
"""Feet in a live preview: what is shown is measured by forward kinematics of its own here."""

from __future__ import annotations

import numpy as np
import pytest
import sparse_mocap
from scipy.spatial.transform import Rotation
from test_session_characters import _person

from blender_addon.session.character import Character, FootLock
from blender_addon.session.live_feet import LiveFootLock, leg_turns

_RATE_HZ = 25.0


def _ankles(character: Character, shown) -> np.ndarray:
    """(2, 3) where the rotations put the ankles: straight down from the middle of the hips."""
    found = []
    for side, sign in enumerate((1.0, -1.0)):
        thigh = shown.rotations[0, character.turned.index(f"thigh.{'LR'[side]}")]
        shin = shown.rotations[0, character.turned.index(f"shin.{'LR'[side]}")]
        hips = shown.rotations[0, character.turned.index("hips")]
        place = shown.hips[0] + hips @ [0.1 * sign, 0.0, 0.0]
        found.append(place + thigh @ [0.0, -0.4, 0.01] + shin @ [0.0, -0.42, -0.01])
    return np.array(found)


def _sway(frame: int):
    """Someone whose hips sway by 6 cm and whose legs are a little bent, so that feet slide."""
    skeleton = sparse_mocap.body_of_height(1.75).skeleton
    names = list(skeleton.names)
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (1, len(names), 1))
    for joint, degrees in (("femur", -25.0), ("tibia", 45.0)):
        x, y, z, w = Rotation.from_euler("x", degrees, degrees=True).as_quat()
        for side in "lr":
            rotations[0, names.index(side + joint)] = [w, x, y, z]
    phase = 2.0 * np.pi * frame / 50.0
    root = np.array([[0.06 * np.sin(phase), 0.9, 0.03 * np.cos(phase)]])
    return sparse_mocap.Motion(skeleton, 1.0 / _RATE_HZ, root, rotations)


def _shown(contact, frames=range(100), lock=None):
    """(T, 2, 3) ankles in the poses as they are, and as they are shown."""
    character = Character("someone", _person())
    feet = LiveFootLock(character)
    plain, kept = [], []
    for frame in frames:
        on_rig = character.on_rig(_sway(frame))
        moved, [legs] = character.world_and_legs(on_rig)
        floor_m = float(legs[:, 2, 1].min())
        contacts = (contact(frame), contact(frame))
        time_s = frame / _RATE_HZ
        shown = feet.shown(moved, legs, contacts, time_s, lock or FootLock(), floor_m)
        plain.append(_ankles(character, moved))
        kept.append(_ankles(character, shown))
        assert np.abs(plain[-1] - legs[:, 2]).max() < 1e-9
    return np.array(plain), np.array(kept)


def test_feet_that_stand_do_not_slide():
    plain, kept = _shown(lambda _: 1.0)
    assert np.ptp(plain[5:], axis=0).max() > 0.1
    assert np.ptp(kept[5:], axis=0).max() < 1e-6


def test_half_the_strength_leaves_half_of_the_sliding():
    plain, kept = _shown(lambda _: 1.0, lock=FootLock(strength=0.5))
    ratio = np.ptp(kept[5:, :, 0], axis=0) / np.ptp(plain[5:, :, 0], axis=0)
    assert np.abs(ratio - 0.5).max() < 0.02


def test_without_contact_poses_are_as_they_are():
    plain, kept = _shown(lambda _: 0.2)
    assert np.abs(plain - kept).max() < 1e-9


def test_a_foot_that_is_let_go_returns_without_a_jump():
    plain, kept = _shown(lambda frame: float(frame % 50 < 25))
    steps = np.linalg.norm(np.diff(kept, axis=0), axis=-1)
    assert steps.max() < 0.035
    assert np.linalg.norm(plain - kept, axis=-1)[48].max() < 0.01


def test_a_pose_that_jumps_lets_feet_go():
    plain, kept = _shown(lambda _: 1.0, frames=[*range(20), *range(200, 203)])
    assert np.abs(plain[20] - kept[20]).max() < 1e-9


@pytest.mark.parametrize("bend", [0.0, 0.3])
def test_a_leg_reaches_where_it_is_wanted_and_the_knee_stays_in_front(bend):
    hip, knee = np.array([0.1, 0.9, 0.0]), np.array([0.1, 0.5, 0.4 * np.sin(bend)])
    ankle = np.array([0.1, 0.12, 0.0])
    random = np.random.default_rng(4)
    for _ in range(50):
        wanted = ankle + random.uniform(-0.12, 0.12, 3) + np.array([0.0, 0.12, 0.0])
        thigh, shank = leg_turns(hip, knee, ankle, wanted)
        for turn in (thigh, shank):
            assert np.abs(turn @ turn.T - np.eye(3)).max() < 1e-12
            assert np.linalg.det(turn) > 0.0
        new_knee = hip + thigh @ (knee - hip)
        reached = new_knee + shank @ (ankle - knee)
        assert np.linalg.norm(reached - wanted) < 1e-9
        middle = hip + (wanted - hip) * np.dot(new_knee - hip, wanted - hip) / np.sum(
            (wanted - hip) ** 2
        )
        assert (new_knee - middle)[2] > 0.0


def test_a_leg_that_cannot_reach_is_stretched_towards_it():
    hip, knee, ankle = (np.array([0.0, y, 0.0]) for y in (0.9, 0.5, 0.1))
    thigh, shank = leg_turns(hip, knee, ankle, np.array([0.0, -2.0, 0.5]))
    reached = hip + thigh @ (knee - hip) + shank @ (ankle - knee)
    towards = np.array([0.0, -2.9, 0.5]) / np.linalg.norm([0.0, -2.9, 0.5])
    assert np.linalg.norm(reached - hip) < 0.8 + 1e-9
    assert np.dot((reached - hip) / np.linalg.norm(reached - hip), towards) > 1.0 - 1e-9
