# SPDX-License-Identifier: GPL-3.0-or-later
"""Real sensors: connect, preview live on an armature, record, and bake the recording."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import bpy
from bpy.props import IntProperty
from bpy.types import Context, Operator

from ..scene import compat
from ..scene import live as live_scene
from ..scene.armature import is_ours
from ..scene.online import check_online_access
from ..scene.performance import extend_scene, perform_steps
from ..scene.settings import scene_choice, settings_of
from ..scene.takes import add_take
from ..scene.targets import chosen_armatures, own_figure, placement_of
from ..scene.translations import CONTEXT, tr_line
from ..session import live, sensors
from ..session.errors import InputError
from ..session.job import Job
from ..session.live import LiveSession, answer_of
from ..session.new_files import takes_folder
from ..session.port_scanner import port_scanner
from ..session.sensors import SavedTake
from ..session.stage import Stage
from ..session.steps import Steps
from ..session.take import takes
from .job_operator import JobOperator
from .now_operator import NowOperator

ANSWER_S = 1.0


def connected() -> LiveSession:
    """The running session. Raises InputError."""
    session = live.current()
    if session is None or not session.is_running:
        raise InputError("No sensors are connected: press Connect first")
    return session


class SPARSEMOCAP_OT_find_sensors(NowOperator, Operator):
    """Refresh the list of ports and running captures."""

    bl_idname = "sparse_mocap.find_sensors"
    bl_label = "Refresh Ports"
    bl_description = "Refresh the list of ports and running captures"
    bl_options = {"INTERNAL"}

    def act(self, context: Context) -> str:
        """Scan on a thread."""
        port_scanner.scan()
        return ""


class SPARSEMOCAP_OT_connect_sensors(NowOperator, Operator):
    """Connect to the sensors at this port."""

    bl_idname = "sparse_mocap.connect_sensors"
    bl_label = "Connect"
    bl_translation_context = CONTEXT
    bl_description = "Connect to the sensors at this port"
    bl_options = {"REGISTER"}

    def act(self, context: Context) -> str:
        """Start a session; the panel shows its state."""
        settings = settings_of(context.scene)
        for one in (settings, *settings.more_ports):
            check_online_access(one.port)
        port, *more = (
            sensors.Port(one.port, one.driver, one.baud, one.driver_options)
            for one in (settings, *settings.more_ports)
        )
        port = replace(port, sites=settings.sites)
        folder = takes_folder(bpy.data.filepath, settings.folder)
        live.begin(sensors.new_session(port, folder, more))
        live_scene.ensure_ticking()
        return ""


class SPARSEMOCAP_OT_attach_sensors(NowOperator, Operator):
    """Connect to a capture that is running in the background."""

    bl_idname = "sparse_mocap.attach_sensors"
    bl_label = "Reconnect"
    bl_description = "Connect to these sensors again; they are still received in the background"
    bl_options = {"REGISTER"}

    pid: IntProperty(name="Process", options={"SKIP_SAVE"})

    def act(self, context: Context) -> str:
        """Start a session with it."""
        for found in port_scanner.result.captures:
            if found.pid == self.pid:
                live.begin(sensors.attach_session(found.session))
                live_scene.ensure_ticking()
                return ""
        raise InputError("This capture has ended: refresh the ports and connect again")


class SPARSEMOCAP_OT_disconnect_sensors(NowOperator, Operator):
    """Disconnect; a recording continues in the background."""

    bl_idname = "sparse_mocap.disconnect_sensors"
    bl_label = "Disconnect"
    bl_description = "Disconnect. A recording continues in the background"
    bl_options = {"REGISTER"}

    def act(self, context: Context) -> str:
        """End the session."""
        live_scene.stop_ticking()
        live.end()
        port_scanner.scan()
        return ""


class SPARSEMOCAP_OT_go_live(JobOperator, Operator):
    """Preview the motion live on an armature; no keys are set."""

    bl_idname = "sparse_mocap.go_live"
    bl_label = "Live Preview"
    bl_description = "Preview the motion live on an armature. No keys are set"
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context: Context) -> Job:
        """Open the scene's database and model."""
        connected()
        settings = settings_of(context.scene)
        return sensors.live_preview_job(
            bpy.path.abspath(settings.database),
            bpy.path.abspath(settings.calibration),
            scene_choice(context.scene),
        )

    def apply(self, context: Context, result: sensors.LivePreview) -> Steps[str]:
        """Choose or create the armature and start the preview."""
        yield 0.0
        session = connected()
        armature = live_scene.follow(context, result.skeleton)
        session.go_live(result.database, scene_choice(context.scene), result.calibration)
        return f'Live preview on "{armature.name}"'


