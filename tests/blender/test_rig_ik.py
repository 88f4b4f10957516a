# SPDX-License-Identifier: GPL-3.0-or-later
"""IK controls and locked feet. Blender's evaluated bones are compared with FK and the solver's."""

from __future__ import annotations

from itertools import pairwise

import bpy
import numpy as np
import rigs
from mathutils import Vector
from rig_baking import bake, points_of, solved
from support import addon, settings

_WORST_M = 0.005


def _rigify_points(armature, frames) -> np.ndarray:
    """(T, 12, 3) hips, shoulders, knees, elbows, ankles and wrists, each left and right."""
    bones = ("thigh", "upper_arm", "shin", "forearm", "foot", "hand")
    return points_of(armature, frames, [f"DEF-{bone}.{side}" for bone in bones for side in "LR"])


def _bends(points: np.ndarray) -> np.ndarray:
    """(T, 4, 3) from the line between a limb's ends to its knee or elbow."""
    along = _unit(points[:, 8:] - points[:, :4])
    out = points[:, 4:8] - points[:, :4]
    return out - along * np.einsum("tni,tni->tn", along, out)[..., None]


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def test_hands_and_feet_of_rigify_meet_the_solvers_by_its_ik():
    armature = rigs.rigify_rig()
    frames = range(1, 1 + solved().num_frames)
    found = {}
    for limbs in ("IK", "LEGS", "FK"):  # nothing of one choice stays in the next one's action
        settings().limbs = limbs
        action = bake(armature, foot_lock=1.0)
        found[limbs] = _rigify_points(armature, frames)
        paths = {curve.data_path for curve in addon("scene.compat").curves_of(action)}
        assert ('pose.bones["foot_ik.L"].location' in paths) == (limbs != "FK")
        assert ('pose.bones["hand_fk.L"].rotation_quaternion' in paths) == (limbs != "IK")
        assert ('pose.bones["thigh_parent.L"]["pole_vector"]' in paths) == (limbs != "FK")
    for limbs in ("LEGS", "IK"):
        apart = np.linalg.norm(found[limbs] - found["FK"], axis=-1)[:, 4:]
        print(
            f"{limbs}: knees and elbows {1e3 * apart[:, :4].max():.1f} mm, "
            f"ankles and wrists {1e3 * apart[:, 4:].max():.1f} mm from FK"
        )
        assert apart[:, 4:].max() <= _WORST_M
        assert apart[:, :4].max() <= 0.03  # Rigify's IK shortens a limb by 1 %
        bends = [_bends(found[one]) for one in ("FK", limbs)]
        clear = np.linalg.norm(bends[0], axis=-1) > 0.03
        cosines = np.einsum("tni,tni->tn", *(_unit(bend) for bend in bends))
        assert clear.mean() > 0.5
        assert cosines[clear].min() > 0.95


def _arp_points(armature, frames) -> np.ndarray:
    """(T, 12, 3) as _rigify_points."""
    bones = ("thigh", "arm", "leg", "forearm", "foot", "hand")
    return points_of(armature, frames, [f"{bone}.{side}" for bone in bones for side in "lr"])


def test_hands_and_feet_of_auto_rig_pro_meet_the_solvers_by_its_ik():
    armature = rigs.auto_rig_pro_rig()
    frames = range(1, 1 + solved().num_frames)
    found = {}
    for limbs in ("IK", "LEGS", "FK"):
        settings().limbs = limbs
        action = bake(armature)
        found[limbs] = _arp_points(armature, frames)
        paths = {curve.data_path for curve in addon("scene.compat").curves_of(action)}
        assert ('pose.bones["c_foot_ik.l"].location' in paths) == (limbs != "FK")
        assert ('pose.bones["c_hand_fk.l"].rotation_quaternion' in paths) == (limbs != "IK")
        [switch] = [
            curve
            for curve in addon("scene.compat").curves_of(action)
            if curve.data_path == 'pose.bones["c_foot_ik.l"]["ik_fk_switch"]'
        ]
        assert switch.keyframe_points[0].co.y == (1.0 if limbs == "FK" else 0.0)
    for limbs in ("LEGS", "IK"):
        apart = np.linalg.norm(found[limbs] - found["FK"], axis=-1)[:, 4:]
        print(
            f"{limbs}: knees and elbows {1e3 * apart[:, :4].max():.1f} mm, "
            f"ankles and wrists {1e3 * apart[:, 4:].max():.1f} mm from FK"
        )
        assert apart[:, 4:].max() <= _WORST_M
        assert apart[:, :4].max() <= _WORST_M


