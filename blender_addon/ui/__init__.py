# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar: three numbered steps, one file a step."""

import bpy

from . import database, reconstruct, take
from .step import forget_redraw

CLASSES = (*database.CLASSES, *take.CLASSES, *reconstruct.CLASSES)


def register() -> None:
    """Show the panels."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    """Take the panels away."""
    forget_redraw()
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