class SPARSEMOCAP_OT_leave_live(NowOperator, Operator):
    """Stop the live preview; the character's own pose and action come back."""

    bl_idname = "sparse_mocap.leave_live"
    bl_label = "Stop Live Preview"
    bl_description = "Stop the live preview; the character's own pose and action come back"
    bl_options = {"REGISTER", "UNDO"}

    def act(self, context: Context) -> str:
        """Stop the preview."""
        connected().leave_live()
        live_scene.leave()
        return ""


class SPARSEMOCAP_OT_recentre(NowOperator, Operator):
    """Move the live character to the origin."""

    bl_idname = "sparse_mocap.recentre"
    bl_label = "Recentre"
    bl_description = "Move the live character to the origin"
    bl_options = {"INTERNAL"}

    def act(self, context: Context) -> str:
        """Move the stage."""
        _stage().recentre()
        return ""


class SPARSEMOCAP_OT_face_front(NowOperator, Operator):
    """Turn the live character to the front, at the origin."""

    bl_idname = "sparse_mocap.face_front"
    bl_label = "Face Front"
    bl_description = (
        "Turn the live character to the front, at the origin, when its heading has drifted"
    )
    bl_options = {"INTERNAL"}

    def act(self, context: Context) -> str:
        """Turn the stage."""
        _stage().face_front()
        return ""


class SPARSEMOCAP_OT_record_take(NowOperator, Operator):
    """Record the sensors."""

    bl_idname = "sparse_mocap.record_take"
    bl_label = "Record"
    bl_description = "Record the sensors. The recording continues even if Blender quits"
    bl_options = {"REGISTER"}

    def act(self, context: Context) -> str:
        """Start recording."""
        answer_of(connected().record(), ANSWER_S)
        return "Recording"


class SPARSEMOCAP_OT_stop_take(JobOperator, Operator):
    """Stop recording, save the take and reconstruct it as an action on an armature."""

    bl_idname = "sparse_mocap.stop_take"
    bl_label = "Stop Recording"
    bl_description = "Stop recording, save the take and reconstruct it as an action on an armature"
    bl_options = {"REGISTER", "UNDO"}

    _figure = ""

    def prepare(self, context: Context) -> Job:
        """Save the take and reconstruct it."""
        settings, session = settings_of(context.scene), connected()
        if settings.record_plays:
            compat.play(context, is_wanted=False)
        armatures = chosen_armatures(context)
        previewed = live_scene.followed()
        if previewed is not None and is_ours(previewed) and not armatures:
            armatures = [previewed]
        figure = own_figure(armatures)
        self._figure = figure.name if figure is not None else ""
        placement = placement_of(
            context,
            armatures,
            start_frame=settings.start_frame,
            whole_frames=settings.whole_frames,
        )
        return sensors.save_take_job(
            session,
            bpy.path.abspath(settings.database),
            bpy.path.abspath(settings.calibration),
            takes_folder(bpy.data.filepath, settings.folder),
            scene_choice(context.scene),
            placement,
        )

    def apply(self, context: Context, result: SavedTake) -> Steps[str]:
        """Select the take, and put its action on the armature of the live preview, if any."""
        match = result.placed.performance.match.label if result.placed is not None else ""
        add_take(context.scene, result.path, takes.peek(result.path).value, match)
        for warning in result.warnings:
            self.report({"WARNING"}, tr_line(warning))
        if result.placed is None:
            self.report({"WARNING"}, tr_line(f"Not reconstructed: {result.reason}"))
            yield 1.0
            return f"Take saved as {result.path}"
        leave_live()
        if context.mode != "OBJECT" and bpy.ops.object.mode_set.poll():
            bpy.ops.object.mode_set(mode="OBJECT")
        figure = bpy.data.objects.get(self._figure)
        performed: Any = yield from perform_steps(context, result.placed, figure)
        if settings_of(context.scene).extend_scene:
            extend_scene(context, result.placed)
        action = performed.animation_data.action
        return f'"{action.name}" on "{performed.name}"; take saved as {result.path}'


def leave_live() -> None:
    """End the live preview, if there is one; sensors stay connected."""
    session = live.current()
    if session is not None:
        session.leave_live()
    live_scene.leave()


def _stage() -> Stage:
    stage = live_scene.stage()
    if stage is None:
        raise InputError("There is no live preview: press Live Preview first")
    return stage


CLASSES = (
    SPARSEMOCAP_OT_find_sensors,
    SPARSEMOCAP_OT_connect_sensors,
    SPARSEMOCAP_OT_attach_sensors,
    SPARSEMOCAP_OT_disconnect_sensors,
    SPARSEMOCAP_OT_go_live,
    SPARSEMOCAP_OT_leave_live,
    SPARSEMOCAP_OT_recentre,
    SPARSEMOCAP_OT_face_front,
    SPARSEMOCAP_OT_record_take,
    SPARSEMOCAP_OT_stop_take,
)
