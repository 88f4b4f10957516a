# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 3: the take as an action on an armature."""

from typing import Any

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy.types import Context, Event, Operator

from ..scene.armature import reusable_armature
from ..scene.performance import extend_scene, perform_steps
from ..scene.settings import options_text, settings_of
from ..scene.takes import take_of
from ..scene.targets import chosen_armatures, held_warning, own_figure, placement_of
from ..scene.translations import tr_line
from ..session.bake import PlacedTake, placed
from ..session.job import Job
from ..session.methods import (
    Items,
    choice_of,
    default_of,
    has_best_quality,
    option_items,
    with_alternatives,
)
from ..session.reconstruct import reconstruct_job
from ..session.steps import Steps
from .job_operator import JobOperator
from .live import leave_live

SKIP = {"SKIP_SAVE"}


class SPARSEMOCAP_OT_reconstruct(JobOperator, Operator):
    """Reconstruct the full-body motion of the take as an action on an armature."""

    bl_idname = "sparse_mocap.reconstruct"
    bl_label = "Reconstruct"
    bl_description = "Reconstruct the full-body motion of the take as an action on an armature"
    bl_options = {"REGISTER", "UNDO"}

    method: StringProperty(name="Method", options=SKIP)
    preset: StringProperty(name="Preset", options=SKIP)
    options: StringProperty(
        name="Options", description="NAME=VALUE, separated by commas", options=SKIP
    )
    offline: BoolProperty(
        name="Best quality", description="Use the whole take for every frame", options=SKIP
    )
    alternatives: BoolProperty(
        name="Alternatives",
        description="Also find other motions that fit the sensors almost as well",
        options=SKIP,
    )
    start_frame: FloatProperty(name="Start frame", default=1.0, options=SKIP)
    reuse_armature: BoolProperty(name="Reuse armature", options=SKIP)
    whole_frames: BoolProperty(name="Whole frames", default=True, options=SKIP)
    extend_scene: BoolProperty(name="Extend scene", options=SKIP)

    _figure = ""

    def prepare(self, context: Context) -> Job:
        """Reconstruct the scene's take from the scene's database."""
        settings = settings_of(context.scene)
        is_chosen = self.properties.is_property_set
        if not (is_chosen("method") or is_chosen("preset")):
            self.method, self.preset = settings.method, settings.preset
        if not is_chosen("options"):
            self.options = options_text(settings)
        self.fill_from_scene(
            context, "offline", "alternatives", "start_frame", "reuse_armature", "whole_frames",
            "extend_scene",
        )  # fmt: skip
        model = bpy.path.abspath(settings.training.model)
        choice, renamed = choice_of(self.method, self.preset, self.options, model)
        is_best = self.offline and has_best_quality(choice.method)
        if self.alternatives and is_best:
            choice = with_alternatives(choice)
        if renamed:
            self.report({"WARNING"}, tr_line(renamed))
        armatures = chosen_armatures(context)
        if self.reuse_armature and not armatures:
            armatures = [reusable_armature(context)]
        figure = own_figure(armatures)
        self._figure = figure.name if figure is not None else ""
        placement = placement_of(
            context, armatures, start_frame=self.start_frame, whole_frames=self.whole_frames
        )
        return reconstruct_job(
            bpy.path.abspath(settings.database),
            bpy.path.abspath(settings.take),
            bpy.path.abspath(settings.calibration),
            choice=choice,
            best_quality=is_best,
            finish=lambda performance, progress: placed(performance, placement, progress),
        )

    def apply(self, context: Context, result: PlacedTake) -> Steps[str]:
        """Create one action for each character, or on the add-on's own figure."""
        performance = result.performance
        if performance.match.is_guess:
            self.report(
                {"WARNING"},
                tr_line("The motion database has nothing like this take, so the motion is a guess"),
            )
        for note in performance.notes:
            self.report({"INFO"}, note[:1].upper() + note[1:])
        for target in result.placement.targets:
            if target.held:
                self.report({"WARNING"}, tr_line(held_warning(target)))
        leave_live()
        armature: Any = yield from perform_steps(
            context, result, bpy.data.objects.get(self._figure)
        )
        if self.extend_scene:
            extend_scene(context, result)
        row = take_of(context.scene)
        if row is not None:
            row.match = performance.match.label
            others = [other.letter for other in performance.alternatives]
            row.letters = "/".join([performance.letter, *others]) if others else ""
        action = armature.animation_data.action
        return (
            f'"{action.name}" on "{armature.name}": {performance.duration_s:.1f} s, '
            f"sensors match: {performance.match.label}"
        )


_kept_items: Items = []  # Blender does not keep the texts of menus that are made on the fly


def _options(_: Operator, context: Context | None) -> Items:
    if context is not None:
        _kept_items[:] = option_items(settings_of(context.scene).method)
    return _kept_items


class SPARSEMOCAP_OT_add_option(Operator):
    """Choose an option of the method, to give it another value than the default."""

    bl_idname = "sparse_mocap.add_option"
    bl_label = "Add Option"
    bl_description = "Give an option of the method another value than its default"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}
    bl_property = "option"

    option: EnumProperty(name="Option", items=_options)

    def invoke(self, context: Context, _: Event) -> set[str]:
        """Show the options to choose from."""
        context.window_manager.invoke_search_popup(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: Context) -> set[str]:
        """Add the option with its default value."""
        settings = settings_of(context.scene)
        if self.option not in settings.options:
            added = settings.options.add()
            added.name = self.option
            added.value = default_of(settings.method, self.option)
        return {"FINISHED"}


class SPARSEMOCAP_OT_remove_option(Operator):
    """Use the default of an option again."""

    bl_idname = "sparse_mocap.remove_option"
    bl_label = "Remove Option"
    bl_description = "Use the default value of this option again"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    index: IntProperty()

    def execute(self, context: Context) -> set[str]:
        """Remove the option from the list."""
        settings_of(context.scene).options.remove(self.index)
        return {"FINISHED"}


CLASSES = (
    SPARSEMOCAP_OT_reconstruct,
    SPARSEMOCAP_OT_add_option,
    SPARSEMOCAP_OT_remove_option,
)
