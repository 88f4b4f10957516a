# SPDX-License-Identifier: GPL-3.0-or-later
"""The first five minutes: a starter set, and a try without files and sensors."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy
from bpy.types import Context, Operator

from ..scene import compat, overlay
from ..scene.demo import look_at, nothing_left_on_error, performer_steps, rigify_character
from ..scene.performance import extend_scene, perform_steps
from ..scene.settings import settings_of
from ..scene.takes import add_take
from ..scene.targets import placement_of
from ..session.bake import placed
from ..session.demo import Demonstration, starter_set_job, try_it_job
from ..session.job import Job
from ..session.new_files import starter_set, takes_folder
from ..session.steps import Steps, part
from .job_operator import JobOperator
from .live import leave_live

_START_FRAME = 1.0


class SPARSEMOCAP_OT_make_starter_set(JobOperator, Operator):
    """Make a motion database of generated movements."""

    bl_idname = "sparse_mocap.make_starter_set"
    bl_label = "Make Starter Set"
    bl_description = (
        "Make a motion database of generated movements: walk, jog, turn, kick, squat, jumping jack "
        "and others. It is there to try things out, not for finished animation"
    )
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context: Context) -> Job:
        """Into the folder of the preferences."""
        return starter_set_job(_starter_set(context))

    def apply(self, context: Context, result: str) -> Steps[str]:
        """Use it."""
        yield 0.0
        settings_of(context.scene).database = result
        return f"The starter set is {result}"


class SPARSEMOCAP_OT_try_it(JobOperator, Operator):
    """Reconstruct a simulated performer on a Rigify character."""

    bl_idname = "sparse_mocap.try_it"
    bl_label = "Try It"
    bl_description = (
        "Let a simulated performer (blue) do generated movements with four simulated sensors, and "
        "put what is reconstructed from these on a Rigify character (orange). "
        "No file and no sensor is needed"
    )
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context: Context) -> Job:
        """Perform and reconstruct."""
        settings = settings_of(context.scene)
        folder = takes_folder(bpy.data.filepath, settings.folder)
        return try_it_job(_starter_set(context), folder)

    def apply(self, context: Context, result: Demonstration) -> Steps[str]:
        """Make the character and the performer, and play."""
        leave_live()
        yield 0.0
        with nothing_left_on_error():
            performing = performer_steps(context, result.performed, _START_FRAME)
            performer: Any = yield from part(performing, 0.0, 0.4)
            performer_name = performer.name
            character = rigify_character(context)
            yield 0.5
            targets = [] if character is None else [character]
            placement = placement_of(context, targets, start_frame=_START_FRAME, whole_frames=True)
            take = placed(result.performance, placement, lambda *_: True)
            armature: Any = yield from part(perform_steps(context, take, None), 0.5, 0.5)
        settings = settings_of(context.scene)
        if not settings.database:
            settings.database = result.database
        settings.target = character
        add_take(context.scene, result.take, result.loaded, result.performance.match.label)
        extend_scene(context, take)
        overlay.show(context, bpy.data.objects[performer_name])
        armature.select_set(False)  # without outlines the body is seen better
        look_at(context, result.performed)
        context.scene.frame_set(int(_START_FRAME))
        compat.play(context, is_wanted=True)
        return (
            f'"{armature.name}" does what four simulated sensors say '
            f'that "{performer_name}" does; match: {result.performance.match.label}'
        )


def _starter_set(context: Context) -> Path:
    folder = settings_of(context.scene).folder
    return starter_set(bpy.path.abspath(folder) if folder else "")


CLASSES = (SPARSEMOCAP_OT_make_starter_set, SPARSEMOCAP_OT_try_it)
