# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes on characters, and where Blender then has their bones."""

from __future__ import annotations

import bpy
import numpy as np
import rigs
from support import choose_files, expected_performance, reconstruct, settings


def bake(armature, *, foot_lock: float = 0.0, **options):
    choose_files()
    settings().target, settings().foot_lock = armature, foot_lock
    assert reconstruct(**options) == armature
    return armature.animation_data.action


def limbs_of(style: str) -> dict[str, tuple[str, str]]:
    after = {"thigh": "shank", "shank": "foot", "upper_arm": "forearm", "forearm": "hand"}
    named = rigs.STYLES[style]
    return {
        joint: (named.name(part, side), named.name(after[part], side))
        for joint, (part, side) in rigs.LIMBS.items()
    }


def solved():
    """What the solver made of the take, at the scene's rate."""
    scene = bpy.context.scene
    return expected_performance().motion.resampled(scene.render.fps / scene.render.fps_base)


def worst_mean_degrees(armature, limbs, turn=None) -> float:
    motion = solved()
    frames = range(1, 1 + motion.num_frames)
    wanted, found = rigs.wanted_directions(motion), rigs.limb_directions(armature, frames, limbs)
    turn = np.eye(3) if turn is None else turn
    return max(rigs.degrees(wanted[j] @ turn.T, found[j]).mean() for j in limbs)


def points_of(armature, frames, bones) -> np.ndarray:
    """(T, n, 3) the bones' heads in the world."""
    points = []
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
        heads = [evaluated.pose.bones[name].head for name in bones]
        points.append([evaluated.matrix_world @ head for head in heads])
    return np.array(points)
