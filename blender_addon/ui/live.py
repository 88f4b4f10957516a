# SPDX-License-Identifier: GPL-3.0-or-later
"""Real sensors in the sidebar. Drawing never waits for a device."""

from __future__ import annotations

from bpy.types import Context, Panel, UILayout

from ..scene import live as live_scene
from ..scene.settings import settings_of
from ..scene.translations import tr
from ..session import live, sensors
from ..session.calibrating import CALIBRATING
from ..session.core import missing_reason
from ..session.live import LiveSession, LiveState
from ..session.port_scanner import port_scanner
from . import sensors as sensor_panels
from . import text
from .step import StepPanel, action_button, job_is_running, redraw_soon


class SPARSEMOCAP_PT_live(StepPanel, Panel):
    """The connected sensors, or the settings to connect them."""

    bl_idname = "SPARSEMOCAP_PT_live"
    bl_label = "Live Sensors"
    bl_order = 4
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only when the core is installed."""
        return not missing_reason()

    def draw_header_preset(self, context: Context) -> None:
        """A mark while recording, visible even when the panel is closed."""
        session = live.current()
        if session is not None and session.is_running:
            is_recording = session.state.recording is not None
        else:
            captures = port_scanner.latest().captures
            is_recording = any(found.recording_s is not None for found in captures)
            if port_scanner.is_scanning:
                redraw_soon()
        if is_recording:
            self.layout.label(text="", icon="REC")

    def draw(self, context: Context) -> None:
        """The port settings, or the state of the sensors."""
        session = live.current()
        if session is not None and session.is_running:
            _session(self.layout, context, session)
            return
        if session is not None and session.state.error:
            text.error(self.layout, context, session.state.error)
        _choices(self.layout, context)
        _last_take(self.layout, context)


def _choices(layout: UILayout, context: Context) -> None:
    result, settings = port_scanner.result, settings_of(context.scene)
    if result.error:
        text.error(layout, context, result.error)
    for found in result.captures:
        box = layout.box()
        text.paragraph(
            box, context, found.text, icon="INFO" if found.recording_s is None else "REC"
        )
        box.operator("sparse_mocap.attach_sensors", icon="LINKED").pid = found.pid
    sensor_panels.ports(layout, context)
    row = layout.row()
    row.scale_y = 1.5
    row.enabled = bool(settings.port)
    row.operator("sparse_mocap.connect_sensors", icon="LINKED")


def _session(layout: UILayout, context: Context, session: LiveSession) -> None:
    state = session.state
    row = layout.row()
    icon = "LINKED" if state.is_connected else "SORTTIME"
    row.label(text=session.label, icon=icon, translate=False)
    row.operator("sparse_mocap.disconnect_sensors", text="", icon="X")
    if not state.is_connected:
        layout.label(text="Connecting")
        return
    sensor_panels.links(layout, context, state)
    sensor_panels.table(layout, context, state)
    _live(layout, context, session)
    if not job_is_running(CALIBRATING):
        _recording(layout, context, state)


def _live(layout: UILayout, context: Context, session: LiveSession) -> None:
    state, quality = session.state, session.state.quality
    has_database = bool(settings_of(context.scene).database)
    _character(layout, context)
    if session.is_live_wanted:
        row = layout.row()
        row.scale_y = 1.5
        row.operator("sparse_mocap.leave_live", icon="PAUSE", depress=True)
    else:
        is_ready = has_database and bool(state.sensors)
        action_button(
            layout, "sparse_mocap.go_live", "PLAY", sensors.STARTING_LIVE, is_ready=is_ready
        )
        if not has_database:
            text.paragraph(layout, context, "Choose a motion database first", icon="INFO")
    if state.no_readings and session.is_live_wanted:
        text.error(layout, context, state.no_readings)
    if state.warning and session.is_live_wanted:
        text.error(layout, context, state.warning)
    if session.is_live_wanted and quality.num_poses and not state.no_readings:
        rows = [
            ("Match", tr(quality.match)),
            ("Delay", f"{1e3 * quality.latency_s:.0f} ms"),
        ]
        dropped = quality.num_skipped + state.num_dropped
        if dropped:
            rows.append(("Skipped", tr("{count} poses").format(count=dropped)))
        text.facts(layout, rows)


def _character(layout: UILayout, context: Context) -> None:
    """Whom the live preview moves, and where it stands."""
    settings, is_followed = settings_of(context.scene), live_scene.followed() is not None
    row = layout.row()
    row.enabled = not is_followed
    row.prop(settings, "target", icon="ARMATURE_DATA")
    row = layout.row(align=True)
    row.prop(settings, "in_place", toggle=True)
    buttons = row.row(align=True)
    buttons.enabled = is_followed
    buttons.operator("sparse_mocap.recentre")
    buttons.operator("sparse_mocap.face_front")
    if live_scene.ended_because():
        text.error(layout, context, live_scene.ended_because())


def _recording(layout: UILayout, context: Context, state: LiveState) -> None:
    if state.recording is None:
        row = layout.row()
        row.scale_y = 1.5
        row.operator("sparse_mocap.record_or_stop", text="Record", icon="REC")
        settings = settings_of(context.scene)
        row = layout.row(align=True)
        row.prop(settings, "countdown_s")
        row.prop(settings, "record_plays", text="", icon="PLAY", toggle=True)
    else:
        action_button(
            layout, "sparse_mocap.stop_take", "SNAP_FACE", sensors.SAVING_TAKE, is_ready=True
        )
        text.paragraph(
            layout,
            context,
            tr("Recording: {duration}. It continues even if Blender quits").format(
                duration=text.duration(state.recording["seconds"])
            ),
            icon="REC",
        )
    _last_take(layout, context)


def _last_take(layout: UILayout, context: Context) -> None:
    if sensors.last_takes:
        saved = tr("Saved: {path}").format(path=sensors.last_takes[0])
        text.paragraph(layout, context, saved, icon="FILE_TICK")


CLASSES = (SPARSEMOCAP_PT_live,)
