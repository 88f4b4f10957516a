# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's rooms without Blender are importable from the repository's folder."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))
