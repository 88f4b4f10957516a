# SPDX-License-Identifier: GPL-3.0-or-later
"""The performance and its reconstruction as two figures: a .blend to play and one picture.

blender -b --factory-startup --python-exit-code 1 --python render_scene.py -- \
    --performed A.bvh --reconstructed B.bvh --blend take.blend --picture figures.png

Works in Blender 3.4 and later, without a display. The add-on and, unless it is importable already,
the package are taken from the repository that this file lies in.
"""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from bpy.types import Material, Mesh, Object
from mathutils import Matrix, Vector

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
sys.path.append(str(Path(__file__).resolve().parents[1]))

import sparse_mocap

from blender_addon.scene.action import frames_of, make_action
from blender_addon.scene.armature import new_armature
from blender_addon.scene.body import new_body
from blender_addon.scene.compat import assign_action

NUM_MOMENTS = 6
PICTURE_SIZE = (1800, 800)

PERFORMED_COLOUR = (0.16, 0.27, 0.42)
RECONSTRUCTED_COLOUR = (0.85, 0.27, 0.03)
INK = (0.09, 0.09, 0.10)

# The picture, in metres: an orthographic camera looks down on two rows, the performed one behind.
TILT = math.radians(18.0)
COLUMN = 1.62
ROW = 7.0
WIDTH = 11.3
TURN = math.radians(25.0)  # figures are seen a little from the side


@dataclass(frozen=True)
class Figure:
    """An armature with a body that it moves."""

    armature: Object
    body: Object
    duration_s: float


def main() -> None:
    """Make the .blend and the picture."""
    options = arguments()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    performed = figure("Performed", options.performed, PERFORMED_COLOUR)
    reconstructed = figure("Reconstructed", options.reconstructed, RECONSTRUCTED_COLOUR)
    build_stage()
    save_blend(options.blend, [performed, reconstructed])
    lay_out_moments(performed, reconstructed, options.error)
    render(options.picture, options.samples)


def arguments() -> argparse.Namespace:
    """What stands behind the -- of Blender's command line."""
    parser = argparse.ArgumentParser(prog="render_scene.py")
    for name in ("performed", "reconstructed", "blend", "picture"):
        parser.add_argument(f"--{name}", type=Path, required=True)
    parser.add_argument(
        "--error", nargs="*", default=[], help="one text for each moment, or one for the whole take"
    )
    parser.add_argument("--samples", type=int, default=24, help="light paths a pixel")
    given = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    return parser.parse_args(given)


# --- Figures -------------------------------------------------------------------------------------


def figure(name: str, path: Path, colour: tuple[float, float, float]) -> Figure:
    """The motion of the file as an armature with its action and a body of that colour."""
    motion, _ = sparse_mocap.read_motion(path)
    motion, _ = sparse_mocap.standard_motion(motion)  # both figures are built alike
    rig = new_armature(bpy.context, motion.skeleton, name)
    armature = rig.armature
    armature.show_in_front = False
    times_s = np.arange(motion.num_frames) * motion.frame_time_s
    frames = frames_of(bpy.context.scene, times_s, 1.0)
    assign_action(armature, make_action(name, rig, motion, frames))
    body = new_body(bpy.context, armature, plain_material(name, colour))
    return Figure(armature, body, times_s[-1])


# --- The stage -----------------------------------------------------------------------------------


def add(name: str, data: bpy.types.ID | None) -> Object:
    """A new object of the data in the scene."""
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def plain_material(name: str, colour: tuple[float, float, float]) -> Material:
    """A matt material, shown in the same colour in the solid viewport."""
    material = bpy.data.materials.new(name)
    material.diffuse_color = (*colour, 1.0)
    material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (*colour, 1.0)
    shader.inputs["Roughness"].default_value = 0.6
    return material


def build_stage() -> None:
    """A light floor, a sun, and light from all around."""
    floor = bpy.data.meshes.new("Floor")
    size = 60.0
    corners = [(-size, -size, 0), (size, -size, 0), (size, size, 0), (-size, size, 0)]
    floor.from_pydata(corners, [], [(0, 1, 2, 3)])
    floor.materials.append(plain_material("Floor", (0.80, 0.80, 0.79)))
    add("Floor", floor)
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.energy, sun.angle = 2.0, math.radians(8.0)
    add("Sun", sun).rotation_euler = (math.radians(42.0), math.radians(-22.0), 0.0)
    world = bpy.data.worlds.new("Surroundings")
    bpy.context.scene.world = world
    world.use_nodes = True
    sky = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    sky.inputs["Color"].default_value = (0.95, 0.97, 1.0, 1.0)
    sky.inputs["Strength"].default_value = 0.45


def save_blend(path: Path, figures: list[Figure]) -> None:
    """The two figures side by side, ready to be played."""
    scene = bpy.context.scene
    rate = scene.render.fps / scene.render.fps_base
    scene.frame_start = 1
    scene.frame_end = math.ceil(1 + rate * max(shown.duration_s for shown in figures))
    for shown, x in zip(figures, (-0.7, 0.7), strict=True):
        show_at(1.0)
        placed = placement(shown, Vector((x, 0.0, 0.0)), 0.0)
        shown.armature.matrix_world = placed @ shown.armature.matrix_world
        shown.armature.hide_render = True
    scene.camera = add("Camera", bpy.data.cameras.new("Camera"))
    follow_from_afar(scene.camera, figures)
    scene.view_settings.view_transform = "Standard"
    show_at(1.0)
    bpy.ops.wm.save_as_mainfile(filepath=str(path.resolve()))


