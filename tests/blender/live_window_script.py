# SPDX-License-Identifier: GPL-3.0-or-later
"""Goes live in a Blender with a window: live_window_script.py -- PORT DATABASE FOLDER SERIAL

Pictures of the display go to FOLDER, where ImageMagick is. Ends with code 0 when all is well.
"""

import os
import shutil
import subprocess
import sys
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import installed

installed.prepare_paths()
PORT, DATABASE, FOLDER, SERIAL = sys.argv[sys.argv.index("--") + 1 :]
sys.path.append(SERIAL)

from live_support import DRIVER, OPTIONS  # noqa: E402
from support import SITES, raised  # noqa: E402

ui, live_scene = installed.module("ui.registration"), installed.module("scene.live")
compat = installed.module("scene.compat")
prompt, jobs = installed.module("scene.prompt"), installed.module("session.job")
log_file = installed.module("session.log_file")
CalibrationPanel = installed.module("ui.calibrate").SPARSEMOCAP_PT_calibration
LivePanel = installed.module("ui.live").SPARSEMOCAP_PT_live

TIMEOUT_S = 40.0
Steps = Iterator[float]
shown_late_s: list[float] = []


def view() -> dict[str, object]:
    window = bpy.context.window_manager.windows[0]
    areas = [area for area in window.screen.areas if area.type == "VIEW_3D"]
    area = max(areas, key=lambda area: area.width * area.height)
    region = next(region for region in area.regions if region.type == "WINDOW")
    return {"window": window, "area": area, "region": region}


def sidebar() -> bpy.types.Region:
    return next(region for region in view()["area"].regions if region.type == "UI")


def until(is_done: Callable[[], object]) -> Steps:
    begin = time.perf_counter()
    while not is_done():
        assert time.perf_counter() - begin < TIMEOUT_S, "nothing happened"
        yield 0.05


def call(operator: Callable[..., set[str]], *arguments: object) -> set[str]:
    with bpy.context.temp_override(**view()):
        return operator(*arguments)


def watch_draws() -> dict[str, int]:
    drawn, draw = {"times": 0}, LivePanel.draw

    def counted(self: LivePanel, context: bpy.types.Context) -> None:
        drawn["times"] += 1
        draw(self, context)

    LivePanel.draw = counted
    return drawn


def watch_latency() -> None:
    show = live_scene._show

    def timed(armature: bpy.types.Object, figure: object, pose: object) -> None:
        show(armature, figure, pose)
        shown_late_s.append(time.perf_counter() - pose.time_s)

    live_scene._show = timed


def click(x: int, y: int) -> Steps:
    window = view()["window"]
    window.event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    yield 0.1
    window.event_simulate(type="LEFTMOUSE", value="PRESS", x=x, y=y)
    yield 0.05
    window.event_simulate(type="LEFTMOUSE", value="RELEASE", x=x, y=y)
    yield 0.15


def open_panel(drawn: dict[str, int]) -> Steps:
    """Down the tabs until the panel is drawn, as a user finds it."""
    call(bpy.ops.screen.screen_full_area)
    yield 0.4
    view()["area"].spaces.active.show_region_ui = True
    yield 0.4
    region = sidebar()
    if hasattr(region, "active_panel_category"):
        region.active_panel_category = LivePanel.bl_category
        region.tag_redraw()  # 4.3 does not by itself
        yield 0.3
    else:
        for y in range(region.y + region.height - 15, region.y, -20):
            yield from click(region.x + region.width - 10, y)
            if drawn["times"]:
                break
    yield from until(lambda: drawn["times"])


def picture(name: str) -> None:
    if shutil.which("import"):
        subprocess.run(["import", "-window", "root", str(Path(FOLDER) / name)], check=True)


def points() -> np.ndarray:
    bones = live_scene.followed().pose.bones
    return np.array([bone.tail for bone in bones])


def press_escape() -> Steps:
    for value in ("PRESS", "RELEASE"):
        view()["window"].event_simulate(type="ESC", value=value, x=600, y=400)
        yield 0.1


