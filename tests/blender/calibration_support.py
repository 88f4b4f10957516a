# SPDX-License-Identifier: GPL-3.0-or-later
"""A guided performance with sensors that are turned on their limbs. No bpy here."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
from live_support import until

PHASES_S = (1.0, 2.0, 1.0, 5.0, 1.0, 5.0)
"""Shorter than a performer needs; an emulator is as quick as that."""
LEAD_S = 3.0
"""From the first sample to the first phase: no movement begins before its own phase is near."""

_ROOT = Path(__file__).resolve().parents[2]
_SOURCES = "" if os.environ.get("SPARSE_MOCAP_PACKAGE") else str(_ROOT / "bindings")
_MAKER = _ROOT / "tests" / "python" / "guided_body.py"


def wait_for_lead(session: Any) -> None:
    """Until it is time to begin the first phase."""
    until(lambda: session.state.sensors[0]["samples"] >= 100 * LEAD_S)


def planted(folder: Path) -> tuple[Path, np.ndarray]:
    """A take, and (4, 3, 3) R_site_sensor of its sensors. Raises Skipped without SciPy."""
    take, turns = folder / "guided.csv", folder / "turns.npy"
    elbows_s = LEAD_S + sum(PHASES_S[:3]) - 0.5
    squats_s = elbows_s + sum(PHASES_S[3:5])
    times = [str(seconds) for seconds in (elbows_s, squats_s, squats_s + PHASES_S[5] + 3.0)]
    python = os.environ.get("SPARSE_MOCAP_TEST_PYTHON") or shutil.which("python") or "python3"
    done = subprocess.run(
        [python, _MAKER, take, turns, *times],
        env=os.environ | {"PYTHONPATH": os.environ.get("SPARSE_MOCAP_TEST_PATH") or _SOURCES},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if "No module named 'scipy'" in done.stderr:
        from support import Skipped

        raise Skipped("SciPy is not installed")
    assert done.returncode == 0, done.stderr
    return take, np.load(turns)
