# SPDX-License-Identifier: GPL-3.0-or-later
"""One pose after another on a character's controls, in each one's rotation mode."""

from __future__ import annotations

from typing import Any

from bpy.types import Object
from mathutils import Quaternion

from ..session.character import FootLock
from ..session.live_feet import LiveFootLock
from ..session.live_poses import Pose
from ..session.retarget import Target, tracks_of
from .rig_probe import set_properties


class RigPose:
    """Shows poses of the standard skeleton on a character as they come."""

    def __init__(self, target: Target) -> None:
        self.target = target
        self.bones = target.bones
        self._feet = LiveFootLock(target.character)
        self._lowest_m: float | None = None  # that an ankle was, above where it stands

    def begin(self, armature: Object) -> None:
        """Set the custom properties that the controls need."""
        set_properties(armature, self.target.controls.properties)

    def show(self, armature: Object, motion: Any, pose: Pose, lock: FootLock) -> None:
        """Show a motion of one frame, that of the pose; the lowest foot so far is on the floor."""
        character = self.target.character
        on_rig = character.on_rig(motion)
        moved, legs = character.world_and_legs(on_rig)
        above = float(moved.above_floor_m[0])
        self._lowest_m = above if self._lowest_m is None else min(self._lowest_m, above)
        if lock.strength > 0.0 and character.has_feet:
            floor_m = character.ankle_m + self._lowest_m
            moved = self._feet.shown(moved, legs[0], pose.contacts, pose.time_s, lock, floor_m)
        for track in tracks_of(
            self.target.controls, moved.lifted(self.target.floor_m - self._lowest_m)
        ):
            bone = armature.pose.bones[track.bone]
            if track.quaternions is not None:
                turned = Quaternion(track.quaternions[0])
                if bone.rotation_mode == "QUATERNION":
                    bone.rotation_quaternion = turned
                elif bone.rotation_mode == "AXIS_ANGLE":
                    axis, angle = turned.to_axis_angle()
                    bone.rotation_axis_angle = (angle, *axis)
                else:
                    bone.rotation_euler = turned.to_euler(bone.rotation_mode, bone.rotation_euler)
            if track.location is not None:
                bone.location = track.location[0]
