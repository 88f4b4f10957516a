# SPDX-License-Identifier: GPL-3.0-or-later
"""Sparse Mocap in Blender: full-body motion from a few sensors and a motion database.

``session`` knows no Blender, ``scene`` makes Blender's data, ``ops`` and ``ui`` are the animator's
steps, one file a step. Importing this package alone needs no Blender either.
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
    """Show the panels and make the operators known."""
    from . import ops, scene, ui

    scene.register()
    ops.register()
    ui.register()


def unregister() -> None:
    """Stop what runs and leave nothing behind, not even the modules: an upgrade reads them anew."""
    from . import ops, scene, ui

    ui.unregister()
    ops.unregister()
    scene.unregister()
    for name in [name for name in sys.modules if name.startswith(f"{__package__}.")]:
        del sys.modules[name]
        globals().pop(name.removeprefix(f"{__package__}."), None)
