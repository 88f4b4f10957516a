# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers the operators of all steps; imports NumPy."""

import atexit

import bpy
from bpy.app.handlers import persistent

from ..scene import latent_view, overlay, pose_guide, prompt, sensor_graph
from ..scene import live as live_scene
from ..scene.report import facts
from ..scene.user_folder import user_folder
from ..session import job, log_file
from ..session import live as live_session
from ..session.calibrating import calibrations
from ..session.core import core
from ..session.database import databases
from ..session.errors import log
from ..session.imported import file_summaries
from ..session.methods import models
from ..session.port_scanner import port_scanner
from ..session.take import takes
from . import (
    bake,
    calibrate,
    calibrate_poses,
    character,
    clips,
    copy_report,
    database,
    import_motion,
    job_operator,
    live,
    mapping,
    reconstruct,
    record,
    sensor_table,
    take,
    teach,
    training,
    try_it,
)

CLASSES = (
    *job_operator.CLASSES,
    *copy_report.CLASSES,
    *import_motion.CLASSES,
    *mapping.CLASSES,
    *database.CLASSES,
    *teach.CLASSES,
    *clips.CLASSES,
    *take.CLASSES,
    *reconstruct.CLASSES,
    *live.CLASSES,
    *sensor_table.CLASSES,
    *calibrate.CLASSES,
    *calibrate_poses.CLASSES,
    *character.CLASSES,
    *bake.CLASSES,
    *record.CLASSES,
    *try_it.CLASSES,
    *training.CLASSES,
)


@persistent
def _before_load(*_: object) -> None:
    """Stop everything before another .blend file is opened."""
    job.cancel_current()
    live_scene.stop_ticking()
    prompt.hide()
    pose_guide.hide()
    overlay.hide()
    sensor_graph.hide()
    latent_view.hide()
    live_session.end()


@persistent
def _before_save(*_: object) -> None:
    live_scene.before_save()


@persistent
def _after_save(*_: object) -> None:
    live_scene.after_save()


def _end_all() -> None:
    """Leave no thread running when Python ends or the add-on is disabled."""
    job.cancel_current()
    live_session.end()
    port_scanner.wait(1.0)
    databases.close()
    takes.close()
    calibrations.close()
    models.close()
    file_summaries.close()


def register() -> None:
    """Register the operators, and begin the log."""
    log_file.begin(user_folder())
    log.info("Sparse Mocap %s in Blender %s", core().__version__, bpy.app.version_string)
    copy_report.more_facts[:] = [facts]
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.app.handlers.load_pre.append(_before_load)
    bpy.app.handlers.save_pre.append(_before_save)
    bpy.app.handlers.save_post.append(_after_save)
    record.add_shortcut()
    atexit.register(_end_all)


def unregister() -> None:
    """Stop everything and unregister the operators."""
    record.remove_shortcut()
    live_scene.stop_ticking()
    prompt.hide()
    pose_guide.hide()
    overlay.hide()
    sensor_graph.hide()
    latent_view.hide()
    _end_all()
    atexit.unregister(_end_all)
    bpy.app.handlers.save_post.remove(_after_save)
    bpy.app.handlers.save_pre.remove(_before_save)
    bpy.app.handlers.load_pre.remove(_before_load)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    copy_report.more_facts.clear()
    log_file.end()
