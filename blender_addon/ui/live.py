# SPDX-License-Identifier: GPL-3.0-or-later
"""Real sensors in the sidebar. Drawing never waits for a device."""

from __future__ import annotations

from bpy.types import Context, Panel, UILayout

from ..scene import live as live_scene
from ..scene import prompt
from ..scene.armature import is_ours
from ..scene.settings import settings_of
from ..scene.translations import tr
from ..session import live, sensors
from ..session.core import missing_reason
from ..session.live import LiveSession, LiveState
from ..session.live_poses import Quality
from ..session.match import ODD_SENSOR, advice_for
from ..session.methods import missing_file
from ..session.names import shown_site
from ..session.port_scanner import port_scanner
from . import sensors as sensor_panels
from . import text
from .calibrate import is_calibrating
from .step import StepPanel, action_button, job_is_running, redraw_soon, waits_for


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
    if not settings.port:
        text.paragraph(layout, context, "Choose a port first", icon="INFO")


def _session(layout: UILayout, context: Context, session: LiveSession) -> None:
    """The connected sensors. Rows keep their places: what comes and goes is in the last panel."""
    state = session.state
    row = layout.row()
    row.label(
        text="Connected" if state.is_connected else "Connecting",
        icon="LINKED" if state.is_connected else "SORTTIME",
    )
    row.operator("sparse_mocap.disconnect_sensors", text="", icon="X")
    if not state.is_connected:
        text.paragraph(layout, context, session.label)
        return
    sensor_panels.links(layout, state)
    sensor_panels.table(layout, state)
    _character(layout, context)
    _live(layout, context, session)
    _recording(layout, context, state)
    _figures(layout, context, session)


def _character(layout: UILayout, context: Context) -> None:
    """Whom the live preview moves, and where it stands."""
    settings, is_followed = settings_of(context.scene), live_scene.followed() is not None
    row = layout.row()
    row.enabled = not is_followed
    row.prop(settings, "target", text="", icon="ARMATURE_DATA")
    row = layout.row()
    row.enabled = settings.target is not None and not is_ours(settings.target)
    row.prop(settings, "foot_lock")
    row = layout.row(align=True)
    row.prop(settings, "in_place", toggle=True)
    buttons = row.row(align=True)
    buttons.enabled = is_followed
    buttons.operator("sparse_mocap.recentre")
    buttons.operator("sparse_mocap.face_front", text="Front")


def _live(layout: UILayout, context: Context, session: LiveSession) -> None:
    settings = settings_of(context.scene)
    reason = missing_file(settings.method, settings.database, settings.training.model)
    if not reason and not session.state.sensors:
        reason = "Waiting for data"
    if not reason:
        reason = waits_for(sensors.STARTING_LIVE, sensors.SAVING_TAKE)
    if session.is_live_wanted:
        row = layout.row()
        row.scale_y = 1.5
        row.operator("sparse_mocap.leave_live", icon="PAUSE", depress=True)
    else:
        action_button(
            layout, "sparse_mocap.go_live", "PLAY", sensors.STARTING_LIVE,
            is_ready=not reason, has_details=False,
        )  # fmt: skip
    layout.label(text=reason, icon="INFO" if reason else "NONE")


def _recording(layout: UILayout, context: Context, state: LiveState) -> None:
    settings = settings_of(context.scene)
    is_recording = state.recording is not None and not is_calibrating()
    if is_recording or job_is_running(sensors.SAVING_TAKE):
        action_button(
            layout, "sparse_mocap.stop_take", "SNAP_FACE", sensors.SAVING_TAKE,
            is_ready=True, has_details=False,
        )  # fmt: skip
    else:
        left_s = prompt.countdown_s()
        row = layout.row()
        row.scale_y = 1.5
        row.enabled = not is_calibrating()
        row.operator(
            "sparse_mocap.record_or_stop",
            text=tr("Cancel: starts in {seconds} s").format(seconds=left_s) if left_s else "Record",
            icon="X" if left_s else "REC",
            depress=left_s > 0,
        )
    row = layout.row(align=True)
    row.enabled = not is_recording
    row.prop(settings, "countdown_s")
    row.prop(settings, "record_plays", text="", icon="PLAY", toggle=True)


def _figures(layout: UILayout, context: Context, session: LiveSession) -> None:
    """Always the same rows."""
    state, quality = session.state, session.state.quality
    is_shown = session.is_live_wanted and quality.num_poses > 0 and not state.no_readings
    skipped = tr("{count} poses").format(count=quality.num_skipped + state.num_dropped)
    recorded = text.duration(state.recording["seconds"]) if state.recording is not None else "-"
    rows = [
        ("Match", tr(quality.match) if is_shown else "-"),
        ("Delay", f"{1e3 * quality.latency_s:.0f} ms" if is_shown else "-"),
        ("Skipped", skipped if is_shown else "-"),
        ("Recorded", recorded),
    ]
    text.facts(layout, context, rows)


class SPARSEMOCAP_PT_live_messages(StepPanel, Panel):
    """What is wrong or new: behind everything that can be pressed, so that it moves nothing."""

    bl_idname = "SPARSEMOCAP_PT_live_messages"
    bl_parent_id = "SPARSEMOCAP_PT_live"
    bl_label = "Messages"
    bl_order = 2

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Only while sensors are connected."""
        session = live.current()
        return session is not None and session.is_running and session.state.is_connected

    def draw(self, context: Context) -> None:
        """The messages."""
        session = live.current()
        if session is None:
            return
        layout, state = self.layout, session.state
        problems = [*state.notes, live_scene.ended_because()]
        if session.is_live_wanted:
            problems += [state.no_readings, state.warning]
        for problem in filter(None, problems):
            text.error(layout, context, problem)
        if session.is_live_wanted and not state.no_readings:
            _advice(layout, context, state.quality)
        for link in state.links:
            if link["message"]:
                text.paragraph(layout, context, str(link["message"]), icon="INFO")
        if state.recording is not None and not is_calibrating():
            text.paragraph(layout, context, "The recording continues even if Blender quits", "REC")
        _last_take(layout, context)


def _advice(layout: UILayout, context: Context, quality: Quality) -> None:
    """What would help."""
    if quality.odd_sensor:
        odd = tr(ODD_SENSOR).format(site=tr(shown_site(quality.odd_sensor)))
        text.paragraph(layout, context, odd, icon="ERROR")
    advice = advice_for(quality.match, quality.advice)
    if advice:
        text.paragraph(layout, context, advice, icon="INFO")


def _last_take(layout: UILayout, context: Context) -> None:
    if sensors.last_takes:
        saved = tr("Saved: {path}").format(path=sensors.last_takes[0])
        text.paragraph(layout, context, saved, icon="FILE_TICK")


CLASSES = (SPARSEMOCAP_PT_live,)
MESSAGES = (SPARSEMOCAP_PT_live_messages,)
