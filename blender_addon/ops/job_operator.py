# SPDX-License-Identifier: GPL-3.0-or-later
"""Long-running operators: modal with progress and Esc in the window, blocking for scripts."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any

import bpy
from bpy.types import Context, Event, Operator

from ..scene import compat
from ..scene.settings import settings_of
from ..scene.translations import tr_line
from ..session import job as jobs
from ..session.errors import InputError, log, one_line
from ..session.job import Cancelled, Job
from ..session.steps import Slices, Steps, finished

_TICK_S = 0.1
_SLICE_S = 0.03  # of work on the main thread, between which the window is drawn


class JobOperator:
    """Mix-in: prepare() returns the job, apply() puts its result into Blender.

    No reference to Blender's data is held between the two, since the user may undo or open another
    file. While apply() runs, slice by slice, the window is redrawn but accepts no input except Esc.
    """

    _job: Job | None = None
    _slices: Slices[str] | None = None
    _timer: Any = None
    _last_shown: tuple[object, ...] = ()
    steps_label = "Setting keys"  # shown while apply() runs
    report: Callable[[set[str], str], None]  # the operator's own
    properties: Any  # the operator's own

    def prepare(self, context: Context) -> Job:
        """The job. Raises InputError or the error of a file."""
        raise NotImplementedError

    def apply(self, context: Context, result: Any) -> Steps[str]:
        """Change Blender's data, completely or not at all, and return one line to report."""
        raise NotImplementedError

    def fill_from_scene(self, context: Context, *names: str) -> None:
        """Set properties that were not passed to the operator from the scene's settings."""
        for name in names:
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(settings_of(context.scene), name))

    def execute(self, context: Context) -> set[str]:
        """Do everything now, blocking."""
        manager = context.window_manager
        manager.progress_begin(0, 100)
        try:
            _refuse_while_rendering()
            job = self.prepare(context)
            result = job.run(lambda: manager.progress_update(int(100 * job.fraction)))
            return self._finished(finished(self.apply(context, result)))
        except Exception as error:
            return self._failed(error)
        finally:
            manager.progress_end()

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Run the job on a worker thread; Blender stays usable."""
        if bpy.app.background:
            return self.execute(context)  # there are no timers in the background
        return self.start(context)

    def start(self, context: Context) -> set[str]:
        """Start the job; modal() does the rest."""
        try:
            _refuse_while_rendering()
            self._job = self.prepare(context)
            self._job.start()
        except Exception as error:
            return self._failed(error)
        manager = context.window_manager
        self._timer = manager.event_timer_add(_TICK_S, window=context.window)
        if not compat.HAS_PROGRESS_BAR:
            manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: Context, event: Event) -> set[str]:
        """Show the progress; when the job is done, put its result into the scene."""
        job = self._job
        if job is None:
            return {"CANCELLED"}
        if event.type == "ESC" and event.value == "PRESS":
            job.cancel()
            if self._slices is not None:
                self._end(context)
                return self._failed(Cancelled("Cancelled"))
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"} if self._slices is None else {"RUNNING_MODAL"}
        self._show_progress(context, job)
        if job.is_running or compat.is_busy(context):
            return {"PASS_THROUGH"}
        try:
            slices = self._slices or self._begin_slices(context, self.apply(context, job.result()))
            if not slices.advance(_SLICE_S):
                return {"RUNNING_MODAL"}
            message = slices.result or ""
            self._end(context)
            return self._finished(message)
        except Exception as error:
            self._end(context)
            return self._failed(error)

    def cancel(self, context: Context) -> None:
        """Called by Blender when its window closes or another file is opened."""
        if self._job is not None:
            self._job.cancel()
        self._end(context)

    def _begin_slices(self, context: Context, steps: Steps[str]) -> Slices[str]:
        """Switch to a faster timer."""
        slices = self._slices = Slices(steps)
        manager = context.window_manager
        manager.event_timer_remove(self._timer)
        self._timer = manager.event_timer_add(_TICK_S / 10.0, window=context.window)
        return slices

    def shown(self, job: Job) -> tuple[object, ...]:
        """What the views show of the job; they are redrawn when it changes."""
        return round(100 * job.fraction), job.what, job.is_cancelled, job.is_running

    def _show_progress(self, context: Context, job: Job) -> None:
        slices = self._slices
        fraction = job.fraction if slices is None else slices.fraction
        label = job.label if slices is None else self.steps_label
        shown = self.shown(job) if slices is None else (round(100 * fraction), label)
        if shown == self._last_shown:  # drawing takes time from the work
            return
        self._last_shown = shown
        if slices is None:
            compat.redraw_views(context)  # the sidebar shows the job
        compat.show_status(context, label, fraction)
        if not compat.HAS_PROGRESS_BAR:
            context.window_manager.progress_update(int(100 * fraction))

    def _end(self, context: Context) -> None:
        slices, self._slices, self._job = self._slices, None, None
        if slices is not None:
            slices.close()
        timer, self._timer = self._timer, None
        if timer is None:
            return  # the dialog was closed
        with suppress(ReferenceError, AttributeError):  # the window may be gone
            manager = context.window_manager
            manager.event_timer_remove(timer)
            if not compat.HAS_PROGRESS_BAR:
                manager.progress_end()
            compat.clear_status(context)
            compat.redraw_views(context)

    def _finished(self, message: str) -> set[str]:
        log.info("%s", message)
        self.report({"INFO"}, tr_line(message))
        return {"FINISHED"}

    def _failed(self, error: Exception) -> set[str]:
        if isinstance(error, Cancelled):
            self.report({"INFO"}, tr_line("Cancelled"))
        elif isinstance(error, ReferenceError):
            self.report(
                {"ERROR"},
                tr_line("The scene changed in the meantime, so nothing was done: try again"),
            )
        else:
            self.report({"ERROR"}, tr_line(one_line(error)))
        return {"CANCELLED"}


class SPARSEMOCAP_OT_cancel(Operator):
    """Cancel and discard."""

    bl_idname = "sparse_mocap.cancel"
    bl_label = "Cancel"
    bl_description = "Cancel and discard"
    bl_options = {"INTERNAL"}

    def execute(self, context: Context) -> set[str]:
        """Ask the job to stop; its own operator reports the rest."""
        job = jobs.current()
        if job is None:
            return {"CANCELLED"}
        job.cancel()
        return {"FINISHED"}


def _refuse_while_rendering() -> None:
    if compat.is_rendering():
        raise InputError("A render is running: wait until it has finished")


CLASSES = (SPARSEMOCAP_OT_cancel,)
