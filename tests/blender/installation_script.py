# SPDX-License-Identifier: GPL-3.0-or-later
"""Enables the add-on that is installed in another Blender, prints what its panel says, disables it.

installation_script.py -- ADDON [hide_numpy | import_first FOLDER | replace FILE BY]

The line that begins with RESULT has the outcome as JSON.
"""

import json
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import bpy

ADDON, *ARGUMENTS = sys.argv[sys.argv.index("--") + 1 :]


class Recorder:
    """A layout that notes labels and operators."""

    def __init__(self) -> None:
        self.labels, self.operators = [], []

    def box(self) -> "Recorder":
        return self

    def column(self, **_: object) -> "Recorder":
        return self

    def label(self, *, text: str, **_: object) -> None:
        self.labels.append(text)

    def operator(self, name: str, **_: object) -> None:
        self.operators.append(name)


class NoNumPy:
    """An import hook to which NumPy does not exist."""

    def find_spec(self, name: str, *_: object) -> None:
        if name.split(".")[0] == "numpy":
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)


def hide_numpy() -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == "numpy"]:
        del sys.modules[name]
    sys.meta_path.insert(0, NoNumPy())


def enable() -> dict[str, object]:
    """What the panels are after enabling, and what the one that explains says."""
    bpy.ops.preferences.addon_enable(module=ADDON)
    panels = sorted(name for name in dir(bpy.types) if name.startswith("SPARSEMOCAP_PT"))
    found: dict[str, object] = {
        "is_enabled": ADDON in bpy.context.preferences.addons,
        "panels": panels,
    }
    if "SPARSEMOCAP_PT_installation" in panels:
        layout = Recorder()
        panel = bpy.types.SPARSEMOCAP_PT_installation
        wide = SimpleNamespace(width=1e5)  # a sentence is one label
        context = SimpleNamespace(region=wide, preferences=bpy.context.preferences)
        panel.draw(SimpleNamespace(layout=layout), context)
        found |= {"says": " ".join(layout.labels), "operators": layout.operators}
        if "copy_report" in dir(bpy.ops.sparse_mocap):
            found["copied"] = sorted(bpy.ops.sparse_mocap.copy_report())
        found["clipboard"] = bpy.context.window_manager.clipboard
    return found


def disable() -> list[str]:
    """What is left after disabling."""
    bpy.ops.preferences.addon_disable(module=ADDON)
    left = [name for name in dir(bpy.types) if name.startswith("SPARSEMOCAP_")]
    return left + [name for name in sys.modules if name.startswith(f"{ADDON}.")]


def main() -> None:
    what, *paths = ARGUMENTS or ["nothing"]
    if what == "hide_numpy":
        hide_numpy()
    if what == "import_first":
        sys.path.insert(0, paths[0])
        import sparse_mocap._core  # noqa: F401
    outcome = {"first": enable(), "left": disable()}
    if what == "replace":
        Path(paths[1]).rename(paths[0])
        outcome |= {"second": enable(), "left_then": disable()}
    print(f"\nRESULT {json.dumps(outcome)}", flush=True)
    sys.stderr.flush()
    os._exit(0)


main()
