# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the panels of all steps."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
from bpy.types import UILayout

from ..scene import compat
from ..scene.translations import tr
from ..session import job as jobs
from ..session.file_cache import FileCache
from ..session.job import Job

_REDRAW_S = 0.1

_changes: set[Callable[[], None]] = set()


class StepPanel:
    """Mix-in: a panel in the sidebar of the 3D view."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Sparse Mocap"


def tick(layout: UILayout, cache: FileCache[Any], path: str) -> None:
    """Show a check mark in a step's header when its file is loaded."""
    if path and cache.peek(path).value is not None:
        layout.label(text="", icon="CHECKMARK")


def job_is_running(label: str) -> bool:
    """Whether the job with that label is running."""
    job = jobs.current()
    return job is not None and job.label == label


def waits_for(*but: str) -> str:
    """Why a button is grey while a job is running, other than those with such labels."""
    job = jobs.current()
    if job is None or job.label in but:
        return ""
    return tr("Waits for: {job}").format(job=tr(job.label))


def action_button(
    layout: UILayout,
    operator: str,
    icon: str,
    job_label: str,
    *,
    is_ready: bool,
    is_main: bool = True,
    has_details: bool = True,
) -> None:
    """A job's button, replaced by the progress while it runs; large if it is the main one.

    has_details: whether a line below the progress says what is being done.
    """
    job = jobs.current()
    if job is not None and job_is_running(job_label):
        _progress(layout, job)
        if has_details:
            _details(layout, job)
        return
    row = layout.row()
    row.scale_y = 1.5 if is_main else 1.0
    row.enabled = is_ready and job is None
    row.operator(operator, icon=icon)
    if job is not None and has_details:
        layout.label(text=waits_for(), icon="SORTTIME")


def _progress(layout: UILayout, job: Job) -> None:
    row = layout.row(align=True)
    row.scale_y = 1.5
    percent = f"{job.fraction:.0%}"
    if job.is_cancelled:
        row.label(text="Cancelling", icon="SORTTIME")
    elif compat.HAS_PROGRESS_BAR:
        row.progress(factor=job.fraction, text=percent)
    else:
        row.label(text=percent, icon="SORTTIME")
    row.operator("sparse_mocap.cancel", text="", icon="X")


def _details(layout: UILayout, job: Job) -> None:
    what = job.what if job.what.lower() not in job.label.lower() else ""
    how = tr("{job}: press Esc to cancel").format(job=tr(job.label))
    layout.label(text=what or how)


def redraw_soon() -> None:
    """Redraw the panels shortly, while a file is still being opened."""
    later(_nothing)


def later(change: Callable[[], None]) -> None:
    """Make a change that drawing must not make, shortly after, and redraw the panels."""
    _changes.add(change)
    if not bpy.app.timers.is_registered(_redraw):
        bpy.app.timers.register(_redraw, first_interval=_REDRAW_S)


def forget_timers() -> None:
    """Remove the timer."""
    _changes.clear()
    if bpy.app.timers.is_registered(_redraw):
        bpy.app.timers.unregister(_redraw)


def _nothing() -> None:
    pass


def _redraw() -> None:
    while _changes:
        _changes.pop()()
    compat.redraw_views(bpy.context)
