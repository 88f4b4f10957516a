# SPDX-License-Identifier: GPL-3.0-or-later
"""Real sensors: connect, move an armature live, record, and bake what was recorded."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy
from bpy.props import IntProperty
from bpy.types import Context, Operator

from ..scene import live as live_scene
from ..scene.armature import select_only
from ..scene.performance import perform_steps
from ..scene.settings import settings_of
from ..session import live, sensors
from ..session.database import Database
from ..session.errors import InputError
from ..session.job import Job
from ..session.live import LiveSession, answer_of, one_line_of
from ..session.new_files import takes_folder
from ..session.sensors import Kept
from ..session.steps import Steps
from ..session.surroundings import surroundings
from .job_operator import JobOperator

_ANSWER_S = 1.0


def connected() -> LiveSession:
    """The session that goes on. Raises InputError."""
    session = live.current()
    if session is None or not session.is_running:
        raise InputError("No sensors are connected: press Connect first")
    return session


class _NowOperator:
    """Mix-in: act() does it at once, or raises what is then told in a line."""

    report: Callable[[set[str], str], None]  # the operator's own

    def act(self, context: Context) -> str:
        raise NotImplementedError

    def execute(self, context: Context) -> set[str]:
        try:
            message = self.act(context)
        except Exception as error:
            self.report({"ERROR"}, one_line_of(error))
            return {"CANCELLED"}
        if message:
            self.report({"INFO"}, message)
        return {"FINISHED"}


class SPARSEMOCAP_OT_find_sensors(_NowOperator, Operator):
    """Look for serial ports and for captures that go on."""

    bl_idname = "sparse_mocap.find_sensors"
    bl_label = "Find Ports"
    bl_description = "Look for serial ports and for captures that go on"
    bl_options = {"INTERNAL"}

    def act(self, context: Context) -> str:
        """Look on a thread."""
        surroundings.look()
        return ""


class SPARSEMOCAP_OT_connect_sensors(_NowOperator, Operator):
    """Start to receive what the sensors at the port send."""

    bl_idname = "sparse_mocap.connect_sensors"
    bl_label = "Connect"
    bl_description = "Start to receive what the sensors at the port send"
    bl_options = {"REGISTER"}

    def act(self, context: Context) -> str:
        """Begin a session; the panel shows what comes of it."""
        settings = settings_of(context.scene)
        port = sensors.Port(
            settings.port, settings.driver, settings.baud, settings.driver_options, settings.sites
        )
        live.begin(sensors.connecting(port, takes_folder(bpy.data.filepath)))
        live_scene.ensure_ticking()
        return ""


class SPARSEMOCAP_OT_attach_sensors(_NowOperator, Operator):
    """Attach to a capture that goes on already."""

    bl_idname = "sparse_mocap.attach_sensors"
    bl_label = "Attach"
    bl_description = "Attach to a capture that goes on already"
    bl_options = {"REGISTER"}

    pid: IntProperty(name="Process", options={"SKIP_SAVE"})

    def act(self, context: Context) -> str:
        """Begin a session with it."""
        for found in surroundings.view.captures:
            if found.pid == self.pid:
                live.begin(sensors.attaching(found.session))
                live_scene.ensure_ticking()
                return ""
        raise InputError("That capture has ended: look for ports again")


class SPARSEMOCAP_OT_disconnect_sensors(_NowOperator, Operator):
    """Leave the sensors alone; a recording goes on without Blender."""

    bl_idname = "sparse_mocap.disconnect_sensors"
    bl_label = "Disconnect"
    bl_description = "Leave the sensors alone; a recording goes on without Blender"
    bl_options = {"REGISTER"}

    def act(self, context: Context) -> str:
        """End the session."""
        live_scene.stop_ticking()
        live.end()
        surroundings.look()
        return ""


class SPARSEMOCAP_OT_go_live(JobOperator, Operator):
    """Let an armature move as the sensors do; no keys are set."""

    bl_idname = "sparse_mocap.go_live"
    bl_label = "Live"
    bl_description = "Let an armature move as the sensors do; no keys are set"
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context: Context) -> Job:
        """Open the scene's database."""
        connected()
        settings = settings_of(context.scene)
        return sensors.going_live_job(
            bpy.path.abspath(settings.database), bpy.path.abspath(settings.calibration)
        )

    def apply(self, context: Context, result: tuple[Database, Any]) -> Steps[str]:
        """Choose or make the armature, and let it follow."""
        yield 0.0
        session = connected()
        database, calibration = result
        rig = live_scene.live_rig(context, database.motions.skeleton)
        session.go_live(database, settings_of(context.scene).preset, calibration)
        live_scene.follow(rig)
        return f'"{rig.armature.name}" is live'


