# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that are done at once, some after the file browser."""

from __future__ import annotations

from collections.abc import Callable

from bpy.props import StringProperty
from bpy.types import Context, Event

from ..scene.translations import tr_line
from ..session.errors import one_line


class NowOperator:
    """Mix-in: act() does the work at once; its message or error is reported in one line."""

    report: Callable[[set[str], str], None]  # the operator's own

    def act(self, context: Context) -> str:
        """Do the work; returns what to report."""
        raise NotImplementedError

    def execute(self, context: Context) -> set[str]:
        """Do the work, and report what came of it."""
        try:
            message = self.act(context)
        except Exception as error:
            self.report({"ERROR"}, tr_line(one_line(error)))
            return {"CANCELLED"}
        if message:
            self.report({"INFO"}, tr_line(message))
        return {"FINISHED"}


class FileOperator(NowOperator):
    """Mix-in: opens the file browser first; act() finds the file in filepath.

    Each operator says in filter_glob which files the browser lists.
    """

    filepath: StringProperty(name="File", subtype="FILE_PATH", options={"SKIP_SAVE"})

    def invoke(self, context: Context, event: Event) -> set[str]:
        """Open the file browser."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}
