# SPDX-License-Identifier: GPL-3.0-or-later
"""Recorded motions and sensors, which are no part of the repository.

They lie in the folder that the environment variable SPARSE_MOCAP_DATA names.
"""

from __future__ import annotations

import os
from pathlib import Path

VARIABLE = "SPARSE_MOCAP_DATA"
NOT_SET = f"{VARIABLE} is not set"
"""Why a test is skipped. It begins with the variable's name, by which `./dev test` counts."""


def real_data_folder() -> Path | None:
    """The folder, None when the variable is not set."""
    named = os.environ.get(VARIABLE)
    if not named:
        return None
    folder = Path(named)
    if not folder.is_dir():
        raise NotADirectoryError(f"{VARIABLE} names {folder}, which is no folder")
    return folder
