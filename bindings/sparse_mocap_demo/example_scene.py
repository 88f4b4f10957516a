# SPDX-License-Identifier: GPL-3.0-or-later
"""What *Try It* makes, as an example: a .blend to open, and pictures of it for a clip.

blender -b --factory-startup --python-exit-code 1 --python example_scene.py -- \
    --blend example.blend [--frames DIR]

Works in Blender 3.4 and later; the pictures need a display. The add-on and, unless it is importable
already, the package are taken from the repository that this file lies in.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import bpy
from mathutils import Vector

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
sys.path.append(str(Path(__file__).resolve().parents[1]))

import blender_addon

PICTURE_SIZE = (480, 300)
PICTURES_HZ = 8.0
FIRST_FRAME, LAST_FRAME = 96, 300  # a squat, jumping jacks and a kick


def main() -> None:
    """Make the .blend and, if wanted, the pictures."""
    options = arguments()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    blender_addon.register()
    bpy.context.scene.sparse_mocap.folder = str(options.blend.resolve().parent)
    if bpy.ops.sparse_mocap.try_it() != {"FINISHED"}:
        raise SystemExit("Try It did not finish")
    bpy.ops.wm.save_as_mainfile(filepath=str(options.blend.resolve()), compress=True)
    if options.frames is not None:
        render(options.frames)


def arguments() -> argparse.Namespace:
    """What stands behind the -- of Blender's command line."""
    parser = argparse.ArgumentParser(prog="example_scene.py")
    parser.add_argument("--blend", type=Path, required=True)
    parser.add_argument("--frames", type=Path, help="a folder for pictures of the performance")
    given = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    return parser.parse_args(given)


def render(folder: Path) -> None:
    """Pictures by the Workbench engine, from the front."""
    scene = bpy.context.scene
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.display.shading.light, scene.display.shading.color_type = "STUDIO", "MATERIAL"
    scene.display.shading.show_shadows = True
    scene.render.resolution_x, scene.render.resolution_y = PICTURE_SIZE
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.world = scene.world or bpy.data.worlds.new("World")
    scene.world.color = (0.35, 0.35, 0.36)
    add_floor()
    place_camera()
    step = round(scene.render.fps / scene.render.fps_base / PICTURES_HZ)
    for number, frame in enumerate(range(FIRST_FRAME, LAST_FRAME, step)):
        scene.frame_set(frame)
        scene.render.filepath = str((folder / f"{number:04d}.png").resolve())
        bpy.ops.render.render(write_still=True)


def add_floor() -> None:
    """A light square to stand on."""
    size = 30.0
    mesh = bpy.data.meshes.new("Floor")
    corners = [(-size, -size, 0.0), (size, -size, 0.0), (size, size, 0.0), (-size, size, 0.0)]
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    material = bpy.data.materials.new("Floor")
    material.diffuse_color = (0.6, 0.6, 0.6, 1.0)
    mesh.materials.append(material)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("Floor", mesh))


def place_camera() -> None:
    """At the side of both figures, where they are in the middle of the pictures."""
    scene = bpy.context.scene
    scene.frame_set((FIRST_FRAME + LAST_FRAME) // 2)
    places, fronts = [], []
    for armature in (obj for obj in scene.objects if obj.type == "ARMATURE"):
        bones = armature.pose.bones
        prefix = "DEF-" if "DEF-thigh.L" in bones else ""
        left, right = (armature.matrix_world @ bones[f"{prefix}thigh.{s}"].head for s in "LR")
        places.append((left + right) / 2.0)
        fronts.append((left - right).cross(Vector((0.0, 0.0, 1.0))))
    middle = sum(places, Vector()) / len(places)
    front = sum(fronts, Vector()).normalized()
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    side = front.cross(Vector((0.0, 0.0, 1.0)))
    direction = (0.8 * front + side + Vector((0.0, 0.0, 0.35))).normalized()
    camera.location = middle - Vector((0.0, 0.0, 0.1)) + 6.5 * direction
    camera.rotation_euler = direction.to_track_quat("Z", "Y").to_euler()


if __name__ == "__main__":
    main()
