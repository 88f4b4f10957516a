# SPDX-License-Identifier: GPL-3.0-or-later
"""Registers the panels of all steps and the import dialog; imports NumPy."""

import bpy

from . import (
    calibrate,
    clips,
    database,
    help,
    import_motion,
    live,
    mapping,
    reconstruct,
    take,
    training,
)
from .step import forget_timers

CLASSES = (
    *database.CLASSES,
    *clips.CLASSES,
    *take.CLASSES,
    *reconstruct.CLASSES,
    *training.CLASSES,
    *live.CLASSES,
    *calibrate.CLASSES,
    *live.MESSAGES,
    *mapping.CLASSES,
    *help.CLASSES,
)


def register() -> None:
    """Register the panels."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    import_motion.register()


def unregister() -> None:
    """Unregister the panels."""
    forget_timers()
    import_motion.unregister()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
