# SPDX-License-Identifier: GPL-3.0-or-later
"""A motion as an action: quaternion keys grouped by bone, the root's location, times kept."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from bpy.types import Action, FCurve, Keyframe, Scene
from numpy.typing import NDArray

from ..session.key_reduction import kept_key_steps, quaternion_distance
from ..session.steps import Steps, finished, part
from .armature import Rig, rest_orientation
from .axes import bone_quaternions, continuous, to_blender
from .compat import new_curve_of

LOCATION, ROTATION, EULER = "location", "rotation_quaternion", "rotation_euler"


def frames_of(
    scene: Scene, times_s: NDArray[np.floating[Any]], start_frame: float
) -> NDArray[np.float64]:
    """(T,) the scene's frames, usually fractional, at these times."""
    return start_frame + times_s * (scene.render.fps / scene.render.fps_base)


@dataclass(frozen=True)
class Reduction:
    """How far bones may be off where keys are left out."""

    degrees: float
    distance: float  # in the armature's units

    def kept_steps(
        self, what: str, frames: NDArray[np.float64], track: NDArray[np.float64]
    ) -> Steps[NDArray[np.intp]]:
        """The keys of a track (T, n) that stay; what: the channel's name."""
        errors = {
            LOCATION: self.distance,
            ROTATION: quaternion_distance(self.degrees),
            EULER: np.radians(self.degrees) / np.sqrt(3.0),  # three turns one after another
        }
        if what not in errors:
            return np.arange(len(frames))
        return (yield from kept_key_steps(frames, track, errors[what]))


def kept_steps(
    reduction: Reduction | None,
    what: str,
    frames: NDArray[np.float64],
    track: NDArray[np.float64],
) -> Steps[NDArray[np.intp]]:
    """The keys of a track that stay; without a reduction all."""
    if reduction is None:
        return np.arange(len(frames))
    return (yield from reduction.kept_steps(what, frames, track))


def action_steps(
    name: str,
    rig: Rig,
    motion: Any,
    frames: NDArray[np.float64],
    reduction: Reduction | None = None,
) -> Generator[float, None, Action]:
    """A new action with the motion as keys for the rig, made step by step.

    motion: a sparse_mocap.Motion or session.imported.LoadedMotion on the rig's skeleton; frames
    (T,): where the keys are placed. Yields the fraction done, after each curve. Raises ValueError
    when the motion is not finite; nothing is left behind then, nor when the generator is closed.
    """
    positions, rotations = _positions(motion), np.asarray(motion.rotations)
    if not all(np.isfinite(values).all() for values in (rotations, *positions.values())):
        raise ValueError("The motion has positions or rotations that are not finite numbers")
    rest = [rest_orientation(rig.armature, bone) for bone in rig.bones]
    heads = [np.array(rig.armature.data.bones[bone].head_local) for bone in rig.bones]
    action = bpy.data.actions.new(name)
    try:
        action.use_fake_user = True
        new_curve = new_curve_of(action)
        for joint, bone in enumerate(rig.bones):
            path = f'pose.bones["{bpy.utils.escape_identifier(bone)}"].'
            turned = continuous(bone_quaternions(rotations[:, joint], rest[joint]))
            tracks = {ROTATION: turned}
            if joint in positions:
                moved = to_blender(positions[joint]) * rig.units_per_metre
                origin = heads[joint] if joint == 0 else 0.0
                tracks = {LOCATION: (moved - origin) @ rest[joint], ROTATION: turned}
            yield joint / len(rig.bones)
            for what, track in tracks.items():
                choosing = kept_steps(reduction, what, frames, track)
                kept = yield from part(choosing, joint / len(rig.bones), 0.0)
                for index, values in enumerate(track.T):
                    action.name  # noqa: B018 - raises ReferenceError after an undo
                    set_keys(new_curve(path + what, index, bone), frames[kept], values[kept])
                    yield (joint + (index + 1) / len(track.T)) / len(rig.bones)
    except BaseException:
        with suppress(ReferenceError):
            bpy.data.actions.remove(action)
        raise
    return action


def make_action(name: str, rig: Rig, motion: Any, frames: NDArray[np.float64]) -> Action:
    """As action_steps, without steps."""
    return finished(action_steps(name, rig, motion, frames))


def _positions(motion: Any) -> dict[int, NDArray[np.float64]]:
    """(T, 3) the root's position and other joints' distance from rest, by joint."""
    offsets = np.asarray(motion.skeleton.offsets)
    moved = {joint: np.asarray(track) - offsets[joint] for joint, track in motion.offset_tracks}
    return {**moved, 0: np.asarray(motion.root_positions)}


def set_keys(
    curve: FCurve,
    frames: NDArray[np.float64],
    values: NDArray[np.float64],
    interpolation: str = "LINEAR",
) -> None:
    """Set the keys of a new curve, in one go."""
    keys = curve.keyframe_points
    keys.add(len(frames))
    keys.foreach_set("co", np.column_stack([frames, values]).ravel())
    for attribute, identifier in (
        ("interpolation", interpolation),
        ("handle_left_type", "AUTO_CLAMPED"),
        ("handle_right_type", "AUTO_CLAMPED"),
    ):
        number = Keyframe.bl_rna.properties[attribute].enum_items[identifier].value
        keys.foreach_set(attribute, [number] * len(frames))
    curve.update()
