# SPDX-License-Identifier: GPL-3.0-or-later
"""The demonstration's picture and .blend, made as the demonstration makes them."""

import os
import subprocess
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import bpy
import numpy as np
from support import Skipped, expected_performance, library

BINDINGS = Path(__file__).parents[2] / "bindings"
SCRIPT = BINDINGS / "sparse_mocap_demo" / "render_scene.py"
EXAMPLE = BINDINGS / "sparse_mocap_demo" / "example_scene.py"


def _run(script: Path, folder: Path, arguments: list[str]) -> subprocess.CompletedProcess:
    if not bpy.app.binary_path:
        raise Skipped("a bpy module has no command line")
    if not (BINDINGS / "sparse_mocap" / f"_core{EXTENSION_SUFFIXES[0]}").is_file():
        raise Skipped(
            "the sources, which the demonstration runs from, have no core for this Python"
        )
    command = [bpy.app.binary_path, "-b", "--factory-startup", "--python-exit-code", "1"]
    names = ("RESOURCES", "SCRIPTS", "CONFIG")  # nothing is installed there
    own = {f"BLENDER_USER_{name}": str(folder / "user") for name in names}
    return subprocess.run(
        [*command, "--python", script, "--", *arguments],
        env=os.environ | own,
        capture_output=True,
        text=True,
        timeout=200,
    )


def _make(folder: Path, *options: str) -> subprocess.CompletedProcess:
    import sparse_mocap

    reconstructed = folder / "reconstructed.bvh"
    sparse_mocap.write_bvh(reconstructed, expected_performance().motion)
    performed = next(library().motions.iterdir())
    files = {
        "--performed": performed,
        "--reconstructed": reconstructed,
        "--blend": folder / "take.blend",
        "--picture": folder / "figures.png",
    }
    arguments = [str(part) for item in files.items() for part in item]
    return _run(SCRIPT, folder, [*arguments, "--samples", "1", *options])


def test_makes_a_picture_and_a_blend_that_plays(tmp_path):
    done = _make(tmp_path, "--error", "3.2 cm")
    assert done.returncode == 0, done.stdout + done.stderr
    picture = bpy.data.images.load(str(tmp_path / "figures.png"))
    assert tuple(picture.size) == (1800, 800)
    pixels = np.empty(1800 * 800 * 4, dtype=np.float32)
    picture.pixels.foreach_get(pixels)
    red, _, blue, _ = pixels.reshape(-1, 4).T
    assert ((red - blue) > 0.3).mean() > 0.01  # the orange figures
    assert ((blue - red) > 0.1).mean() > 0.01  # the blue ones
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "take.blend"))
    scene, armature = bpy.context.scene, bpy.data.objects["Reconstructed"]
    assert scene.frame_start == 1
    assert scene.frame_end > 20
    body = bpy.data.objects["Reconstructed body"]
    found = []
    for frame in (1, 20):
        scene.frame_set(frame)
        evaluated = body.evaluated_get(bpy.context.evaluated_depsgraph_get())
        found.append(np.array([tuple(vertex.co) for vertex in evaluated.data.vertices]))
    assert np.abs(found[0] - found[1]).max() > 0.05
    assert armature.animation_data.action.use_fake_user


def test_a_missing_file_ends_with_an_error_code(tmp_path):
    done = _make(tmp_path, "--performed", str(tmp_path / "missing.bvh"))
    assert done.returncode == 1
    assert not (tmp_path / "figures.png").exists()


def test_the_example_plays_a_performer_and_a_character(tmp_path):
    done = _run(EXAMPLE, tmp_path, ["--blend", str(tmp_path / "example.blend")])
    assert done.returncode == 0, done.stdout + done.stderr
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "example.blend"))
    assert bpy.data.objects["Simulated Performer"].animation_data.action is not None
    characters = [obj for obj in bpy.data.objects if obj.type == "ARMATURE"]
    assert all(obj.animation_data.action is not None for obj in characters)
    assert len(characters) == 2
