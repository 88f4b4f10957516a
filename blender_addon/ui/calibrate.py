# SPDX-License-Identifier: GPL-3.0-or-later
"""The calibration in the sidebar."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.types import Context, Panel, UILayout

from ..scene.settings import settings_of
from ..scene.translations import tr
from ..session import live
from ..session.calibrating import CALIBRATING, calibrations
from ..session.names import shown_site
from ..session.pose_guide import CALIBRATING_BY_POSES
from . import text
from .step import StepPanel, action_button, job_is_running, redraw_soon, tick


class SPARSEMOCAP_PT_calibration(StepPanel, Panel):
    """The calibration in use, and the button to make one."""

    bl_idname = "SPARSEMOCAP_PT_calibration"
    bl_parent_id = "SPARSEMOCAP_PT_live"
    bl_label = "Calibration"
    bl_order = 1

    def draw_header_preset(self, context: Context) -> None:
        """A check mark when a calibration is loaded."""
        tick(self.layout, calibrations, bpy.path.abspath(settings_of(context.scene).calibration))

    def draw(self, context: Context) -> None:
        """The file, its values for each sensor, and the button."""
        layout, settings = self.layout, settings_of(context.scene)
        layout.prop(settings, "calibration", text="")
        if settings.calibration:
            _contents(layout, context, bpy.path.abspath(settings.calibration))
        else:
            text.paragraph(
                layout,
                context,
                "Without a calibration, wear the sensors in the default orientation (see README)",
                icon="INFO",
            )
        session = live.current()
        if session is None or not session.state.is_connected:
            return
        layout.prop(settings, "height_m")
        missing = "" if session.state.sensors else "Waiting for data"
        if session.state.recording is not None and not is_calibrating():
            missing = "Stop the recording first"
        buttons = [("sparse_mocap.calibrate_sensors", "ORIENTATION_GIMBAL", CALIBRATING)]
        if any(sensor["has_orientation"] for sensor in session.state.sensors):
            by_poses = "sparse_mocap.calibrate_by_poses"
            buttons.append((by_poses, "OUTLINER_OB_ARMATURE", CALIBRATING_BY_POSES))
        if is_calibrating():
            buttons = [button for button in buttons if job_is_running(button[2])]
        for button in buttons:
            is_last = button is buttons[-1]
            action_button(
                layout, *button, is_ready=not missing, has_details=is_last and not is_calibrating()
            )
        if missing:
            text.paragraph(layout, context, missing, icon="INFO")


def is_calibrating() -> bool:
    """Whether a calibration is running; the viewports then say what to do, and it records."""
    return job_is_running(CALIBRATING) or job_is_running(CALIBRATING_BY_POSES)


def _contents(layout: UILayout, context: Context, path: str) -> None:
    entry = calibrations.peek(path)
    if entry.is_opening:
        layout.label(text="Loading the calibration", icon="SORTTIME")
        redraw_soon()
    elif (calibration := entry.value) is None:
        text.error(layout, context, entry.error)
    else:
        box = layout.box()
        for sensor in calibration.sensors.values():
            text.paragraph(box, context, _line(sensor))
        for note in calibration.notes:
            text.paragraph(layout, context, note, icon="INFO")


def _line(sensor: Any) -> str:
    line = tr("{site}: quality {quality}, {gravity} m/s² at rest")
    return line.format(
        site=tr(shown_site(sensor.site)),
        quality=f"{sensor.quality:.0%}",
        gravity=f"{sensor.gravity:.2f}",
    )


CLASSES = (SPARSEMOCAP_PT_calibration,)
