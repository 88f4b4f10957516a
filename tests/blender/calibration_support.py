# SPDX-License-Identifier: GPL-3.0-or-later
"""Performers who do what a calibration asks for, with sensors that are turned. No bpy here."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from live_support import part_of

PHASES_S = (1.0, 2.0, 1.0, 5.0, 1.0, 5.0)
"""Shorter than a performer needs; an emulator is as quick as that."""
TRACKER_SITES = ("left_hand", "right_hand", "left_ankle", "right_ankle", "head", "torso")
READY_S, HOLD_S = 1.5, 1.0

_ROOT = Path(__file__).resolve().parents[2]
_SOURCES = "" if os.environ.get("SPARSE_MOCAP_PACKAGE") else str(_ROOT / "bindings")
_MAKERS = _ROOT / "tests" / "python"

_ELBOWS_S, _SQUATS_S, _END_S = 6.5, 12.5, 20.5
_FIRST_POSE_S, _TAKEN_S, _HELD_S, _EDGE_S = 1.0, 0.6, 1.2, 0.1


@dataclass(frozen=True)
class Performance:
    """What sensors read that are turned on their limbs."""

    take: Any
    """The whole of it."""
    parts: dict[str, Any]
    """A take for each thing that the calibration may ask for."""
    turns: np.ndarray
    """(S, 3, 3) R_site_sensor."""
    body: Path | None = None
    """The file of the motion."""


def guided(folder: Path) -> Performance:
    """Standing, bending the elbows and squatting. Raises Skipped without SciPy."""
    import sparse_mocap

    path, turns = folder / "guided.csv", folder / "turns.npy"
    _make_guided(path, turns, _ELBOWS_S, _SQUATS_S, _END_S)
    take = sparse_mocap.read_take(path)
    parts = {
        "stand": part_of(take, 0.5, _ELBOWS_S - 0.5),
        "bend_elbows": part_of(take, _ELBOWS_S, _SQUATS_S),
        "squat": part_of(take, _SQUATS_S, _END_S),
    }
    return Performance(take, parts, np.load(turns), folder / "body.bvh")


def held() -> Performance:
    """Each of the calibration poses, with trackers at TRACKER_SITES."""
    maker = _loaded("held_poses")
    take = maker.recorded(_FIRST_POSE_S, _TAKEN_S, _HELD_S)
    parts = {
        name: part_of(take, begin_s + _EDGE_S, end_s - _EDGE_S)
        for name, (begin_s, end_s) in maker.spans(_FIRST_POSE_S, _TAKEN_S, _HELD_S)
    }
    return Performance(take, parts, maker.planted().matrices())


def follows_phases(performance: Performance, calibrating: Any, jobs: Any) -> Callable[[], Any]:
    """What is read now of a performer who does what the running calibration says.

    calibrating, jobs: the add-on's modules.
    """

    def now() -> Any:
        job = jobs.current()
        asked = "" if job is None else job.what
        names = [phase.name for phase in calibrating.PHASES if asked.startswith(phase.text)]
        return performance.parts.get("".join(names), performance.parts["stand"])

    return now


def follows_poses(performance: Performance, pose_guide: Any) -> Callable[[], Any]:
    """What is read now of a performer who takes the pose that is shown.

    pose_guide: the add-on's module.
    """
    first = next(iter(performance.parts.values()))
    return lambda: performance.parts.get(pose_guide.shown.pose, first)


def _loaded(name: str) -> Any:
    spec = importlib.util.spec_from_file_location(name, _MAKERS / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules[name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _make_guided(*arguments: object) -> None:
    """By a Python with SciPy, which Blender's may lack."""
    python = os.environ.get("SPARSE_MOCAP_TEST_PYTHON") or shutil.which("python") or "python3"
    done = subprocess.run(
        [python, _MAKERS / "guided_body.py", *map(str, arguments)],
        env=os.environ | {"PYTHONPATH": os.environ.get("SPARSE_MOCAP_TEST_PATH") or _SOURCES},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if "No module named" in done.stderr:
        from support import Skipped

        raise Skipped("there is no Python with SciPy and the package")
    assert done.returncode == 0, done.stderr
