# SPDX-License-Identifier: GPL-3.0-or-later
"""Sensors on the character's body and its feet on the floor, drawn in the viewports."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import bpy
import gpu
import numpy as np
from bpy.types import Context, Object
from mathutils import Vector

from ..session import live
from ..session.certainty import Certainty, certainty_of
from ..session.core import core
from ..session.errors import InputError
from ..session.reconstruct import kept
from ..session.take import takes
from . import compat
from . import live as live_scene
from .armature import is_ours
from .axes import Floats
from .binding import character_of
from .drawing import dashes, lines, points, square
from .figure import figure_names
from .performance import facts_of, performed_action
from .rig_action import CONTACTS
from .settings import settings_of

# Colours that people with any colour vision tell apart (Okabe and Ito 2008); shapes differ too.
_WORN = (0.0, 0.447, 0.698, 1.0)
_SILENT = (0.835, 0.369, 0.0, 1.0)
_STANDING = (0.0, 0.62, 0.451, 1.0)
_RIM = (1.0, 1.0, 1.0, 1.0)
# The colour of an uncertain limb, and its dashes relative to the character's height.
_UNCERTAIN = {
    Certainty.UNSURE: ((0.902, 0.624, 0.0, 1.0), 0.03),
    Certainty.GUESSED: ((0.8, 0.475, 0.655, 1.0), 0.012),
}

# The joint along whose bone a sensor is worn, and how far from that one's beginning.
_CARRIERS = {
    "wrist": ("radius", 1.0),
    "hand": ("wrist", 0.6),
    "upper_arm": ("humerus", 0.6),
    "ankle": ("tibia", 1.0),
    "thigh": ("femur", 0.6),
}
_MIDDLE = {
    "head": ("head", 0.6),
    "chest": ("thorax", 0.3),
    "torso": ("upperback", 0.5),
    "pelvis": ("root", 0.0),
}


@dataclass(frozen=True)
class Mark:
    """A sensor on the body, in the world."""

    site: str
    place: Vector
    is_silent: bool


@dataclass(frozen=True)
class UncertainLimb:
    """A limb whose end may be elsewhere, in the world."""

    joint: str
    head: Vector
    tail: Vector
    certainty: Certainty


@dataclass
class _Shown:
    armature: str
    bones: dict[str, str]  # by standard joint


_shown: _Shown | None = None
_handler: Any = None


def is_shown() -> bool:
    """Whether the overlay is on."""
    return _shown is not None


def show(context: Context, armature: Object) -> None:
    """Draw on this character from now on. Raises InputError when its bones are not a person's."""
    global _shown, _handler
    _shown = _Shown(armature.name, _bones(context, armature))
    if _handler is None and not bpy.app.background:
        _handler = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW")
    compat.redraw_views(context)


def hide() -> None:
    """Draw nothing any more."""
    global _shown, _handler
    _shown = None
    if _handler is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handler, "WINDOW")
        _handler = None


def sensor_marks(context: Context) -> list[Mark]:
    """The sensors of the live session, else of the chosen take, on the character."""
    armature = _armature()
    if armature is None or _shown is None:
        return []
    marks = []
    for site, is_silent in _sensors(context):
        place = _place(armature, _shown.bones, site)
        if place is not None:
            marks.append(Mark(site, place, is_silent))
    return marks


def uncertain_limbs(context: Context) -> list[UncertainLimb]:
    """The limbs of the character that are not sure in this frame, or live."""
    armature = _armature()
    if armature is None or _shown is None:
        return []
    spread = spread_at(context, armature)
    limbs = []
    for joint, deviation_m in zip(core().standard_joint_names(), spread, strict=False):
        certainty = certainty_of(float(deviation_m))
        bone = armature.pose.bones.get(_shown.bones.get(joint, ""))
        if certainty is Certainty.SURE or bone is None:
            continue
        world = armature.matrix_world
        limbs.append(UncertainLimb(joint, world @ bone.head, world @ bone.tail, certainty))
    return limbs


