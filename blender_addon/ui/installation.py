# SPDX-License-Identifier: GPL-3.0-or-later
"""What is in the sidebar when the add-on cannot work: why, and a report to copy."""

from __future__ import annotations

import bpy
from bpy.types import Context, Panel

from ..ops import copy_report
from ..session.installation import Problem
from . import text


class SPARSEMOCAP_PT_installation(Panel):
    """The only panel when the add-on cannot work."""

    bl_idname = "SPARSEMOCAP_PT_installation"
    bl_label = "Sparse Mocap"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Sparse Mocap"

    def draw(self, context: Context) -> None:
        """The reason and the button."""
        for problem in copy_report.problems:
            text.error(self.layout, context, problem.reason)
        self.layout.operator("sparse_mocap.copy_report", icon="COPYDOWN")


CLASSES = (*copy_report.CLASSES, SPARSEMOCAP_PT_installation)


def register(problem: Problem) -> None:
    """Register the panel that shows the problem."""
    copy_report.problems[:] = [problem]
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    """Unregister the panel, unless another copy of the add-on has replaced it."""
    copy_report.problems.clear()
    for cls in reversed(CLASSES):
        if cls.is_registered:
            bpy.utils.unregister_class(cls)


def is_shown() -> bool:
    """Whether the panel is shown instead of those of the steps."""
    return bool(copy_report.problems)