def test_a_rig_with_ik_constraints_alone_is_moved_by_their_targets():
    armature = rigs.named_rig("mixamo", rolls=True)
    named = rigs.STYLES["mixamo"]
    bpy.ops.object.mode_set(mode="EDIT")
    for side in "LR":
        foot = armature.data.edit_bones[named.name("foot", side)]
        target = armature.data.edit_bones.new(f"ik_foot_{side}")
        target.head, target.tail = foot.head, foot.head + Vector((0, 0.2, 0))
        pole = armature.data.edit_bones.new(f"pole_{side}")
        knee = armature.data.edit_bones[named.name("shank", side)]
        knee.head.y -= 0.01  # a knee that is bent a little
        armature.data.edit_bones[named.name("thigh", side)].tail = knee.head
        pole.head = knee.head + Vector((0, -0.6, 0))
        pole.tail = pole.head + Vector((0, -0.1, 0))
    bpy.ops.object.mode_set(mode="OBJECT")
    for side in "LR":
        constraint = armature.pose.bones[named.name("shank", side)].constraints.new("IK")
        constraint.target, constraint.subtarget = armature, f"ik_foot_{side}"
        constraint.chain_count = 2
        copy = armature.pose.bones[named.name("foot", side)].constraints.new("COPY_ROTATION")
        copy.target, copy.subtarget = armature, f"ik_foot_{side}"
        copy.target_space = copy.owner_space = "LOCAL_WITH_PARENT"
    action = bake(armature)
    paths = {curve.data_path for curve in addon("scene.compat").curves_of(action)}
    assert 'pose.bones["ik_foot_L"].location' in paths
    assert not any(named.name("shank", "L") in path for path in paths)
    motion = solved()
    joints = list(motion.skeleton.names)
    feet = [named.name("foot", side) for side in "LR"]
    thighs = [named.name("thigh", side) for side in "LR"]
    points = points_of(armature, range(1, 1 + motion.num_frames), [*feet, *thighs])
    ends = rigs.in_blenders_axes(motion.joint_positions("world"))
    pivots = rigs.in_blenders_axes(motion.pivot_positions())
    wanted = np.stack(
        [ends[:, joints.index(name)] for name in ("ltibia", "rtibia")]
        + [pivots[:, joints.index(name)] for name in ("lfemur", "rfemur")],
        axis=1,
    )
    for positions in (points, wanted):
        positions -= positions[:, 2:4].mean(axis=1, keepdims=True)
    assert np.linalg.norm(points - wanted, axis=-1).max() < _WORST_M


def _standing_speed_mps(points: np.ndarray, stands: np.ndarray) -> float:
    """The mean speed of feet (T, 2, 3) while they stand (T, 2)."""
    scene = bpy.context.scene
    dt = 2.0 * scene.render.fps_base / scene.render.fps
    speeds = np.linalg.norm(points[2:] - points[:-2], axis=-1) / dt
    return float(speeds[stands[1:-1]].mean())


def test_locked_feet_stand_still_and_stay_above_the_floor():
    import sparse_mocap

    motion = rigs.standard_motion_of_take().resampled(24.0)
    joints = list(motion.skeleton.names)
    truth = motion.joint_positions("world")[:, [joints.index("ltibia"), joints.index("rtibia")]]
    low = truth[..., 1].min()
    stands = truth[..., 1] < low + 0.06
    stands[1:-1] &= np.linalg.norm(truth[2:] - truth[:-2], axis=-1) * 12.0 < 0.3
    for armature, feet, toe in (
        (rigs.rigify_rig(), ("DEF-foot.L", "DEF-foot.R"), "DEF-toe.L"),
        (
            rigs.named_rig("mixamo", size=1.15),
            ("mixamorig:LeftFoot", "mixamorig:RightFoot"),
            "mixamorig:LeftToeBase",
        ),
    ):
        speeds = {}
        for lock in (0.0, 1.0):
            bake(armature, foot_lock=lock)
            num_frames = min(solved().num_frames, len(stands))
            points = points_of(armature, range(1, 1 + num_frames), [*feet, toe])
            speeds[lock] = _standing_speed_mps(points[:, :2], stands[:num_frames])
        allowed = _standing_speed_mps(truth[:num_frames], stands[:num_frames]) + 0.03
        print(f"standing feet: {100 * speeds[0.0]:.1f} cm/s, locked {100 * speeds[1.0]:.1f} cm/s")
        assert speeds[1.0] <= allowed
        assert speeds[1.0] < 0.5 * speeds[0.0]
        assert points[..., 2].min() > -0.01
    assert isinstance(motion, sparse_mocap.Motion)


def test_contacts_are_keyed_as_properties_of_the_character():
    armature = rigs.named_rig("mixamo")
    action = bake(armature, foot_lock=1.0)
    curves = addon("scene.compat").curves_of(action)
    for side in ("left", "right"):
        [curve] = [one for one in curves if one.data_path == f'["{side}_foot_on_floor"]']
        values = [key.co.y for key in curve.keyframe_points]
        assert set(values) == {0.0, 1.0}
        assert all(a != b for a, b in pairwise(values))
        assert {key.interpolation for key in curve.keyframe_points} == {"CONSTANT"}
        assert f"{side}_foot_on_floor" in armature


def test_feet_stand_on_the_floor_that_is_chosen():
    armature = rigs.named_rig("mixamo")
    floor = bpy.data.objects.new("floor", None)
    bpy.context.scene.collection.objects.link(floor)
    feet, toe = ("mixamorig:LeftFoot", "mixamorig:RightFoot"), "mixamorig:LeftToeBase"
    heights = []
    for height in (0.0, 0.4):
        floor.location.z = height
        bpy.context.view_layer.update()
        settings().floor = floor
        bake(armature, foot_lock=1.0)
        heights.append(points_of(armature, range(1, 60), [*feet, toe])[..., 2].min())
    assert abs(heights[1] - heights[0] - 0.4) < 1e-4
