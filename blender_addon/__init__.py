# SPDX-License-Identifier: GPL-3.0-or-later
"""Sparse Mocap in Blender: full-body motion from a few sensors and a motion database.

``session`` works without Blender, ``scene`` creates Blender's data, ``ops`` and ``ui`` are the
operators and panels, one file for each step. Importing this package alone does not need Blender.
"""

from __future__ import annotations

import sys
import textwrap
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .session.installation import Problem

bl_info = {
    "name": "Sparse Mocap",
    "author": "The Sparse Mocap developers",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Sparse Mocap",
    "description": "Full-body motion from a few cheap motion sensors and a motion database",
    "category": "Animation",
}


_bare_panels: list[type] = []


def register() -> None:
    """Register the operators and panels, or the panel that says why they cannot work."""
    try:
        problem = _problem()
        if problem is not None:
            from .ui import installation

            installation.register(problem)
            return
    except Exception as error:  # a file that would explain is missing or damaged
        _register_bare_panel(error)
        return
    from . import scene
    from .ops import registration as ops
    from .ui import registration as ui

    scene.register()
    ops.register()
    ui.register()


def unregister() -> None:
    """Stop everything and unload the modules too, so that an upgrade loads its own."""
    if _bare_panels:
        _unregister_bare_panel()
    else:
        _unregister_all()
    for name in [name for name in sys.modules if name.startswith(f"{__package__}.")]:
        del sys.modules[name]
        globals().pop(name.removeprefix(f"{__package__}."), None)


def _unregister_all() -> None:
    from .ui import installation

    if installation.is_shown():
        installation.unregister()
        return
    from . import scene
    from .ops import registration as ops
    from .ui import registration as ui

    ui.unregister()
    ops.unregister()
    scene.unregister()


def _register_bare_panel(error: Exception) -> None:
    """Register a panel that needs no other file of the add-on."""
    import bpy

    reason = (
        "Files of Sparse Mocap are missing or damaged: reinstall the add-on from the release file"
    )
    print(f"{reason} ({type(error).__name__}: {error})")

    def draw(self: bpy.types.Panel, _: bpy.types.Context) -> None:
        column = self.layout.box().column(align=True)
        column.alert = True
        for line in textwrap.wrap(reason, 26):
            column.label(text=line)

    settings = {
        "bl_label": "Sparse Mocap",
        "bl_space_type": "VIEW_3D",
        "bl_region_type": "UI",
        "bl_category": "Sparse Mocap",
        "draw": draw,
    }
    _bare_panels.append(type("SPARSEMOCAP_PT_installation", (bpy.types.Panel,), settings))
    bpy.utils.register_class(_bare_panels[0])


def _unregister_bare_panel() -> None:
    import bpy

    bpy.utils.unregister_class(_bare_panels.pop())


def _problem() -> Problem | None:
    """Why the add-on cannot work in this Blender; None when it can."""
    from .session import core, installation

    problem = core.problem()
    if problem is None:
        try:
            from .ops import registration as _ops  # noqa: F401 - whether it can be imported
            from .ui import registration as _ui  # noqa: F401
        except Exception as error:  # a file is missing or damaged
            problem = installation.addon_problem(error)
    return problem