def follow_from_afar(camera: Object, figures: list[Figure]) -> None:
    """Put the camera where it sees all the ground that the figures cover."""
    scene = bpy.context.scene
    roots = []
    for frame in np.linspace(scene.frame_start, scene.frame_end, 60):
        show_at(float(frame))
        roots += [
            shown.armature.matrix_world @ shown.armature.pose.bones[0].head for shown in figures
        ]
    lowest, highest = np.min(roots, axis=0), np.max(roots, axis=0)
    middle = Vector((lowest + highest) / 2.0)
    distance = 3.0 + 1.2 * float(np.linalg.norm((highest - lowest)[:2]))
    direction = Vector((0.35, -1.0, 0.30)).normalized()
    camera.location = middle + distance * direction
    camera.rotation_euler = direction.to_track_quat("Z", "Y").to_euler()


def show_at(frame: float) -> None:
    """Set the scene to a frame, fractional or not."""
    whole = math.floor(frame)
    bpy.context.scene.frame_set(whole, subframe=frame - whole)


def placement(shown: Figure, place: Vector, turn: float) -> Matrix:
    """What moves the figure, as it stands in this frame, to the place, turned from the front."""
    evaluated = shown.armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    bones, world = evaluated.pose.bones, evaluated.matrix_world
    root = world @ bones[0].head
    to_left = (world @ bones["hip.L"].tail) - (world @ bones["hip.R"].tail)
    heading = math.atan2(to_left.y, to_left.x)
    return (
        Matrix.Translation(place)
        @ Matrix.Rotation(turn - heading, 4, "Z")
        @ Matrix.Translation((-root.x, -root.y, 0.0))
    )


# --- The picture ---------------------------------------------------------------------------------


def lay_out_moments(performed: Figure, reconstructed: Figure, errors: list[str]) -> None:
    """Copies of both figures at moments from the take, with what they show written beside."""
    scene = bpy.context.scene
    rate = scene.render.fps / scene.render.fps_base
    duration_s = min(performed.duration_s, reconstructed.duration_s)
    times_s = (np.arange(NUM_MOMENTS) + 0.5) / NUM_MOMENTS * duration_s
    for column, time_s in enumerate(times_s):
        x = (column - (NUM_MOMENTS - 1) / 2) * COLUMN
        show_at(1.0 + time_s * rate)
        for shown, y in ((performed, ROW), (reconstructed, 0.0)):
            add_copy(shown, placement(shown, Vector((x, y, 0.0)), TURN))
        write(f"{time_s:.1f} s", x, -1.35, 0.21, INK)
        if len(errors) == NUM_MOMENTS:
            write(errors[column], x, -2.25, 0.17, RECONSTRUCTED_COLOUR)
    left = -(NUM_MOMENTS / 2 + 0.9) * COLUMN
    write("Performed", left, ROW + 2.6, 0.27, PERFORMED_COLOUR, align="LEFT")
    write("Reconstructed", left, 2.6, 0.27, RECONSTRUCTED_COLOUR, align="LEFT")
    if errors:
        said = errors[0] if len(errors) != NUM_MOMENTS else "Error"
        y = 1.5 if len(errors) != NUM_MOMENTS else -2.25
        write(said, left, y, 0.17, RECONSTRUCTED_COLOUR, align="LEFT")
    for shown in (performed, reconstructed):
        shown.body.hide_render = True
    aim_camera(left)


def add_copy(shown: Figure, moved: Matrix) -> None:
    """The figure's body as it is in this frame, standing still, moved."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = shown.body.evaluated_get(depsgraph)
    mesh: Mesh = bpy.data.meshes.new_from_object(evaluated, depsgraph=depsgraph)
    add(f"{shown.body.name} then", mesh).matrix_world = moved @ evaluated.matrix_world


def write(
    text: str,
    x: float,
    y: float,
    size: float,
    colour: tuple[float, float, float],
    align: str = "CENTER",
) -> None:
    """Text that stands on the floor and faces the camera."""
    curve = bpy.data.curves.new("Text", "FONT")
    curve.body, curve.size, curve.align_x = text, size, align
    curve.offset = 0.02 * size  # a little bolder than the font is
    curve.materials.append(glowing_material(colour))
    written = add("Text", curve)
    written.location = (x, y, 0.02)
    written.rotation_euler = (math.pi / 2 - TILT, 0.0, 0.0)
    if hasattr(written, "visible_shadow"):
        written.visible_shadow = False


def glowing_material(colour: tuple[float, float, float]) -> Material:
    """A material of that very colour, whatever the light."""
    name = f"Ink {colour}"
    material = bpy.data.materials.get(name)
    if material is None:
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        nodes = material.node_tree.nodes
        nodes.clear()
        emission, output = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeOutputMaterial")
        emission.inputs["Color"].default_value = (*colour, 1.0)
        material.node_tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material


def aim_camera(left: float) -> None:
    """An orthographic view of both rows and the text at their left."""
    scene = bpy.context.scene
    camera = scene.camera
    camera.data.type, camera.data.ortho_scale = "ORTHO", WIDTH
    camera.data.clip_end = 200.0
    camera.rotation_euler = (math.pi / 2 - TILT, 0.0, 0.0)
    middle = Vector((left + WIDTH / 2 - 0.2, ROW / 2, 0.62))
    camera.location = middle - 40.0 * Vector((0.0, math.cos(TILT), -math.sin(TILT)))


def render(path: Path, samples: int) -> None:
    """Render with Cycles on the CPU: it needs no display."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False  # some builds have no denoiser
    scene.cycles.max_bounces = 2
    scene.render.resolution_x, scene.render.resolution_y = PICTURE_SIZE
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(path.resolve())
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main()
