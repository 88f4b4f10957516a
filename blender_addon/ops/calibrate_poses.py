# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration by poses: guide the performer through the poses, and calibrate trackers and body."""

from __future__ import annotations

import math

import bpy
from bpy.types import Context, Event, Operator

from ..scene import pose_guide as guide
from ..scene.settings import settings_of
from ..session import pose_guide
from ..session.calibrating import Calibrated
from ..session.job import Job
from ..session.new_files import takes_folder
from ..session.pose_guide import pose_guide_job
from ..session.steps import Steps
from .calibrate import use_calibration
from .job_operator import JobOperator
from .live import connected


class SPARSEMOCAP_OT_calibrate_by_poses(JobOperator, Operator):
    """Find how trackers with an orientation sit on the body, from eight poses."""

    bl_idname = "sparse_mocap.calibrate_by_poses"
    bl_label = "Calibrate by Poses"
    bl_description = (
        "Find how trackers that tell their orientation sit on the body. The viewport shows the "
        "performer eight poses to imitate, one after the other; face the same way in all"
    )
    bl_options = {"REGISTER", "UNDO"}

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Start the job and show the poses in the viewport."""
        done = super().invoke(context, event)
        if "RUNNING_MODAL" in done:
            guide.show()
        return done

    def prepare(self, context: Context) -> Job:
        """Guide the performer."""
        folder = takes_folder(bpy.data.filepath, settings_of(context.scene).folder)
        return pose_guide_job(connected(), folder)

    def apply(self, context: Context, result: Calibrated) -> Steps[str]:
        """Use the calibration from now on, in a running live preview too."""
        yield 0.0
        use_calibration(self, context, result)
        return f"Calibrated {len(result.calibration.sensors)} trackers, saved as {result.path}"

    def shown(self, job: Job) -> tuple[object, ...]:
        """The pose and its countdown too."""
        now = pose_guide.shown
        countdown = (now.pose, now.is_held, math.ceil(now.seconds), now.problem)
        return (*super().shown(job), *countdown)

    def _end(self, context: Context) -> None:
        super()._end(context)
        guide.hide()


CLASSES = (SPARSEMOCAP_OT_calibrate_by_poses,)
