# SPDX-License-Identifier: GPL-3.0-or-later
"""Names the compiled module that a test run had loaded, so that a release can say it was tested."""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path

NO_MODULE = "Compiled module: none"


def loaded_module() -> str:
    """A line with the module's file name and SHA-256, or that none was loaded."""
    module = sys.modules.get("sparse_mocap._core")
    path = Path(str(getattr(module, "__file__", None) or ""))
    if not path.is_file():
        return NO_MODULE
    return f"Compiled module: {path.name} {hashlib.sha256(path.read_bytes()).hexdigest()}"
