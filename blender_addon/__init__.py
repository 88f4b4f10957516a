# SPDX-License-Identifier: GPL-3.0-or-later
"""Sparse Mocap in Blender: full-body motion from a few sensors and a motion database.

``session`` works without Blender, ``scene`` creates Blender's data, ``ops`` and ``ui`` are the
operators and panels, one file for each step. Importing this package alone does not need Blender.
"""

import sys

bl_info = {
    "name": "Sparse Mocap",
    "author": "The Sparse Mocap developers",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Sparse Mocap",
    "description": "Full-body motion from a few cheap motion sensors and a motion database",
    "category": "Animation",
}


def register() -> None:
    """Register the operators and panels."""
    from . import ops, scene, ui

    scene.register()
    ops.register()
    ui.register()


def unregister() -> None:
    """Stop everything and unload the modules too, so that an upgrade loads its own."""
    from . import ops, scene, ui

    ui.unregister()
    ops.unregister()
    scene.unregister()
    for name in [name for name in sys.modules if name.startswith(f"{__package__}.")]:
        del sys.modules[name]
        globals().pop(name.removeprefix(f"{__package__}."), None)
