# SPDX-License-Identifier: GPL-3.0-or-later
"""One scenario in a Blender with a window; ends it with code 0 when all is as it should be.

window_script.py -- SCENARIO MOTIONS DATABASE TAKE FOLDER
"""

import os
import sys
import threading
import traceback
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parent))
import installed
from large_file import large_file
from window_support import (
    DATABASE,
    FOLDER,
    MOTIONS,
    SCENARIO,
    TAKE,
    TIMEOUT_S,
    Steps,
    choose_files,
    files,
    job_operator,
    jobs,
    press_escape,
    slow_down,
    start,
    start_building,
    undo,
    until,
    until_ended,
    view,
    watch_ends,
)  # fmt: skip


def reconstruct() -> Steps:
    choose_files()
    before = [item.name for item in bpy.data.objects]
    start(bpy.ops.sparse_mocap.reconstruct)
    yield from until_ended()
    assert len(bpy.data.actions) == 1
    assert bpy.context.view_layer.objects.active.type == "ARMATURE"
    undo()
    yield 0.1
    assert [item.name for item in bpy.data.objects] == before
    assert not bpy.data.actions
    assert not bpy.data.armatures
    assert bpy.context.scene.sparse_mocap.take == TAKE


def escape() -> Steps:
    job = start_building()
    yield 0.15
    assert job.is_running
    yield from press_escape()
    yield from until(lambda: not job.is_running)
    yield 0.3
    assert job.is_cancelled
    assert files() == []
    assert bpy.context.scene.sparse_mocap.database == ""


def cancel() -> Steps:
    job = start_building()
    yield 0.15
    assert bpy.ops.sparse_mocap.cancel() == {"FINISHED"}
    yield from until(lambda: not job.is_running)
    yield 0.3
    assert files() == []


def undo_meanwhile() -> Steps:
    on_progress, is_undone = jobs.Job._on_progress, threading.Event()
    jobs.Job._on_progress = lambda *args: is_undone.wait(TIMEOUT_S) and on_progress(*args)
    choose_files()
    bpy.data.objects.new("extra", None)
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo_push(message="extra")
    job = start(bpy.ops.sparse_mocap.reconstruct)
    yield 0.2
    assert job.is_running
    undo()
    is_undone.set()
    yield from until_ended()
    assert len(bpy.data.actions) == 1
    assert "extra" not in bpy.data.objects
    assert bpy.context.view_layer.objects.active.animation_data.action == bpy.data.actions[0]


def load_meanwhile() -> Steps:
    job = start_building()
    yield 0.15
    assert job.is_running
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    assert not job.is_running
    yield 0.5
    assert jobs.current() is None
    assert files() == []


def unregister_meanwhile() -> Steps:
    job = start_building()
    yield 0.15
    installed.unregister()
    assert not job.is_running
    yield 0.5
    assert files() == []
    installed.register()


def quit_meanwhile() -> Steps:
    job = start_building()
    yield 0.15
    assert job.is_running
    with bpy.context.temp_override(**view()):
        bpy.ops.wm.quit_blender()
    yield TIMEOUT_S


def adjust_afterwards() -> Steps:
    choose_files()
    bpy.context.scene.sparse_mocap.start_frame = 11.0
    start(bpy.ops.sparse_mocap.reconstruct)
    yield from until_ended()
    operator = bpy.context.window_manager.operators[-1]
    assert operator.bl_idname == "SPARSE_MOCAP_OT_reconstruct"
    assert operator.properties.start_frame == 11.0
    assert bpy.data.actions[0].frame_range[0] == 11.0


def bake_escaped() -> Steps:
    """While the take is reconstructed, and while its keys are set."""
    choose_files()
    before, said = [item.name for item in bpy.data.objects], []
    job_operator.one_line = lambda error: said.append(error) or str(error)
    on_progress = jobs.Job._on_progress
    slow_down(TIMEOUT_S)
    job = start(bpy.ops.sparse_mocap.reconstruct)
    yield 0.2
    assert job.is_running
    yield from press_escape()
    yield from until_ended()
    jobs.Job._on_progress = on_progress
    for is_halfway in (False, True):
        assert [item.name for item in bpy.data.objects] == before
        assert not bpy.data.actions
        assert not bpy.data.armatures
        assert jobs.current() is None
        assert not said, "Esc is no error"
        if not is_halfway:
            yield from escape_while_keys_are_set()


def escape_while_keys_are_set() -> Steps:
    slices = installed.module("session.steps").Slices
    advance = slices.advance
    slices.advance = lambda self, _: False if bpy.data.actions else advance(self, 0.0)
    start(bpy.ops.sparse_mocap.reconstruct)
    yield from until(lambda: len(bpy.data.actions) == 1)
    yield from press_escape()
    yield from until_ended()


def confirm_dialog() -> Steps:
    """Enter, with the pointer on the dialog that has just come up under it."""
    window = bpy.context.window_manager.windows[0]
    yield 0.3
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type="RET", value=value, x=400, y=400)
        yield 0.1


def begin_import(path: str) -> Steps:
    """Through the dialog that a dropped file opens; keys are then set in the smallest slices."""
    job_operator._SLICE_S = 0.0  # else a fast machine is done before anything can happen meanwhile
    window = bpy.context.window_manager.windows[0]
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=400, y=400)
    yield 0.2
    folder, name = str(Path(path).parent), Path(path).name
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo_push(message="before")
        done = bpy.ops.sparse_mocap.import_bvh(
            "INVOKE_DEFAULT", True, directory=folder, files=[{"name": name}]
        )
    assert done == {"RUNNING_MODAL"}
    yield from confirm_dialog()


