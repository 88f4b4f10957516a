# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies what is wrong with the installation; needs neither NumPy nor the core."""

from __future__ import annotations

from bpy.types import Context, Operator

from ..session import core
from ..session.installation import Problem
from ..session.installation_report import report

problems: list[Problem] = []  # the one that is shown


class SPARSEMOCAP_OT_copy_report(Operator):
    """Copy what a bug report needs to the clipboard."""

    bl_idname = "sparse_mocap.copy_report"
    bl_label = "Copy Report"
    bl_description = "Copy versions, folders and the reason to the clipboard, for a bug report"

    def execute(self, context: Context) -> set[str]:
        """Copy the report."""
        addon = __name__.removesuffix(".ops.copy_report")
        [problem] = problems
        context.window_manager.clipboard = report(
            problem, core.ADDON, addon, core.searched_folders()
        )
        self.report({"INFO"}, "Copied the report")
        return {"FINISHED"}


CLASSES = (SPARSEMOCAP_OT_copy_report,)
