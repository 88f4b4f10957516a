# SPDX-License-Identifier: GPL-3.0-or-later
"""A motion as an action: quaternion keys grouped by bone, the root's location, times kept."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from bpy.types import Action, FCurve, Keyframe, Object, Scene
from numpy.typing import NDArray

from .armature import rest_orientation, units_per_metre_of
from .axes import bone_quaternions, continuous, to_blender
from .compat import new_curve_of

LOCATION, ROTATION = "location", "rotation_quaternion"


def frames_of(
    scene: Scene, times_s: NDArray[np.float64], start_frame: float
) -> NDArray[np.float64]:
    """(T,) the frames, mostly fractional, at which the scene's rate shows these times."""
    return start_frame + times_s * (scene.render.fps / scene.render.fps_base)


def make_action(name: str, armature: Object, motion: Any, frames: NDArray[np.float64]) -> Action:
    """A new action in which the armature moves as the motion (sparse_mocap.Motion) does.

    frames (T,): where the keys stand. Raises ValueError when the motion has numbers that are none.
    """
    root_positions, rotations = np.asarray(motion.root_positions), np.asarray(motion.rotations)
    if not (np.isfinite(root_positions).all() and np.isfinite(rotations).all()):
        raise ValueError("The motion has positions or rotations that are not numbers")
    action = bpy.data.actions.new(name)
    try:
        action.use_fake_user = True
        new_curve = new_curve_of(action)
        scale = units_per_metre_of(armature, motion.skeleton)
        for joint, bone in enumerate(motion.skeleton.names):
            path = f'pose.bones["{bpy.utils.escape_identifier(bone)}"].'
            if joint == 0:
                moved = _root_locations(armature, bone, to_blender(root_positions) * scale)
                for index, values in enumerate(moved.T):
                    _set_keys(new_curve(path + LOCATION, index, bone), frames, values)
            turned = bone_quaternions(rotations[:, joint], rest_orientation(armature, bone))
            for index, values in enumerate(continuous(turned).T):
                _set_keys(new_curve(path + ROTATION, index, bone), frames, values)
    except Exception:
        bpy.data.actions.remove(action)
        raise
    return action


def _root_locations(
    armature: Object, bone: str, positions: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(T, 3) how far the root bone is from its rest, in its own rest axes."""
    rest_head = np.array(armature.data.bones[bone].head_local)
    return (positions - rest_head) @ rest_orientation(armature, bone)


def _set_keys(curve: FCurve, frames: NDArray[np.float64], values: NDArray[np.float64]) -> None:
    keys = curve.keyframe_points
    keys.add(len(frames))
    keys.foreach_set("co", np.column_stack([frames, values]).ravel())
    for attribute, identifier in (
        ("interpolation", "LINEAR"),
        ("handle_left_type", "AUTO_CLAMPED"),
        ("handle_right_type", "AUTO_CLAMPED"),
    ):
        number = Keyframe.bl_rna.properties[attribute].enum_items[identifier].value
        keys.foreach_set(attribute, [number] * len(frames))
    curve.update()
