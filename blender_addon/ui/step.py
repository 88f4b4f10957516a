# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panels of all steps share."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
from bpy.types import UILayout

from ..scene import compat
from ..session import job as jobs
from ..session.job import Job
from ..session.opened import Shelf

_REDRAW_S = 0.1

_changes: set[Callable[[], None]] = set()


class StepPanel:
    """Mix-in: a panel in the sidebar of the 3D view."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Sparse Mocap"


def tick(layout: UILayout, shelf: Shelf[Any], path: str) -> None:
    """Show in a step's header that its file is there."""
    if path and shelf.peek(path).value is not None:
        layout.label(text="", icon="CHECKMARK")


def job_is_running(label: str) -> bool:
    """Whether the job of that label is at work."""
    job = jobs.current()
    return job is not None and job.label == label


def action_button(
    layout: UILayout, operator: str, icon: str, job_label: str, *, is_ready: bool
) -> None:
    """The step's main button, or the progress of what it started in its place."""
    job = jobs.current()
    if job is not None and job_is_running(job_label):
        _progress(layout, job)
        return
    row = layout.row()
    row.scale_y = 1.5
    row.enabled = is_ready and job is None
    row.operator(operator, icon=icon)


def _progress(layout: UILayout, job: Job) -> None:
    row = layout.row(align=True)
    row.scale_y = 1.5
    percent = f"{job.fraction:.0%}"
    if job.is_cancelled:
        row.label(text="Stopping", icon="SORTTIME")
    elif compat.HAS_PROGRESS_BAR:
        row.progress(factor=job.fraction, text=percent)
    else:
        row.label(text=percent, icon="SORTTIME")
    row.operator("sparse_mocap.cancel", text="", icon="X")
    what = job.what if job.what.lower() not in job.label.lower() else ""
    layout.label(text=what or f"{job.label}: Esc cancels")


def redraw_soon() -> None:
    """Draw the panels anew in a moment: a file is still being opened."""
    later(_nothing)


def later(change: Callable[[], None]) -> None:
    """Do what drawing must not do, in a moment, and draw the panels anew then."""
    _changes.add(change)
    if not bpy.app.timers.is_registered(_redraw):
        bpy.app.timers.register(_redraw, first_interval=_REDRAW_S)


def forget_timers() -> None:
    """Leave no timer behind."""
    _changes.clear()
    if bpy.app.timers.is_registered(_redraw):
        bpy.app.timers.unregister(_redraw)


def _nothing() -> None:
    pass


def _redraw() -> None:
    while _changes:
        _changes.pop()()
    compat.redraw_views(bpy.context)