def escape_live_and_countdown(session: Any) -> Steps:
    """Neither leaves a preview, a recording or a figure behind."""
    sensors = installed.module("session.sensors")
    databases, is_free = sensors.databases, threading.Event()
    sensors.databases = SimpleNamespace(get=lambda path: is_free.wait() and databases.get(path))
    assert call(bpy.ops.sparse_mocap.go_live, "INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield 0.2
    yield from press_escape()
    is_free.set()
    yield from until(lambda: jobs.current() is None and not bpy.data.armatures)
    sensors.databases = databases
    assert not session.is_live_wanted
    assert live_scene.followed() is None
    assert not bpy.data.armatures
    bpy.context.scene.sparse_mocap.countdown_s = 50
    done = call(bpy.ops.sparse_mocap.record_or_stop, "INVOKE_DEFAULT", True)
    assert done == {"RUNNING_MODAL"}
    yield from until(lambda: prompt._handler is not None)
    yield from press_escape()
    yield from until(lambda: prompt._handler is None)
    yield from press_record_twice()
    yield 0.5
    assert session.state.recording is None


def press_record_twice() -> Steps:
    """The second time ends the countdown."""
    for wanted in ("RUNNING_MODAL", "FINISHED"):
        done = call(bpy.ops.sparse_mocap.record_or_stop, "INVOKE_DEFAULT", True)
        assert done == {wanted}
        assert (prompt.countdown_s() > 0) == (wanted == "RUNNING_MODAL")
        yield 0.3
    yield from until(lambda: prompt._handler is None)


def calibrate_and_escape(session: Any) -> Steps:
    """What to do stands in the viewport until Esc, which leaves nothing."""
    done = call(bpy.ops.sparse_mocap.calibrate_sensors, "INVOKE_DEFAULT", True)
    assert done == {"RUNNING_MODAL"}
    num_shown = len(shown_late_s)
    yield from until(lambda: jobs.current() and jobs.current().what.startswith("Stand still"))
    assert prompt._handler is not None
    assert len(shown_late_s) > num_shown, "calibrating holds up the poses"
    call(bpy.ops.view3d.view_selected)
    yield 0.7
    picture("calibrating.png")
    yield from press_escape()
    yield from until(lambda: jobs.current() is None and session.state.recording is None)
    yield from until(lambda: prompt._handler is None)
    assert bpy.context.scene.sparse_mocap.calibration == ""


def render_meanwhile() -> Steps:
    """The pose stays while a render runs, nothing else begins; the preview goes on afterwards."""
    scene = bpy.context.scene
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y = 32, 20
    may_end = threading.Event()
    bpy.app.handlers.render_post.append(lambda *_: may_end.wait(TIMEOUT_S))
    bpy.context.preferences.view.render_display_type = "NONE"
    scene.camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(scene.camera)
    yield 0.1
    assert call(bpy.ops.render.render, "INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield from until(compat.is_rendering)
    num_shown, pose = len(shown_late_s), points()
    said = raised(RuntimeError, lambda: call(bpy.ops.sparse_mocap.reconstruct))
    assert "render is running" in said
    yield 0.3
    assert compat.is_rendering()
    assert len(shown_late_s) == num_shown
    assert np.array_equal(points(), pose)
    may_end.set()
    yield from until(lambda: not compat.is_rendering())
    yield from until(lambda: len(shown_late_s) > num_shown + 3)
    assert live_scene.followed() is not None


def second_window(session: Any) -> Steps:
    """Another window shows the same session, and no second one begins there."""
    call(bpy.ops.screen.back_to_previous)  # there is no second one beside a full area
    yield 0.4
    call(bpy.ops.wm.window_new)
    yield 0.5
    first, second = bpy.context.window_manager.windows[:2]
    with bpy.context.temp_override(window=second):
        assert "still connected" in raised(RuntimeError, bpy.ops.sparse_mocap.connect_sensors)
    num_shown = len(shown_late_s)
    yield from until(lambda: len(shown_late_s) > num_shown + 3)
    assert installed.module("session.live").current() is session
    with bpy.context.temp_override(window=second):
        bpy.ops.wm.window_close()
    yield 0.3
    assert list(bpy.context.window_manager.windows) == [first]
    call(bpy.ops.screen.screen_full_area)
    yield 0.4


def play() -> Steps:
    drawn = watch_draws()
    watch_latency()
    yield from open_panel(drawn)
    chosen = bpy.context.scene.sparse_mocap
    chosen.port, chosen.driver, chosen.driver_options = PORT, DRIVER, OPTIONS
    chosen.sites, chosen.database = ", ".join(SITES), DATABASE
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    call(bpy.ops.ed.undo_push)
    live, may_connect = installed.module("session.live"), threading.Event()
    run = live.LiveSession._run
    live.LiveSession._run = lambda self: may_connect.wait() and run(self)
    assert call(bpy.ops.sparse_mocap.connect_sensors) == {"FINISHED"}  # waits for nothing
    may_connect.set()
    session = live.current()
    yield from until(lambda: session.state.error or len(session.state.sensors) == len(SITES))
    assert session.state.error == "", session.state.error
    yield from escape_live_and_countdown(session)
    assert call(bpy.ops.sparse_mocap.go_live, "INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield from until(lambda: len(shown_late_s) > 5)
    call(bpy.ops.view3d.view_selected)
    yield from calibrate_and_escape(session)
    yield from render_meanwhile()
    yield from second_window(session)
    call(bpy.ops.view3d.view_selected)
    call(bpy.ops.sparse_mocap.record_take)
    yield 0.7
    first = points()
    picture("first.png")
    call(bpy.ops.screen.animation_play)
    frame = bpy.context.scene.frame_current
    yield from until(lambda: bpy.context.scene.frame_current > frame)  # the timeline is free
    yield from until(lambda: np.abs(points() - first).max() > 0.05)
    call(bpy.ops.screen.animation_cancel)
    call(bpy.ops.view3d.view_selected)
    yield 0.7
    picture("second.png")
    call(bpy.ops.ed.undo)  # what it takes back matters not, only that it does no harm
    yield 0.5
    late = np.array(shown_late_s)
    p50, p99 = 1e3 * np.quantile(late, [0.5, 0.99])
    print(f"window: sensor to shown pose: p50 {p50:.0f} ms, p99 {p99:.0f} ms, {len(late)} poses")
    yield from until(lambda: session.state.recording)
    assert call(bpy.ops.sparse_mocap.stop_take, "INVOKE_DEFAULT", True) == {"RUNNING_MODAL"}
    yield from until(lambda: bpy.data.actions and jobs.current() is None)
    yield 0.5
    picture("baked.png")
    sys.stdout.flush()
    call(bpy.ops.wm.quit_blender)


def tick() -> float | None:
    try:
        return next(steps)
    except StopIteration:
        return None
    except BaseException:
        traceback.print_exc()
        print(*log_file.last_lines(5), sep="\n")  # Blender prints no report of what failed
        sys.stdout.flush()
        os._exit(1)


bpy.context.preferences.view.show_splash = False
for panel in ui.CLASSES:
    if issubclass(panel, bpy.types.Panel):
        panel.bl_options = set() if panel in (LivePanel, CalibrationPanel) else {"DEFAULT_CLOSED"}
installed.register()
bpy.ops.wm.save_as_mainfile(filepath=str(Path(FOLDER) / "scene.blend"))
steps = play()
bpy.app.timers.register(tick, persistent=True, first_interval=1.0)
