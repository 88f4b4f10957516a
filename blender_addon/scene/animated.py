# SPDX-License-Identifier: GPL-3.0-or-later
"""The movement of the file's armatures: every action that moves one, sampled as it plays."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import bpy
import numpy as np
from bpy.types import Action, Context, Object

from ..session.sampled import SampledBones, largest_tree
from ..session.steps import Steps
from . import compat


@dataclass(frozen=True)
class AnimatedArmature:
    """An armature and an action that moves its bones, by name."""

    armature: str
    action: str
    first: int
    last: int
    """The action's first and last frame."""


def animated_armatures(context: Context) -> list[AnimatedArmature]:
    """Those of the scene, each armature with every action that moves bones of it."""
    found = []
    for obj in context.scene.objects:
        if obj.type != "ARMATURE":
            continue
        for action in bpy.data.actions:
            first, last = (round(frame) for frame in action.frame_range)
            if last > first and _moves(action, obj):
                found.append(AnimatedArmature(obj.name, action.name, first, last))
    return found


def sampled_steps(
    context: Context, animated: list[AnimatedArmature]
) -> Steps[list[tuple[AnimatedArmature, SampledBones]]]:
    """The bones' poses in every frame; the scene is as before when that is done or ended."""
    total = sum(entry.last - entry.first + 1 for entry in animated)
    done, sampled = 0, []
    with _unchanged(context, animated):
        for entry in animated:
            obj = context.scene.objects[entry.armature]
            compat.play_alone(obj, bpy.data.actions[entry.action])
            bones = _bones(obj)
            for frame in range(entry.first, entry.last + 1):
                context.scene.frame_set(frame)
                bones.poses.append(_poses(context, entry.armature, bones.names))
                done += 1
                yield done / total
            sampled.append((entry, bones))
    return sampled


@contextmanager
def _unchanged(context: Context, animated: list[AnimatedArmature]) -> Iterator[None]:
    """Gives the armatures their actions back, and the scene its frame."""
    frame = context.scene.frame_current
    names = {entry.armature for entry in animated}
    before = {name: compat.playing(context.scene.objects[name]) for name in names}
    try:
        yield
    finally:
        for name, played in before.items():
            if (obj := context.scene.objects.get(name)) is not None:
                compat.play_again(obj, played)
        context.scene.frame_set(frame)


def _moves(action: Action, obj: Object) -> bool:
    """Whether the action turns bones that the armature has."""
    bones = obj.data.bones
    for curve in compat.curves_of(action):
        begin, _, rest = curve.data_path.partition('["')
        if begin == "pose.bones" and rest.partition('"]')[0] in bones:
            return True
    return False


def _bones(obj: Object) -> SampledBones:
    bones = list(obj.data.bones)
    index = {bone.name: at for at, bone in enumerate(bones)}
    parents = [index[bone.parent.name] if bone.parent else -1 for bone in bones]
    kept = largest_tree(parents)
    place = {bone: at for at, bone in enumerate(kept)}
    world = np.array(obj.matrix_world)
    rest = np.array([world @ np.array(bones[at].matrix_local) for at in kept])
    return SampledBones(
        names=[bones[at].name for at in kept],
        parents=[place.get(parents[at], -1) for at in kept],
        rest=rest,
        lengths=np.array(
            [bones[at].length * np.linalg.norm(rest[i, :3, 1]) for i, at in enumerate(kept)]
        ),
    )


def _poses(context: Context, name: str, bones: list[str]) -> np.ndarray:
    """(B, 4, 4) of the bones in the world, constraints and drivers included."""
    evaluated = context.scene.objects[name].evaluated_get(context.evaluated_depsgraph_get())
    world = np.array(evaluated.matrix_world)
    pose = evaluated.pose.bones
    return world @ np.array([np.array(pose[bone].matrix) for bone in bones])
