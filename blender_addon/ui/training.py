# SPDX-License-Identifier: GPL-3.0-or-later
"""The trained model in the sidebar, and what one phone records."""

from __future__ import annotations

import bpy
from bpy.types import Context, Panel, UILayout

from ..scene import latent_view
from ..scene.settings import SPARSEMOCAP_PG_settings, settings_of
from ..scene.translations import tr
from ..session.core import missing_reason
from ..session.methods import models, needs_model
from ..session.training import PHASES, TRAINING
from . import text
from .step import StepPanel, action_button, redraw_soon


class SPARSEMOCAP_PT_model(StepPanel, Panel):
    """The model in use, and a form to train one; for methods that need one."""

    bl_idname = "SPARSEMOCAP_PT_model"
    bl_label = "Trained Model"
    bl_parent_id = "SPARSEMOCAP_PT_reconstruct"

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only for methods that need a model."""
        return not missing_reason() and needs_model(settings_of(context.scene).method)

    def draw(self, context: Context) -> None:
        """The file, what it knows, and the form."""
        settings = settings_of(context.scene)
        row = self.layout.row(align=True)
        row.prop(settings.training, "model", text="")
        row.operator("sparse_mocap.open_model", text="", icon="FILE_FOLDER")
        if settings.training.model:
            _contents(self.layout, context, settings)
        _form(self.layout.box(), context, settings)
        _phone(self.layout.box(), settings)


def _contents(layout: UILayout, context: Context, settings: SPARSEMOCAP_PG_settings) -> None:
    entry = models.peek(bpy.path.abspath(settings.training.model))
    if entry.is_opening:
        layout.label(text="Opening the model", icon="SORTTIME")
        redraw_soon()
        return
    if entry.value is None:
        text.error(layout, context, entry.error)
        return
    views = latent_view.views(context)
    found = sorted({int(phase) for view in views for phase in set(view.phases.tolist())})
    names = ", ".join(view.name for view in views if view.name)
    rows = [("Types", names)] if names else []
    rows.append(("Frames", str(sum(len(view.points) for view in views))))
    text.facts(layout, context, rows)
    phases = ", ".join(PHASES[phase].replace("_", " ") for phase in found)
    text.paragraph(layout, context, f"{tr('Phases')}: {phases}")
    layout.operator(
        "sparse_mocap.toggle_latent_view", icon="SHADERFX", depress=latent_view.is_shown()
    )


def _form(box: UILayout, context: Context, settings: SPARSEMOCAP_PG_settings) -> None:
    training = settings.training
    box.label(text="Train on the database")
    column = box.column()
    column.use_property_split = True
    column.use_property_decorate = False
    column.enabled = bool(settings.database)
    column.prop(training, "classes")
    row = column.row(align=True)
    row.prop(training, "clips")
    row.operator("sparse_mocap.add_training_clip", text="", icon="ADD")
    row = column.row(align=True)
    row.prop(training, "phases")
    row.operator("sparse_mocap.write_phases", text="", icon="TEXT")
    column.prop(training, "output")
    action_button(
        box, "sparse_mocap.train_model", "MODIFIER", TRAINING, is_ready=bool(settings.database),
        is_main=not training.model,
    )  # fmt: skip
    if not settings.database:
        text.paragraph(box, context, tr("Choose a motion database first"), icon="INFO")


def _phone(box: UILayout, settings: SPARSEMOCAP_PG_settings) -> None:
    box.label(text="One phone")
    column = box.column()
    column.use_property_split = True
    column.use_property_decorate = False
    column.prop(settings.training, "phone_site")
    row = box.row(align=True)
    row.operator("sparse_mocap.import_phone", text=tr("Load"), translate=False, icon="IMPORT")
    row.operator("sparse_mocap.use_phone_stream", text="Stream", icon="LINKED")


CLASSES = (SPARSEMOCAP_PT_model,)
