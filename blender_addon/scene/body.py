# SPDX-License-Identifier: GPL-3.0-or-later
"""A simple body of one capsule a bone, for previews of the add-on's own figure and of Rigify's."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from bpy.types import Bone, Context, Material, Object

from ..session.errors import InputError
from .axes import Floats
from .control_bones import is_rigify

# Radii of a bone's beginning and end, metres, on a figure of average height.
_RADII = {
    "spine": (0.105, 0.105),
    "spine.001": (0.105, 0.125),
    "chest": (0.130, 0.100),
    "neck": (0.060, 0.050),
    "neck.001": (0.050, 0.050),
    "head": (0.085, 0.095),
    "hip": (0.095, 0.085),
    "thigh": (0.085, 0.055),
    "shin": (0.055, 0.040),
    "foot": (0.040, 0.027),
    "toe": (0.027, 0.022),
    "shoulder": (0.080, 0.062),
    "upper_arm": (0.058, 0.042),
    "forearm": (0.042, 0.032),
    "wrist": (0.034, 0.030),
    "hand": (0.034, 0.022),
}
# Rigify's bones of the trunk from bottom to top; its limbs are named like those above.
_RIGIFY_SPINE = {
    "spine": (0.110, 0.105),
    "spine.001": (0.105, 0.115),
    "spine.002": (0.115, 0.130),
    "spine.003": (0.130, 0.085),
    "spine.004": (0.060, 0.055),
    "spine.005": (0.055, 0.055),
    "spine.006": (0.085, 0.095),
}
_RIGIFY_DEFORMS, _RIGIFY_HALF = "DEF-", ".001"  # the further half of a limb's bone
_RIGIFY_WITHOUT_BODY = ("DEF-pelvis", "DEF-breast")
_OTHER_RADII = (0.04, 0.035)
_USUAL_LEG_M = 0.85


def new_body(context: Context, armature: Object, material: Material | None = None) -> Object:
    """A mesh of one capsule a bone that the armature moves. Raises InputError without bones."""
    vertices: list[Floats] = []
    faces: list[tuple[int, ...]] = []
    groups: dict[str, range] = {}
    scale = _size(armature)
    for bone in _bones(armature):
        head, tail = np.array(bone.head_local), np.array(bone.tail_local)
        radii = _radii(bone.name, armature.data.bones)
        points, quads = _capsule(head, tail, *(scale * radius for radius in radii))
        begin = sum(len(part) for part in vertices)
        faces += [tuple(index + begin for index in quad) for quad in quads]
        vertices.append(points)
        groups[bone.name] = range(begin, begin + len(points))
    if not vertices:
        raise InputError(f'"{armature.name}" has no bones to draw a body around')
    name = f"{armature.name} body"
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.concatenate(vertices).tolist(), [], faces)
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    if material is not None:
        mesh.materials.append(material)
    body = bpy.data.objects.new(name, mesh)
    for collection in armature.users_collection or (context.scene.collection,):
        collection.objects.link(body)
    for bone, indices in groups.items():
        body.vertex_groups.new(name=bone).add(list(indices), 1.0, "REPLACE")
    body.modifiers.new("Armature", "ARMATURE").object = armature
    body.parent = armature
    return body


def _bones(armature: Object) -> list[Bone]:
    """The bones that get a capsule."""
    bones = armature.data.bones
    if is_rigify(armature):
        deforming = [bone for bone in bones if bone.name.startswith(_RIGIFY_DEFORMS)]
        return [bone for bone in deforming if not bone.name.startswith(_RIGIFY_WITHOUT_BODY)]
    return [bone for bone in bones if bone.parent is not None and bone.length > 0.0]


def _size(armature: Object) -> float:
    """Units of the armature for a metre on a figure of average height."""
    bones = armature.data.bones
    for prefix in ("", "ORG-"):
        thigh, shin = bones.get(f"{prefix}thigh.L"), bones.get(f"{prefix}shin.L")
        if thigh is not None and shin is not None:
            return float(thigh.length + shin.length) / _USUAL_LEG_M
    return 1.0


def _radii(name: str, bones: Any) -> tuple[float, float]:
    """The radii of a bone, the same on both sides."""
    if not name.startswith(_RIGIFY_DEFORMS):
        known = _RADII.get(name) or _RADII.get(name.removesuffix(".L").removesuffix(".R"))
        return known or _OTHER_RADII
    own = name.removeprefix(_RIGIFY_DEFORMS)
    if own in _RIGIFY_SPINE:
        return _RIGIFY_SPINE[own]
    whole = own.removesuffix(_RIGIFY_HALF)
    begin, end = _RADII.get(whole.removesuffix(".L").removesuffix(".R"), _OTHER_RADII)
    middle = 0.5 * (begin + end)
    if own != whole:
        return middle, end
    return (begin, middle) if f"{name}{_RIGIFY_HALF}" in bones else (begin, end)


def _capsule(
    head: Floats, tail: Floats, head_radius: float, tail_radius: float
) -> tuple[Floats, list[tuple[int, ...]]]:
    """Vertices and quads of a tapered rod with round ends."""
    segments, half_rings = 20, 6
    along = (tail - head) / np.linalg.norm(tail - head)
    aside = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    aside /= np.linalg.norm(aside)
    third = np.cross(along, aside)
    rise = np.linspace(-0.499 * np.pi, 0.0, half_rings)
    centres = [head] * half_rings + [tail] * half_rings
    sizes = [head_radius] * half_rings + [tail_radius] * half_rings
    turns = np.linspace(0.0, 2.0 * np.pi, segments, endpoint=False)
    circle = np.cos(turns)[:, None] * aside + np.sin(turns)[:, None] * third
    rings = [
        centre + size * (np.sin(angle) * along + np.cos(angle) * circle)
        for centre, size, angle in zip(
            centres, sizes, np.concatenate([rise, -rise[::-1]]), strict=True
        )
    ]
    quads: list[tuple[int, ...]] = [
        (ring + i, ring + j, ring + segments + j, ring + segments + i)
        for ring in range(0, (len(rings) - 1) * segments, segments)
        for i, j in zip(range(segments), [*range(1, segments), 0], strict=True)
    ]
    return np.concatenate(rings), quads
