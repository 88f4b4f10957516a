# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the add-on may keep files of its own."""

from __future__ import annotations

from pathlib import Path

import bpy

_ADDON = __package__.rpartition(".")[0]
_PLAIN = "sparse_mocap"


def user_folder() -> Path:
    """The folder: that of the extension, or one in Blender's settings for a plain add-on."""
    if _ADDON.startswith("bl_ext.") and hasattr(bpy.utils, "extension_path_user"):
        return Path(bpy.utils.extension_path_user(_ADDON))
    return Path(bpy.utils.user_resource("CONFIG", path=_PLAIN))
