# SPDX-License-Identifier: GPL-3.0-or-later
"""The import dialog's options, the entries of File > Import and drag and drop."""

from __future__ import annotations

import os
from typing import Any

import bpy
from bpy.types import Context, UILayout

from ..scene import compat
from ..scene.translations import tr
from ..session.core import missing_reason
from ..session.imported import USUAL_SIZES_M, file_summaries
from . import text
from .step import redraw_soon

UNITS = (
    (
        "FILE",
        "From the file",
        "The unit stored in an .asf; centimetres for .bvh, which stores none",
    ),
    ("CM", "Centimetres", "100 units are one metre"),
    ("M", "Metres", "1 unit is one metre"),
    ("DM", "Decimetres", "10 units are one metre, as in MakeHuman"),
    ("MM", "Millimetres", "1000 units are one metre"),
    ("INCH", "Inches", "1 unit is 2.54 cm"),
    ("CMU", "Inches / 0.45", "1 unit is 5.64 cm, as in the CMU and HDM05 databases"),
)
UP_AXES = (
    ("Y", "Y", "Y points up, as in most motion files"),
    ("Z", "Z", "Z points up, as in Blender"),
    ("X", "X", "X points up"),
)
_UNITS_M = {"CM": 0.01, "M": 1.0, "DM": 0.1, "MM": 0.001, "INCH": 0.0254, "CMU": 0.0254 / 0.45}
_DROPPED = (("bvh", "Motion Capture BVH", ".bvh"), ("acclaim", "Acclaim", ".asf;.amc"))


def unit_m(unit: str) -> float | None:
    """The unit in metres; None: the unit stored in the file."""
    return _UNITS_M.get(unit)


def draw_options(operator: Any, context: Context) -> None:
    """The options of an import operator, and the file's size with them."""
    layout = operator.layout
    layout.use_property_split = True
    layout.use_property_decorate = False
    paths = operator.paths()
    if context.area is None or context.area.type != "FILE_BROWSER":
        name = tr("{count} files").format(count=len(paths))
        if len(paths) == 1:
            name = os.path.basename(paths[0])
        layout.label(text=name, icon="FILE", translate=False)
    column = layout.column()
    column.prop(operator, "unit")
    column.row().prop(operator, "up_axis", expand=True)
    column = layout.column()
    if "amc_rate_hz" in operator.bl_rna.properties:
        column.prop(operator, "amc_rate_hz")
    column.prop(operator, "start_frame")
    column = layout.column()
    column.use_property_split = False
    column.prop(operator, "keep_timing")
    column.prop(operator, "standard_skeleton")
    path = _shown_path(operator, context)
    if path.lower().endswith(operator.endings):
        _draw_summary(layout, context, path, unit_m(operator.unit), operator)


def _shown_path(operator: Any, context: Context) -> str:
    """The selected file in the file browser, else the first dropped file."""
    parameters = getattr(context.space_data, "params", None)
    if parameters is not None and hasattr(parameters, "filename"):
        folder = parameters.directory
        folder = folder.decode(errors="surrogateescape") if isinstance(folder, bytes) else folder
        return f"{folder}{parameters.filename}"
    return next(iter(operator.paths()), "")


def _draw_summary(
    layout: UILayout, context: Context, path: str, unit: float | None, operator: Any
) -> None:
    entry = file_summaries.peek(path)
    if entry.is_opening:
        layout.label(text="Reading the file", icon="SORTTIME")
        redraw_soon()
    elif (summary := entry.value) is None:
        text.error(layout, context, entry.error)
    else:
        size_m = summary.size_with(unit)
        rows = [("Joints", str(summary.num_joints))]
        if summary.num_frames > 0:
            rate_hz = getattr(operator, "amc_rate_hz", summary.rate_hz)
            rows.append(("Frames", f"{summary.num_frames:,}"))
            rows.append(("Length", text.duration((summary.num_frames - 1) / rate_hz)))
        rows.append(("Size", f"{size_m:.3g} m"))
        text.facts(layout, context, rows)
        if not USUAL_SIZES_M[0] <= size_m <= USUAL_SIZES_M[1]:
            text.paragraph(
                layout, context, "This is not the size of a person: check the unit", icon="ERROR"
            )


def draw_menu(menu: Any, _: Context) -> None:
    """The entries of File > Import."""
    if not missing_reason():
        menu.layout.operator("sparse_mocap.import_bvh", text="Motion Capture BVH (.bvh)")
        menu.layout.operator("sparse_mocap.import_acclaim", text="Acclaim (.asf/.amc)")


_handlers = [
    compat.file_handler(f"SPARSEMOCAP_FH_{name}", label, f"sparse_mocap.import_{name}", endings)
    for name, label, endings in _DROPPED
    if compat.HAS_FILE_HANDLERS
]


def register() -> None:
    """Add the menu entries and the drag and drop handlers."""
    bpy.types.TOPBAR_MT_file_import.append(draw_menu)
    for handler in _handlers:
        bpy.utils.register_class(handler)


def unregister() -> None:
    """Remove both."""
    for handler in _handlers:
        bpy.utils.unregister_class(handler)
    bpy.types.TOPBAR_MT_file_import.remove(draw_menu)
