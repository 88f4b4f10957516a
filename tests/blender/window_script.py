# SPDX-License-Identifier: GPL-3.0-or-later
"""One scenario in a Blender with a window; ends it with code 0 when all is as it should be.

window_script.py -- SCENARIO MOTIONS DATABASE TAKE FOLDER
"""

import os
import sys
import time
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parent))
import installed
from large_file import large_file

installed.prepare_paths()
job_operator, jobs = installed.module("ops.job_operator"), installed.module("session.job")

SCENARIO, MOTIONS, DATABASE, TAKE, FOLDER = sys.argv[sys.argv.index("--") + 1 :]
TIMEOUT_S = 60.0
Steps = Iterator[float]


def slow_down(pause_s: float) -> None:
    """Let every progress of a job take that long, so that it runs while something happens.

    Unless the job is cancelled meanwhile.
    """
    on_progress = jobs.Job._on_progress

    def slow(self: Any, *args: object) -> bool:
        end = time.perf_counter() + pause_s
        while time.perf_counter() < end and not self.is_cancelled:
            time.sleep(0.01)
        return on_progress(self, *args)

    jobs.Job._on_progress = slow


def view() -> dict[str, object]:
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    return {"window": window, "area": area, "region": region}


def start(operator: Callable[..., set[str]], **options: object) -> Any:
    with bpy.context.temp_override(**view()):
        assert operator("INVOKE_DEFAULT", True, **options) == {"RUNNING_MODAL"}
    job = jobs.current()
    assert job is not None
    return job


def start_building() -> Any:
    slow_down(TIMEOUT_S)
    path = str(Path(FOLDER) / "new.smdb")
    return start(bpy.ops.sparse_mocap.build_database, source=MOTIONS, filepath=path, mirror=True)


def until(is_done: Callable[[], bool]) -> Steps:
    begin = time.perf_counter()
    while not is_done():
        assert time.perf_counter() - begin < TIMEOUT_S, "nothing happened"
        yield 0.05


def undo() -> None:
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo()


def files() -> list[str]:
    return sorted(path.name for path in Path(FOLDER).iterdir())


def choose_files() -> None:
    settings = bpy.context.scene.sparse_mocap
    settings.database, settings.take = DATABASE, TAKE
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo_push(message="files chosen")


def reconstruct() -> Steps:
    choose_files()
    before = [item.name for item in bpy.data.objects]
    start(bpy.ops.sparse_mocap.reconstruct)
    yield from until(lambda: len(bpy.data.actions) == 1)
    yield 0.3
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
    slow_down(0.05)
    choose_files()
    bpy.data.objects.new("extra", None)
    with bpy.context.temp_override(**view()):
        bpy.ops.ed.undo_push(message="extra")
    job = start(bpy.ops.sparse_mocap.reconstruct)
    yield 0.2
    assert job.is_running
    undo()
    yield from until(lambda: len(bpy.data.actions) == 1)
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
    yield from until(lambda: len(bpy.data.actions) == 1)
    yield 0.3
    operator = bpy.context.window_manager.operators[-1]
    assert operator.bl_idname == "SPARSE_MOCAP_OT_reconstruct"
    assert operator.properties.start_frame == 11.0
    assert bpy.data.actions[0].frame_range[0] == 11.0


def press_escape() -> Steps:
    window = bpy.context.window_manager.windows[0]
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type="ESC", value=value, x=200, y=200)
        yield 0.05


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
    yield from until(lambda: not job.is_running)
    yield 0.3
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
    yield 0.3


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
    yield 0.3
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
    yield 0.3
    assert not bpy.data.actions
    assert not bpy.data.armatures
    assert [item.name for item in bpy.data.objects] == before
    assert bpy.context.view_layer.objects.active.name == active


def import_undone_meanwhile() -> Steps:
    before = [item.name for item in bpy.data.objects]
    yield from begin_import(large_file(Path(FOLDER)))
    yield from until(lambda: len(bpy.data.actions) == 1)
    undo()
    yield 0.5
    assert not bpy.data.actions
    assert [item.name for item in bpy.data.objects] == before


def until_imported(before: list[str]) -> Steps:
    yield from until(lambda: any(item.animation_data for item in bpy.data.objects))
    yield 0.3
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
    yield 1.0
    windows = bpy.context.window_manager.windows
    found = [(w, a) for w in windows for a in w.screen.areas if a.type == "FILE_BROWSER"]
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
steps = SCENARIOS[SCENARIO]()
bpy.app.timers.register(tick, persistent=True, first_interval=1.0)
