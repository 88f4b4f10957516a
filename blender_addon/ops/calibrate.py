# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration: lead the performer, and use what the sensors read meanwhile."""

from __future__ import annotations

import bpy
from bpy.types import Context, Event, Operator

from ..scene import prompt
from ..scene.settings import settings_of
from ..session import live
from ..session.calibrating import Calibrated, calibrating_job, calibrations
from ..session.job import Job
from ..session.new_files import takes_folder
from ..session.steps import Steps
from .job_operator import JobOperator
from .live import connected


class SPARSEMOCAP_OT_calibrate_sensors(JobOperator, Operator):
    """Find how the sensors are strapped on."""

    bl_idname = "sparse_mocap.calibrate_sensors"
    bl_label = "Calibrate"
    bl_description = (
        "Find how the sensors are strapped on, while the performer stands still, bends the "
        "elbows and squats as the viewport says"
    )
    bl_options = {"REGISTER", "UNDO"}

    def invoke(self, context: Context, event: Event) -> set[str]:
        """As every job, with what to do written large in the viewport."""
        done = super().invoke(context, event)
        if "RUNNING_MODAL" in done:
            prompt.show()
        return done

    def prepare(self, context: Context) -> Job:
        """Lead the performer."""
        height_m = settings_of(context.scene).height_m
        return calibrating_job(connected(), takes_folder(bpy.data.filepath), height_m)

    def apply(self, context: Context, result: Calibrated) -> Steps[str]:
        """The calibration is used from now on, also by what is live."""
        yield 0.0
        settings_of(context.scene).calibration = result.path
        for note in result.notes:
            self.report({"WARNING"}, note)
        session = live.current()
        if session is not None:
            session.use_calibration(calibrations.get(result.path))
        return f"Calibrated {len(result.calibration.sensors)} sensors: {result.path}"

    def _end(self, context: Context) -> None:
        super()._end(context)
        prompt.hide()


CLASSES = (SPARSEMOCAP_OT_calibrate_sensors,)