class SPARSEMOCAP_OT_leave_live(_NowOperator, Operator):
    """Let the armature rest in the pose it has."""

    bl_idname = "sparse_mocap.leave_live"
    bl_label = "Stop Live"
    bl_description = "Let the armature rest in the pose it has"
    bl_options = {"REGISTER", "UNDO"}

    def act(self, context: Context) -> str:
        """Make no more poses."""
        connected().leave_live()
        return ""


class SPARSEMOCAP_OT_record_take(_NowOperator, Operator):
    """Record what the sensors read."""

    bl_idname = "sparse_mocap.record_take"
    bl_label = "Record"
    bl_description = "Record what the sensors read; goes on even if Blender ends"
    bl_options = {"REGISTER"}

    def act(self, context: Context) -> str:
        """Begin to record."""
        answer_of(connected().record(), _ANSWER_S)
        return "Recording"


class SPARSEMOCAP_OT_stop_take(JobOperator, Operator):
    """End the recording, keep it as a take and put it onto an armature as an action."""

    bl_idname = "sparse_mocap.stop_take"
    bl_label = "Stop"
    bl_description = "End the recording, keep it as a take and put it onto an armature as an action"
    bl_options = {"REGISTER", "UNDO"}

    def prepare(self, context: Context) -> Job:
        """Keep the take and reconstruct it."""
        settings = settings_of(context.scene)
        return sensors.stopping_job(
            connected(),
            bpy.path.abspath(settings.database),
            bpy.path.abspath(settings.calibration),
            takes_folder(bpy.data.filepath),
            settings.preset,
        )

    def apply(self, context: Context, result: Kept) -> Steps[str]:
        """The take in the settings, and its action on the armature that was live, if one was."""
        settings_of(context.scene).take = result.path
        for warning in result.warnings:
            self.report({"WARNING"}, warning)
        if result.performance is None:
            self.report({"WARNING"}, f"Not reconstructed: {result.reason}")
            yield 1.0
            return f"The take is kept in {result.path}"
        armature = self._rested(context)
        performed: Any = yield from perform_steps(
            context,
            result.performance,
            settings_of(context.scene).start_frame,
            reuse=armature is not None,
        )
        action = performed.animation_data.action
        return f'"{action.name}" on "{performed.name}"; the take is kept in {result.path}'

    def _rested(self, context: Context) -> Any:
        """The armature that was live, alone selected and live no more; None when none was."""
        session, armature = live.current(), live_scene.followed()
        if session is not None:
            session.leave_live()
        if armature is None or armature.name not in context.view_layer.objects:
            return None
        if context.mode != "OBJECT" and bpy.ops.object.mode_set.poll():
            bpy.ops.object.mode_set(mode="OBJECT")
        select_only(context, armature)
        return armature


CLASSES = (
    SPARSEMOCAP_OT_find_sensors,
    SPARSEMOCAP_OT_connect_sensors,
    SPARSEMOCAP_OT_attach_sensors,
    SPARSEMOCAP_OT_disconnect_sensors,
    SPARSEMOCAP_OT_go_live,
    SPARSEMOCAP_OT_leave_live,
    SPARSEMOCAP_OT_record_take,
    SPARSEMOCAP_OT_stop_take,
)
