# SPDX-License-Identifier: GPL-3.0-or-later
"""The user's folder for what is remembered between sessions."""

from __future__ import annotations

import os
import sys
from pathlib import Path

__all__ = ["settings_folder"]


def settings_folder() -> Path:
    """Returns the folder where the system keeps a user's settings; it may not exist yet."""
    if sys.platform == "win32":
        settings = Path(os.environ.get("APPDATA") or Path.home() / "AppData" / "Roaming")
    elif sys.platform == "darwin":
        settings = Path.home() / "Library" / "Application Support"
    else:
        settings = Path(os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config")
    return settings / "sparse-mocap"
