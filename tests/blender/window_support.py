# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scenarios of window_script.py share."""

import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).parent))
import installed

installed.prepare_paths()
job_operator, jobs = installed.module("ops.job_operator"), installed.module("session.job")

SCENARIO, MOTIONS, DATABASE, TAKE, FOLDER = sys.argv[sys.argv.index("--") + 1 :]
TIMEOUT_S = 60.0
Steps = Iterator[float]
ended: list[bool] = []
"""Filled when an operator that runs a job is over."""


def watch_ends() -> None:
    end = job_operator.JobOperator._end

    def watched(self: Any, context: bpy.types.Context) -> None:
        end(self, context)
        ended.append(True)

    job_operator.JobOperator._end = watched


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


def until_ended() -> Steps:
    """Until the operator that start() began is over."""
    yield from until(lambda: bool(ended))
    yield 0.1


def start(operator: Callable[..., set[str]], **options: object) -> Any:
    ended.clear()
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


def press_escape() -> Steps:
    window = bpy.context.window_manager.windows[0]
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type="ESC", value=value, x=200, y=200)
        yield 0.05
