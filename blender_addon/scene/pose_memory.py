# SPDX-License-Identifier: GPL-3.0-or-later
"""A rig's pose and action, taken off for a while and put back."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import bpy
from bpy.types import Object, PoseBone

from .compat import assign_action


@dataclass
class PoseMemory:
    """A rig's pose, custom properties and action, by name: no reference is kept."""

    armature: str
    channels: dict[str, tuple[Any, ...]] = field(default_factory=dict)
    properties: dict[str, dict[str, Any]] = field(default_factory=dict)
    action: str = ""
    slot: str = ""
    had_fake_user: bool = True
    use_nla: bool | None = None

    @classmethod
    def of(cls, armature: Object) -> PoseMemory:
        """What the armature has now."""
        memory = cls(armature.name)
        for bone in armature.pose.bones:
            memory.channels[bone.name] = _channels(bone)
            kept = {key: value for key, value in bone.items() if isinstance(value, int | float)}
            if kept:
                memory.properties[bone.name] = kept
        data = armature.animation_data
        if data is not None:
            memory.use_nla = data.use_nla
            if data.action is not None:
                memory.action = data.action.name
                memory.had_fake_user = data.action.use_fake_user
                slot = getattr(data, "action_slot", None)
                memory.slot = slot.identifier if slot is not None else ""
        return memory

    def take_off(self) -> None:
        """Take the action and the NLA off the armature; the action stays in the file."""
        armature = bpy.data.objects.get(self.armature)
        data = armature.animation_data if armature is not None else None
        if data is None:
            return
        if data.action is not None:
            if data.action.library is None:
                data.action.use_fake_user = True  # so that a file saved now keeps it
            data.action = None
        data.use_nla = False

    def put_back(self) -> None:
        """Give the armature what it had, as far as its bones and the action are still there."""
        armature = bpy.data.objects.get(self.armature)
        if armature is None or armature.pose is None:
            return
        for name, values in self.channels.items():
            bone = armature.pose.bones.get(name)
            if bone is not None:
                _set_channels(bone, values)
        for name, kept in self.properties.items():
            bone = armature.pose.bones.get(name)
            for key, value in kept.items() if bone is not None else ():
                if key in bone and bone[key] != value:
                    bone[key] = value
        self.put_action_back()
        armature.update_tag()

    def put_action_back(self) -> None:
        """Give the armature its action and NLA."""
        armature = bpy.data.objects.get(self.armature)
        data = armature.animation_data if armature is not None else None
        if armature is None or data is None:
            return
        if self.use_nla is not None:
            data.use_nla = self.use_nla
        action = bpy.data.actions.get(self.action)
        if action is None or data.action is not None:
            return
        if action.library is None:
            action.use_fake_user = self.had_fake_user
        assign_action(armature, action)
        if self.slot:
            for slot in action.slots:
                if slot.identifier == self.slot:
                    data.action_slot = slot


@contextmanager
def pose_kept(armature: Object) -> Iterator[None]:
    """Put pose and action back afterwards."""
    memory = PoseMemory.of(armature)
    memory.take_off()
    try:
        yield
    finally:
        memory.put_back()


def _channels(bone: PoseBone) -> tuple[Any, ...]:
    return (
        bone.rotation_mode,
        tuple(bone.location),
        tuple(bone.rotation_quaternion),
        tuple(bone.rotation_euler),
        tuple(bone.rotation_axis_angle),
        tuple(bone.scale),
    )


def _set_channels(bone: PoseBone, values: tuple[Any, ...]) -> None:
    mode, location, quaternion, euler, axis_angle, scale = values
    bone.rotation_mode = mode
    bone.location, bone.scale = location, scale
    bone.rotation_quaternion, bone.rotation_euler = quaternion, euler
    bone.rotation_axis_angle = axis_angle