def import_dropped() -> Steps:
    before = [item.name for item in bpy.data.objects]
    yield from begin_import(large_file(Path(FOLDER)))
    num_halfway = 0
    while not any(item.animation_data for item in bpy.data.objects):
        num_halfway += len(bpy.data.actions)
        yield 0.01
    assert num_halfway > 3, "the window stood still while keys were set"
    yield from until_ended()
    action = bpy.data.actions["large"]
    assert bpy.context.view_layer.objects.active.animation_data.action == action
    assert jobs.current() is None
    undo()
    yield 0.1
    assert [item.name for item in bpy.data.objects] == before
    assert not bpy.data.actions


def import_escaped() -> Steps:
    before = [item.name for item in bpy.data.objects]
    active = bpy.context.view_layer.objects.active.name
    yield from begin_import(large_file(Path(FOLDER)))
    yield from until(lambda: len(bpy.data.actions) == 1)
    assert len(bpy.data.armatures) == 1
    yield from press_escape()
    yield from until_ended()
    assert not bpy.data.actions
    assert not bpy.data.armatures
    assert [item.name for item in bpy.data.objects] == before
    assert bpy.context.view_layer.objects.active.name == active


def import_undone_meanwhile() -> Steps:
    before = [item.name for item in bpy.data.objects]
    yield from begin_import(large_file(Path(FOLDER)))
    yield from until(lambda: len(bpy.data.actions) == 1)
    undo()
    yield from until_ended()
    assert not bpy.data.actions
    assert [item.name for item in bpy.data.objects] == before


def until_imported(before: list[str]) -> Steps:
    yield from until_ended()
    assert len(bpy.data.actions) == 1
    undo()
    yield 0.1
    assert [item.name for item in bpy.data.objects] == before


def import_chosen() -> Steps:
    """Through File > Import and the file browser."""
    path, before = large_file(Path(FOLDER)), [item.name for item in bpy.data.objects]
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.sparse_mocap.import_bvh("INVOKE_DEFAULT", True)
    windows = bpy.context.window_manager.windows
    found: list[tuple[Any, Any]] = []

    def is_open() -> bool:
        areas = [(window, area) for window in windows for area in window.screen.areas]
        found[:] = [pair for pair in areas if pair[1].type == "FILE_BROWSER"]
        return bool(found) and found[0][1].spaces.active.params is not None

    yield from until(is_open)
    yield 0.5
    window, area = found[0]
    area.spaces.active.params.directory = os.path.dirname(path).encode()
    area.spaces.active.params.filename = os.path.basename(path)
    yield 0.5
    with bpy.context.temp_override(window=window, area=area, region=area.regions[-1]):
        bpy.ops.file.execute()
    yield from until_imported(before)


def import_left() -> Steps:
    """The dialog is left: nothing happens."""
    before = [item.name for item in bpy.data.objects]
    folder, name = str(Path(MOTIONS)), next(Path(MOTIONS).iterdir()).name
    with bpy.context.temp_override(**view()):
        bpy.ops.sparse_mocap.import_bvh(
            "INVOKE_DEFAULT", True, directory=folder, files=[{"name": name}]
        )
    yield 0.5
    yield from press_escape()
    yield 0.3
    assert jobs.current() is None
    assert [item.name for item in bpy.data.objects] == before


def dropped() -> Steps:
    """As if the file were dropped on the viewport."""
    if not hasattr(bpy.ops.wm, "drop_import_file") or not hasattr(bpy.types, "FileHandler"):
        return
    path, before = large_file(Path(FOLDER)), [item.name for item in bpy.data.objects]
    window = bpy.context.window_manager.windows[0]
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=400, y=400)
    yield 0.2
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.wm.drop_import_file(
            "INVOKE_DEFAULT",
            directory=os.path.dirname(path),
            files=[{"name": os.path.basename(path)}],
        )
    yield from confirm_dialog()
    yield from until_imported(before)


def preview_plays() -> Steps:
    bpy.context.scene.sparse_mocap.database = DATABASE
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo_push(message="chosen")
        done = bpy.ops.sparse_mocap.preview_clip("INVOKE_DEFAULT", True, index=1)
    assert done == {"FINISHED"}
    yield 0.2
    assert bpy.data.objects["Clip Preview"].animation_data.action
    yield from until(lambda: bpy.context.scene.frame_current > 2)
    assert bpy.context.window_manager.windows[0].screen.is_animation_playing


SCENARIOS = {
    "preview": preview_plays,
    "dropped": dropped,
    "import_chosen": import_chosen,
    "import_left": import_left,
    "import": import_dropped,
    "import_escaped": import_escaped,
    "import_undone": import_undone_meanwhile,
    "reconstruct": reconstruct,
    "escape": escape,
    "bake_escaped": bake_escaped,
    "cancel": cancel,
    "undo": undo_meanwhile,
    "load": load_meanwhile,
    "unregister": unregister_meanwhile,
    "quit": quit_meanwhile,
    "adjust": adjust_afterwards,
}


def tick() -> float | None:
    try:
        return next(steps)
    except StopIteration:
        code = 0
    except BaseException:
        traceback.print_exc()
        code = 1
    sys.stdout.flush()
    os._exit(code)


bpy.context.preferences.view.show_splash = False
installed.register()
watch_ends()
steps = SCENARIOS[SCENARIO]()
bpy.app.timers.register(tick, persistent=True, first_interval=1.0)
