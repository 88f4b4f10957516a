# SPDX-License-Identifier: GPL-3.0-or-later
"""A take on a character as an action: keys of its controls alone, in each one's rotation mode."""

from __future__ import annotations

from contextlib import suppress

import bpy
import numpy as np
from bpy.types import Action, Object
from mathutils import Euler, Quaternion

from ..session.errors import InputError
from ..session.retarget import RigTake
from ..session.steps import Steps, part
from .action import EULER, LOCATION, ROTATION, Reduction, kept_steps, set_keys
from .axes import Floats
from .compat import Curves, curves_for

CONTACTS = ("left_foot_on_floor", "right_foot_on_floor")
"""Custom properties of a character: 1 while the foot stands."""

_CHUNK = 2000  # keys that are converted between two redraws


def rig_action_steps(
    name: str,
    armature: Object,
    take: RigTake,
    frames: Floats,
    reduction: Reduction | None = None,
) -> Steps[Action]:
    """A new action for the armature, made step by step; yields the fraction done.

    What the armature's own action does with other bones and properties is copied. Raises
    InputError when a bone is gone; nothing is left behind then, nor when the steps are closed.
    """
    missing = [name for name in take.target.bones if name not in armature.pose.bones]
    if missing:
        raise InputError(f'"{armature.name}" has no bone "{missing[0]}" any more: bake again')
    action, curves = _action_for(name, armature, take)
    try:
        action.use_fake_user = True
        for path, value in take.target.controls.properties.items():
            set_keys(
                curves.new(path, -1, _bone_in(path)), frames[:1], np.array([value]), "CONSTANT"
            )
        _set_contacts(armature, curves, take, frames)
        for number, track in enumerate(take.tracks):
            mode = armature.pose.bones[track.bone].rotation_mode
            begin, share = number / len(take.tracks), 1.0 / len(take.tracks)
            values: dict[str, Floats] = {}
            if track.location is not None:
                values[LOCATION] = track.location
            if track.quaternions is not None:
                steps = _in_mode_steps(track.quaternions, mode)
                values[_rotation_path(mode)] = yield from part(steps, begin, 0.5 * share)
            for what, columns in values.items():
                path = f'pose.bones["{bpy.utils.escape_identifier(track.bone)}"].{what}'
                choosing = kept_steps(reduction, what, frames, columns)
                kept = yield from part(choosing, begin + 0.5 * share, 0.0)
                for index, column in enumerate(columns.T):
                    action.name  # noqa: B018 - raises ReferenceError after an undo
                    set_keys(curves.new(path, index, track.bone), frames[kept], column[kept])
                    yield begin + share * (0.5 + 0.5 * (index + 1) / len(columns.T))
    except BaseException:
        with suppress(ReferenceError):
            bpy.data.actions.remove(action)
        raise
    return action


def _set_contacts(armature: Object, curves: Curves, take: RigTake, frames: Floats) -> None:
    """Keys where a foot is put on the floor or lifted, of a custom property of the armature."""
    for name, stands in zip(CONTACTS, take.stands.T, strict=True):
        path = f'["{name}"]'
        for curve in curves.all():
            if curve.data_path == path:
                curves.remove(curve)
        if not stands.any():
            continue
        armature[name] = int(stands[0])
        changes = np.flatnonzero(np.diff(stands.astype(int), prepend=-1))
        values = stands[changes].astype(np.float64)
        set_keys(curves.new(path, -1, "Contacts"), frames[changes], values, "CONSTANT")


def _action_for(name: str, armature: Object, take: RigTake) -> tuple[Action, Curves]:
    """A new action, with the curves of the armature's own one that the take leaves alone."""
    data = armature.animation_data
    old = data.action if data is not None else None
    properties = {*take.target.controls.properties, *take.target.others}
    mapped = [control.name for control in take.target.controls.controls]
    keyed = {
        f'pose.bones["{bpy.utils.escape_identifier(name)}"]'
        for name in (*take.target.bones, *mapped, *take.target.others)
    }
    if old is not None:
        action = old.copy()
        curves = curves_for(action, getattr(data, "action_slot", None))
        others = [curve for curve in curves.all() if not _is_keyed(curve.data_path, keyed)]
        if others:
            if old.name != name:  # otherwise Blender would rename the old one
                action.name = name
            for curve in curves.all():
                if _is_keyed(curve.data_path, keyed) or curve.data_path in properties:
                    curves.remove(curve)
            return action, curves
        bpy.data.actions.remove(action)
    action = bpy.data.actions.new(name)
    return action, curves_for(action, None)


def _is_keyed(path: str, keyed: set[str]) -> bool:
    """Whether a curve turns or moves one of these bones."""
    bone, _, what = path.rpartition(".")
    return bone in keyed and (what.startswith("rotation_") or what == LOCATION)


def _bone_in(path: str) -> str:
    return path.split('"')[1]


def _rotation_path(mode: str) -> str:
    return {"QUATERNION": ROTATION, "AXIS_ANGLE": "rotation_axis_angle"}.get(mode, EULER)


def _in_mode_steps(quaternions: Floats, mode: str) -> Steps[Floats]:
    """(T, 3 or 4) rotations in a bone's rotation mode, without jumps."""
    if mode == "QUATERNION":
        return quaternions
    rows: list[tuple[float, ...]] = []
    last: Euler | None = None
    for number, values in enumerate(quaternions):
        turned = Quaternion(values)
        if mode == "AXIS_ANGLE":
            axis, angle = turned.to_axis_angle()
            if rows and axis.dot(rows[-1][1:]) < 0.0:
                axis, angle = -axis, -angle
            rows.append((angle, *axis))
        else:
            last = turned.to_euler(mode, last) if last is not None else turned.to_euler(mode)
            rows.append(tuple(last))
        if number % _CHUNK == _CHUNK - 1:
            yield number / len(quaternions)
    return np.array(rows)
