# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 3: the take as an action on an armature."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty
from bpy.types import Context, Operator

from ..scene.armature import reusable_armature
from ..scene.performance import perform_steps
from ..scene.settings import PRESETS, settings_of
from ..session.job import Job
from ..session.reconstruct import Performance, reconstruct_job
from ..session.steps import Steps
from .job_operator import JobOperator

SKIP = {"SKIP_SAVE"}


class SPARSEMOCAP_OT_reconstruct(JobOperator, Operator):
    """Reconstruct the full-body motion of the take as an action on an armature."""

    bl_idname = "sparse_mocap.reconstruct"
    bl_label = "Reconstruct"
    bl_description = "Reconstruct the full-body motion of the take as an action on an armature"
    bl_options = {"REGISTER", "UNDO"}

    preset: EnumProperty(name="Preset", items=PRESETS, options=SKIP)
    offline: BoolProperty(name="Offline", options=SKIP)
    start_frame: FloatProperty(name="Start frame", default=1.0, options=SKIP)
    reuse_armature: BoolProperty(name="Reuse armature", options=SKIP)

    def prepare(self, context: Context) -> Job:
        """Reconstruct the scene's take from the scene's database."""
        settings = settings_of(context.scene)
        self.fill_from_scene(context, "preset", "offline", "start_frame", "reuse_armature")
        job = reconstruct_job(
            bpy.path.abspath(settings.database),
            bpy.path.abspath(settings.take),
            bpy.path.abspath(settings.calibration),
            preset=self.preset,
            offline=self.offline,
        )
        if self.reuse_armature:
            reusable_armature(context)  # better said before the work than after it
        return job

    def apply(self, context: Context, result: Performance) -> Steps[str]:
        """One action, on a new armature or on one that is there."""
        if result.is_guess:
            self.report({"WARNING"}, "The database holds nothing like this take: it is a guess")
        armature = yield from perform_steps(
            context, result, self.start_frame, reuse=self.reuse_armature
        )
        action = armature.animation_data.action
        return (
            f'"{action.name}" on "{armature.name}": {result.duration_s:.1f} s, '
            f"sensor misfit {result.misfit_mps2:.2f} m/s²"
        )


CLASSES = (SPARSEMOCAP_OT_reconstruct,)