def spread_at(context: Context, armature: Object) -> Floats:
    """(J,) how far retrieved poses deviate in the live pose or in this frame; (0,) if unknown."""
    live_spread = live_scene.spread_m(armature)
    if live_spread is not None:
        return live_spread
    action = performed_action(armature)
    facts = facts_of(action) if action is not None else None
    performance = kept(facts.take) if facts is not None else None
    if facts is None or performance is None:
        return np.empty(0)
    frame = performance.frame_at(facts.time_s(context.scene.frame_current_final))
    return np.empty(0) if frame is None else performance.spread_m[frame]


def standing_feet(context: Context) -> list[Vector]:
    """Where the feet that stand in this frame are on the floor, in the world."""
    armature = _armature()
    if armature is None or _shown is None:
        return []
    floor = settings_of(context.scene).floor
    height = (floor or armature).matrix_world.translation.z
    places = []
    for name, shank in zip(CONTACTS, ("ltibia", "rtibia"), strict=True):
        bone = armature.pose.bones.get(_shown.bones.get(shank, ""))
        if bone is not None and armature.get(name, 0) > 0:
            place = armature.matrix_world @ bone.tail
            places.append(Vector((place.x, place.y, height)))
    return places


def _armature() -> Object | None:
    armature = bpy.data.objects.get(_shown.armature) if _shown is not None else None
    return armature if armature is not None and armature.pose is not None else None


def _bones(context: Context, armature: Object) -> dict[str, str]:
    """The character's bones by standard joint."""
    if not is_ours(armature):
        return character_of(context, armature).joints
    joints = list(core().standard_joint_names())
    names = figure_names(joints) if "thigh.L" in armature.data.bones else joints
    return dict(zip(joints, names, strict=True))


def _sensors(context: Context) -> list[tuple[str, bool]]:
    """Where sensors are worn, and whether no data comes from them."""
    session = live.current()
    if session is not None and session.is_running:
        return [(one["site"], one["state"] != "live") for one in session.state.sensors]
    path = settings_of(context.scene).take
    take = takes.peek(bpy.path.abspath(path)).value if path else None
    return [(site, False) for site in take.sensors] if take is not None else []


def _place(armature: Object, bones: dict[str, str], site: str) -> Vector | None:
    side, _, part = site.partition("_")
    joint, share = _MIDDLE.get(site, ("", 0.0))
    if not joint and side in ("left", "right") and part in _CARRIERS:
        carrier, share = _CARRIERS[part]
        joint = side[0] + carrier
    bone = armature.pose.bones.get(bones.get(joint, ""))
    if bone is None:
        return None
    return armature.matrix_world @ bone.head.lerp(bone.tail, share)


def _draw() -> None:
    context = bpy.context
    if not context.space_data.overlay.show_overlays:
        return
    marks = sensor_marks(context)
    gpu.state.depth_test_set("NONE")
    gpu.state.blend_set("ALPHA")
    size = 12.0 * context.preferences.system.ui_scale
    armature = _armature()
    if armature is not None:
        height = max(armature.dimensions.z, 1e-6)
        for limb in uncertain_limbs(context):
            colour, dash = _UNCERTAIN[limb.certainty]
            lines(dashes(limb.head, limb.tail, dash * height), colour, 5.0)
        for place in standing_feet(context):
            lines(square(place, 0.06 * height), _STANDING, 3.0)
    points([mark.place for mark in marks], _RIM, size + 4.0)
    points([mark.place for mark in marks if not mark.is_silent], _WORN, size)
    points([mark.place for mark in marks if mark.is_silent], _SILENT, 0.5 * size)
    gpu.state.blend_set("NONE")


def toggle(context: Context, armature: Object | None) -> bool:
    """Switch the overlay; returns whether it is on. Raises InputError without a character."""
    if _shown is not None:
        hide()
        compat.redraw_views(context)
        return False
    if armature is None or armature.type != "ARMATURE":
        raise InputError("Select a character first")
    show(context, armature)
    return True
