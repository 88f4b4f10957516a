# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests share: a fresh Blender, a small database and a take."""

from __future__ import annotations

import atexit
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import bpy
import installed
import numpy as np
from real_data import NOT_SET, real_data_folder

SITES = ["left_wrist", "right_wrist", "left_ankle", "right_ankle"]


class Skipped(Exception):
    """The test cannot run here; str() says why."""


def real_data() -> Path:
    """The folder of recorded motions and sensors. Raises Skipped where it is not at hand."""
    folder = real_data_folder()
    if folder is None:
        raise Skipped(NOT_SET)
    return folder


def no_such_file() -> str:
    """What this system says of a file that is not there."""
    try:
        Path("no such file").stat()
    except OSError as error:
        return error.strerror
    raise AssertionError


@dataclass(frozen=True)
class Library:
    """Files on disk that the tests read."""

    motions: Path  # a folder of four .bvh files
    database: Path  # built from them
    take: Path  # 4 sensors at 100 Hz on one of the motions
    num_files: int


@cache
def library() -> Library:
    import sparse_mocap
    from sparse_mocap.demo_motions import generate_library

    folder = Path(tempfile.mkdtemp(prefix="sparse_mocap_tests_"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    files = generate_library(folder / "all")
    motions = folder / "motions"
    motions.mkdir()
    chosen = files[::40]
    for path in chosen:
        shutil.copy(path, motions)
    database = folder / "small.smdb"
    sparse_mocap.build_database([motions], database)
    motion, _ = sparse_mocap.standard_motion(sparse_mocap.read_motion(files[1])[0])
    take = folder / "first_walk.csv"
    sparse_mocap.write_take(take, sparse_mocap.simulated(motion, SITES, 100.0))
    return Library(motions, database, take, len(chosen))


@contextmanager
def fresh_blender() -> Iterator[None]:
    """An empty scene with the add-on registered."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    installed.register()
    try:
        yield
    finally:
        if is_registered():
            installed.unregister()


def is_registered() -> bool:
    return hasattr(bpy.types.Scene, "sparse_mocap")


def addon(name: str):
    """A module of the add-on as it is registered now."""
    return installed.module(name)


def settings():
    return bpy.context.scene.sparse_mocap


def choose_files() -> None:
    """Steps 1 and 2."""
    settings().database = str(library().database)
    bpy.ops.sparse_mocap.load_take(filepath=str(library().take))


def reconstruct(*, offline: bool = False, **options) -> bpy.types.Object:
    """Step 3, in live quality, which is the faster one; returns the armature."""
    assert bpy.ops.sparse_mocap.reconstruct(offline=offline, **options) == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def expected_performance(*, offline: bool = False):
    """What the core makes of the take."""
    database = addon("session.database").databases.get(str(library().database))
    take = addon("session.take").takes.get(str(library().take))
    return addon("session.reconstruct").reconstruct(
        database,
        take,
        choice=addon("session.methods").MethodChoice(),
        best_quality=offline,
        progress=lambda *_: True,
    )


def raised(kind: type[Exception], call: Callable[[], object]) -> str:
    """What the error says that the call raises; fails when it raises none."""
    try:
        call()
    except kind as error:
        return str(error).strip()
    raise AssertionError(f"no {kind.__name__} was raised")


def error_of(call: Callable[[], object]) -> str:
    """The one line that the operator reports as an error; fails when it does not."""
    before = contents()
    message = raised(RuntimeError, call)
    assert message.startswith("Error: "), message
    assert "\n" not in message, message
    assert "Traceback" not in message, message
    assert contents() == before, "something changed"
    return message.removeprefix("Error: ")


def contents() -> dict[str, object]:
    """What is in the file and in the settings, to see whether something changed."""
    data = bpy.data
    found: dict[str, object] = {
        kind: sorted(item.name for item in getattr(data, kind))
        for kind in ("objects", "armatures", "actions", "meshes", "collections", "scenes")
    }
    found["settings"] = _values(settings())
    found["active"] = bpy.context.view_layer.objects.active
    found["mode"] = bpy.context.mode
    return found


def _values(group) -> dict[str, object]:
    """The settings of a property group by name, those in its collections too."""
    found = {}
    for name in group.bl_rna.properties.keys():  # noqa: SIM118 - not a dict
        value = None if name == "rna_type" else getattr(group, name)
        if isinstance(value, bpy.types.bpy_prop_collection):
            value = [_values(item) for item in value]
        elif isinstance(value, bpy.types.PropertyGroup):
            value = _values(value)
        found[name] = value
    return found


def evaluated_points(armature, frame: float, names: list[str]) -> np.ndarray:
    """(J, 3) where the bones end (the root: begins) in the world at a frame, Blender's axes."""
    whole = int(np.floor(frame))
    bpy.context.scene.frame_set(whole, subframe=frame - whole)
    evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    bones = [evaluated.pose.bones[name] for name in bones_of(armature, names)]
    points = [bones[0].head, *(bone.tail for bone in bones[1:])]
    return np.array([evaluated.matrix_world @ point for point in points])


def evaluated_pivots(armature, frame: int, names: list[str]) -> np.ndarray:
    """(J, 3) where the bones begin in the world at a frame, Blender's axes."""
    bpy.context.scene.frame_set(frame)
    evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    heads = [evaluated.pose.bones[name].head for name in bones_of(armature, names)]
    return np.array([evaluated.matrix_world @ head for head in heads])


def bones_of(armature, joints: list[str]) -> list[str]:
    """The bones of joints: as they are called, or as the add-on's own figure calls them."""
    if joints[0] in armature.data.bones:
        return joints
    return addon("scene.figure").figure_names(joints)


def in_blenders_axes(positions) -> np.ndarray:
    """Written out anew, as the oracle: (x, y, z) of the core is (x, -z, y)."""
    x, y, z = np.moveaxis(np.asarray(positions), -1, 0)
    return np.stack([x, -z, y], axis=-1)


def undo() -> None:
    with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
        bpy.ops.ed.undo()


def loaded_modules() -> set[str]:
    return {name for name in sys.modules if name.startswith(f"{installed.ADDON}.")}
