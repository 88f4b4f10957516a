# SPDX-License-Identifier: GPL-3.0-or-later
"""A simple body of one capsule a bone, for previews of the add-on's own figure."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.types import Context, Material, Object

from ..session.errors import InputError
from .axes import Floats

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
    "foot": (0.040, 0.030),
    "toe": (0.030, 0.022),
    "shoulder": (0.080, 0.062),
    "upper_arm": (0.058, 0.042),
    "forearm": (0.042, 0.032),
    "wrist": (0.034, 0.030),
    "hand": (0.034, 0.022),
}
_OTHER_RADII = (0.04, 0.035)
_USUAL_LEG_M = 0.85


def new_body(context: Context, armature: Object, material: Material | None = None) -> Object:
    """A mesh of one capsule a bone that the armature moves. Raises InputError without bones."""
    vertices: list[Floats] = []
    faces: list[tuple[int, ...]] = []
    groups: dict[str, range] = {}
    scale = _size(armature)
    for bone in armature.data.bones:
        if bone.parent is None or bone.length == 0.0:
            continue
        head, tail = np.array(bone.head_local), np.array(bone.tail_local)
        points, quads = _capsule(head, tail, *(scale * radius for radius in _radii(bone.name)))
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


def _size(armature: Object) -> float:
    """Units of the armature for a metre on a figure of average height."""
    bones = armature.data.bones
    if "thigh.L" not in bones or "shin.L" not in bones:
        return 1.0
    return float(bones["thigh.L"].length + bones["shin.L"].length) / _USUAL_LEG_M


def _radii(bone: str) -> tuple[float, float]:
    """The radii of a bone, the same on both sides."""
    return _RADII.get(bone) or _RADII.get(bone.removesuffix(".L").removesuffix(".R"), _OTHER_RADII)


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
