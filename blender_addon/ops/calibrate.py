# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration: guide the performer through movements and calibrate from what was recorded."""

from __future__ import annotations

import bpy
from bpy.types import Context, Event, Operator

from ..scene import prompt
from ..scene.settings import settings_of
from ..scene.translations import tr_line
from ..session import live
from ..session.calibrating import Calibrated, calibrating_job, calibrations
from ..session.job import Job
from ..session.new_files import takes_folder
from ..session.steps import Steps
from .job_operator import JobOperator
from .live import connected


def use_calibration(operator: Operator, context: Context, result: Calibrated) -> None:
    """Reports what a calibration found and uses it from now on, in a running live preview too."""
    settings_of(context.scene).calibration = result.path
    for note in result.notes:
        operator.report({"WARNING"}, tr_line(note))
    session = live.current()
    if session is not None:
        session.use_calibration(calibrations.get(result.path))


class SPARSEMOCAP_OT_calibrate_sensors(JobOperator, Operator):
    """Find how each sensor is oriented and scaled, from a few guided movements."""

    bl_idname = "sparse_mocap.calibrate_sensors"
    bl_label = "Calibrate"
    bl_description = (
        "Find how each sensor sits on the body. The viewport shows the performer what to do: "
        "stand still, bend the elbows, squat"
    )
    bl_options = {"REGISTER", "UNDO"}

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Start the job and show the instructions in the viewport."""
        done = super().invoke(context, event)
        if "RUNNING_MODAL" in done:
            prompt.show()
        return done

    def prepare(self, context: Context) -> Job:
        """Guide the performer."""
        settings = settings_of(context.scene)
        folder = takes_folder(bpy.data.filepath, settings.folder)
        return calibrating_job(connected(), folder, settings.height_m)

    def apply(self, context: Context, result: Calibrated) -> Steps[str]:
        """Use the calibration from now on, in a running live preview too."""
        yield 0.0
        use_calibration(self, context, result)
        return f"Calibrated {len(result.calibration.sensors)} sensors, saved as {result.path}"

    def _end(self, context: Context) -> None:
        super()._end(context)
        prompt.hide()


CLASSES = (SPARSEMOCAP_OT_calibrate_sensors,)
