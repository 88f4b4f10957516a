# SPDX-License-Identifier: GPL-3.0-or-later
"""Teaching in the sidebar: a motion, its take, and what came of the last ones."""

from __future__ import annotations

import bpy
from bpy.types import Context, UILayout

from ..scene.settings import settings_of
from ..scene.translations import tr, tr_line
from ..session.teaching import TEACHING, last_taught
from . import text
from .step import action_button, job_is_running

CHOOSERS = {
    "motion": "sparse_mocap.choose_taught_motion",
    "take": "sparse_mocap.choose_taught_take",
}


def draw_teaching(layout: UILayout, context: Context) -> None:
    """A box that is folded until it is needed."""
    settings = settings_of(context.scene)
    teaching = settings.teaching
    box = layout.box()
    is_open = teaching.is_open or job_is_running(TEACHING)
    row = box.row()
    row.alignment = "LEFT"
    icon = "TRIA_DOWN" if is_open else "TRIA_RIGHT"
    is_pressed = teaching.is_open  # which would make its text white
    row.prop(teaching, "is_open", icon=icon, emboss=False, invert_checkbox=is_pressed)
    if not is_open:
        return
    column = _column(box)
    for name, chooser in CHOOSERS.items():
        row = column.row(align=True)
        row.prop(teaching, name)
        row.operator(chooser, text="", icon="FILE_FOLDER")
    box.prop(teaching, "has_clap")  # too long for a column of a narrow sidebar
    if teaching.has_clap:
        column = _column(box)
        column.prop(teaching, "clap_from_s")
        column.prop(teaching, "clap_to_s")
    is_ready = bool(teaching.motion and teaching.take)
    action_button(box, "sparse_mocap.teach", "IMPORT", TEACHING, is_ready=is_ready)
    if not is_ready:
        hint = "Choose a motion, and the take that your sensors recorded during it"
        text.paragraph(box, context, hint, icon="INFO")
    _outcome(box, context, bpy.path.abspath(settings.database))


def _column(box: UILayout) -> UILayout:
    column = box.column()
    column.use_property_split = True
    column.use_property_decorate = False
    return column


def _outcome(box: UILayout, context: Context, database: str) -> None:
    """How well the last motion and its take matched, if the database in use has them."""
    taught = last_taught[0] if last_taught else None
    if taught is None or taught.path != database:
        return
    quality = tr(taught.quality)
    if text.is_wide(context):
        quality += f" ({taught.correlation:.2f})"
    text.facts(
        box,
        context,
        [
            ("Taught", taught.name),
            ("Agreement", quality),
            ("Begins at", f"{round(taught.begin_s, 2) + 0.0:.2f} s"),
        ],
    )
    for note in taught.notes:
        text.paragraph(box, context, tr_line(note), icon="INFO")
