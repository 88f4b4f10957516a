# SPDX-License-Identifier: GPL-3.0-or-later
"""Recording with a countdown, in step with the timeline, and by a shortcut."""

from __future__ import annotations

import math
import time
from typing import Any

import bpy
from bpy.types import Context, Event, Operator

from ..scene import compat, prompt
from ..scene.settings import settings_of
from ..scene.translations import tr_line
from ..session.errors import one_line
from ..session.live import answer_of
from .live import connected

_TICK_S = 0.1
_ANSWER_S = 1.0


class SPARSEMOCAP_OT_record_or_stop(Operator):
    """Record after the countdown; stop when a recording is running."""

    bl_idname = "sparse_mocap.record_or_stop"
    bl_label = "Record or Stop"
    bl_description = (
        "Record the sensors after the countdown, or stop the recording. "
        "The recording continues even if Blender quits"
    )
    bl_options = {"REGISTER"}

    _timer: Any = None
    _end_s = 0.0

    def invoke(self, context: Context, _: Event) -> set[str]:
        """Count down in large letters, end the countdown, or stop at once."""
        try:
            state = connected().state
        except Exception as error:
            self.report({"ERROR"}, tr_line(one_line(error)))
            return {"CANCELLED"}
        if state.recording is not None:
            bpy.ops.sparse_mocap.stop_take("INVOKE_DEFAULT", True)
            return {"FINISHED"}
        if prompt.countdown_s() > 0:
            prompt.show_countdown(0)
            return {"FINISHED"}
        seconds = settings_of(context.scene).countdown_s
        if seconds == 0 or bpy.app.background:
            return self.execute(context)
        self._end_s = time.perf_counter() + seconds
        self._timer = context.window_manager.event_timer_add(_TICK_S, window=context.window)
        context.window_manager.modal_handler_add(self)
        prompt.show_countdown(seconds)
        return {"RUNNING_MODAL"}

    def modal(self, context: Context, event: Event) -> set[str]:
        """Record when the time has come; Esc, or to press Record again, leaves nothing."""
        is_escape = event.type == "ESC" and event.value == "PRESS"
        if is_escape or prompt.countdown_s() == 0:
            self._leave(context)
            self.report({"INFO"}, tr_line("Nothing was recorded"))
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        left_s = self._end_s - time.perf_counter()
        prompt.show_countdown(max(math.ceil(left_s), 0))
        compat.redraw_views(context)
        if left_s > 0.0:
            return {"PASS_THROUGH"}
        self._leave(context)
        return self.execute(context)

    def cancel(self, context: Context) -> None:
        """Called by Blender when its window closes or another file is opened."""
        self._leave(context)

    def execute(self, context: Context) -> set[str]:
        """Start recording now, and the timeline where the take is to begin."""
        settings = settings_of(context.scene)
        try:
            answer_of(connected().record(), _ANSWER_S)
        except Exception as error:
            self.report({"ERROR"}, tr_line(one_line(error)))
            return {"CANCELLED"}
        if settings.record_plays:
            settings.start_frame = float(context.scene.frame_current)
            compat.play(context, is_wanted=True)
        self.report({"INFO"}, tr_line("Recording"))
        return {"FINISHED"}

    def _leave(self, context: Context) -> None:
        prompt.show_countdown(0)
        timer, self._timer = self._timer, None
        if timer is not None:
            context.window_manager.event_timer_remove(timer)
        compat.redraw_views(context)


_shortcuts: list[tuple[Any, Any]] = []


def add_shortcut() -> None:
    """Ctrl Alt R in the 3D view; the user may change it in the preferences."""
    keyconfig = bpy.context.window_manager.keyconfigs.addon
    if keyconfig is None:  # in the background
        return
    keymap = keyconfig.keymaps.new(name="3D View", space_type="VIEW_3D")
    item = keymap.keymap_items.new(
        SPARSEMOCAP_OT_record_or_stop.bl_idname, "R", "PRESS", ctrl=True, alt=True
    )
    _shortcuts.append((keymap, item))


def remove_shortcut() -> None:
    """Remove it."""
    while _shortcuts:
        keymap, item = _shortcuts.pop()
        keymap.keymap_items.remove(item)


CLASSES = (SPARSEMOCAP_OT_record_or_stop,)
