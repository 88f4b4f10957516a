# SPDX-License-Identifier: GPL-3.0-or-later
"""Step 3: the take as an action on an armature."""

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty
from bpy.types import Context, Event, Operator

from ..scene.armature import reusable_armature
from ..scene.performance import perform_steps
from ..scene.settings import options_text, settings_of
from ..session.job import Job
from ..session.methods import Items, choice_of, default_of, option_items
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

    method: StringProperty(name="Method", options=SKIP)
    preset: StringProperty(name="Preset", options=SKIP)
    options: StringProperty(
        name="Options", description="NAME=VALUE, separated by commas", options=SKIP
    )
    offline: BoolProperty(
        name="Best quality", description="Use the whole take for every frame", options=SKIP
    )
    start_frame: FloatProperty(name="Start frame", default=1.0, options=SKIP)
    reuse_armature: BoolProperty(name="Reuse armature", options=SKIP)

    def prepare(self, context: Context) -> Job:
        """Reconstruct the scene's take from the scene's database."""
        settings = settings_of(context.scene)
        is_chosen = self.properties.is_property_set
        if not (is_chosen("method") or is_chosen("preset")):
            self.method, self.preset = settings.method, settings.preset
        if not is_chosen("options"):
            self.options = options_text(settings)
        self.fill_from_scene(context, "offline", "start_frame", "reuse_armature")
        choice, renamed = choice_of(self.method, self.preset, self.options)
        if renamed:
            self.report({"WARNING"}, renamed)
        job = reconstruct_job(
            bpy.path.abspath(settings.database),
            bpy.path.abspath(settings.take),
            bpy.path.abspath(settings.calibration),
            choice=choice,
            best_quality=self.offline,
        )
        if self.reuse_armature:
            reusable_armature(context)  # before the work, so that an error comes at once
        return job

    def apply(self, context: Context, result: Performance) -> Steps[str]:
        """Create one action, on a new armature or an existing one."""
        if result.is_guess:
            self.report(
                {"WARNING"},
                "The motion database has nothing like this take, so the motion is a guess",
            )
        armature = yield from perform_steps(
            context, result, self.start_frame, reuse=self.reuse_armature
        )
        action = armature.animation_data.action
        return (
            f'"{action.name}" on "{armature.name}": {result.duration_s:.1f} s, '
            f"sensors match: {result.match}"
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
