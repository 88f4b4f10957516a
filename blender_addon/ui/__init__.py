# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar: three numbered steps, one file a step; and the import dialog."""

import bpy

from . import database, import_motion, reconstruct, take
from .step import forget_redraw

CLASSES = (*database.CLASSES, *take.CLASSES, *reconstruct.CLASSES)


def register() -> None:
    """Show the panels."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    import_motion.register()


def unregister() -> None:
    """Take the panels away."""
    forget_redraw()
    import_motion.unregister()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
