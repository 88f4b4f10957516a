# SPDX-License-Identifier: GPL-3.0-or-later
"""Copies what a bug report needs, whether all works or not; needs neither NumPy nor the core."""

from __future__ import annotations

from collections.abc import Callable

from bpy.types import Context, Operator

from ..scene.translations import tr_line
from ..session import core
from ..session.installation import Problem
from ..session.installation_report import report

problems: list[Problem] = []
"""Why the add-on cannot work, if it cannot."""
more_facts: list[Callable[[Context], tuple[str, ...]]] = []
"""Says what is open and chosen, while the add-on works."""


class SPARSEMOCAP_OT_copy_report(Operator):
    """Copy what a bug report needs to the clipboard."""

    bl_idname = "sparse_mocap.copy_report"
    bl_label = "Copy Report"
    bl_description = (
        "Copy versions, folders, settings and the newest lines of the log to the clipboard, for a "
        "bug report. Names of people are left out"
    )

    def execute(self, context: Context) -> set[str]:
        """Copy the report."""
        addon = __name__.removesuffix(".ops.copy_report")
        facts = [fact for tell in more_facts for fact in tell(context)]
        context.window_manager.clipboard = report(
            problems[0] if problems else None,
            core.ADDON,
            addon,
            core.searched_folders(),
            tuple(facts),
        )
        self.report({"INFO"}, tr_line("Copied the report"))
        return {"FINISHED"}


CLASSES = (SPARSEMOCAP_OT_copy_report,)
