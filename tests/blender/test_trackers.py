# SPDX-License-Identifier: GPL-3.0-or-later
"""Six trackers by the method of Liu et al. 2011: baked, live, and calibrated by poses."""

from __future__ import annotations

import bpy
import numpy as np
import rigs
from calibration_support import HOLD_S, READY_S, follows_poses, held
from calibration_support import TRACKER_SITES as SITES
from connected import connected
from live_support import until
from rig_baking import limbs_of
from support import addon, error_of, library, reconstruct, settings

WITH_ORIENTATION = "output=mtdata2"


def _performed():
    """A walk of the library's, which is not in its database."""
    import sparse_mocap

    walk = sorted(library().motions.parent.joinpath("all").glob("*.bvh"))[1]
    return sparse_mocap.standard_motion(sparse_mocap.read_motion(walk)[0])[0]


def _choose() -> None:
    settings().database = str(library().database)
    settings().method = "liu2011"
    settings().foot_lock = 0.0


def test_a_take_of_trackers_is_baked_on_a_character(tmp_path):
    import sparse_mocap

    motion = _performed()
    take = tmp_path / "trackers.csv"
    ideal = sparse_mocap.simulated(motion, SITES, 100.0, with_position=True)
    sparse_mocap.write_take(take, ideal)
    armature = rigs.named_rig("unreal")
    _choose()
    settings().take, settings().target = str(take), armature
    bpy.context.scene.render.fps = 25
    for offline in (False, True):
        assert reconstruct(offline=offline) == armature
        solved = sparse_mocap.reconstruct(
            sparse_mocap.read_take(take),
            library().database,
            method="liu2011",
            best_quality=offline,
        )
        frames = range(1, 1 + solved.motion.num_frames)
        wanted, limbs = rigs.wanted_directions(solved.motion), limbs_of("unreal")
        found = rigs.limb_directions(armature, frames, limbs)
        for joint in limbs:
            off = rigs.degrees(wanted[joint], found[joint]).mean()
            assert off < 3.0, (joint, offline)


def test_a_character_follows_trackers_live(tmp_path):
    import sparse_mocap

    take = sparse_mocap.simulated(_performed(), SITES, 100.0)
    armature = rigs.named_rig("unreal")
    with connected(tmp_path, take, sites=SITES, options=WITH_ORIENTATION) as session:
        _choose()
        settings().target = armature
        assert bpy.ops.sparse_mocap.go_live() == {"FINISHED"}
        until(lambda: session.state.is_live or session.state.error)
        assert session.state.error == ""
        scene, shown = addon("scene.live"), []

        def has_enough() -> bool:
            pose = scene.tick()
            if pose is not None:
                shown.append(pose.rotations)
            return len(shown) >= 20

        until(has_enough)
        assert np.isfinite(shown).all()
        assert np.ptp(shown, axis=0).max() > 0.01
        assert bpy.ops.sparse_mocap.leave_live() == {"FINISHED"}


def test_trackers_are_calibrated_by_poses(tmp_path):
    performed, guide = held(), addon("session.pose_guide")
    before = guide.TIMES
    guide.TIMES = guide.Times(READY_S, HOLD_S)
    doing = follows_poses(performed, guide)
    try:
        with connected(tmp_path, doing, sites=SITES, options=WITH_ORIENTATION) as session:
            assert all(sensor["has_orientation"] for sensor in session.state.sensors)
            assert bpy.ops.sparse_mocap.calibrate_by_poses() == {"FINISHED"}
            found = addon("session.calibrating").calibrations.get(settings().calibration)
            for site, wanted in zip(SITES, performed.turns, strict=True):
                off = found.sensors[site].R_site_sensor @ wanted.T
                assert np.degrees(np.arccos(min((np.trace(off) - 1) / 2, 1.0))) < 10.0, site
            assert found.body is not None
            assert addon("scene.pose_guide")._handler is None
    finally:
        guide.TIMES = before


def test_without_trackers_there_is_nothing_to_calibrate():
    assert "Connect" in error_of(bpy.ops.sparse_mocap.calibrate_by_poses)
