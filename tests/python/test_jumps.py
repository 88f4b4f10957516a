# SPDX-License-Identifier: GPL-3.0-or-later
"""No method lets a joint jump, whatever the sensors read."""

from __future__ import annotations

import numpy as np
import pytest
from sparse_mocap import MotionDatabase, SensorRecord, Take, reconstruct

SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")


@pytest.fixture(scope="module")
def cut_take(database: MotionDatabase) -> Take:
    """A take that changes from one movement to another within a frame, time and again."""
    forces = database.array("specific_force_end").astype(float)
    starts = [clip.begin for clip in database.clips if not clip.is_mirrored and clip.tempo == 1.0]
    rows = np.concatenate([start + np.arange(12) for start in starts[::2] + starts[1::2]])
    times_s = np.arange(len(rows)) / database.rate_hz
    columns = {site: 3 * database.site_names.index(site) for site in SITES}
    return Take({s: SensorRecord(times_s, forces[rows, at : at + 3]) for s, at in columns.items()})


def largest_step_m(take: Take, database: MotionDatabase, method: str, **options: object) -> float:
    motion = reconstruct(take, database, method=method, options=options).motion
    steps = np.diff(np.asarray(motion.joint_positions("heading")), axis=0)
    return float(np.linalg.norm(steps, axis=2).max())


@pytest.mark.parametrize("method", ["path_regression", "tautges2011"])
def test_no_joint_jumps_at_a_cut(cut_take: Take, database: MotionDatabase, method: str) -> None:
    assert largest_step_m(cut_take, database, method) < 0.3


def test_the_papers_own_poses_do(cut_take: Take, database: MotionDatabase) -> None:
    own = largest_step_m(cut_take, database, "tautges2011", follow_s=0.0)
    assert own > 2.0 * largest_step_m(cut_take, database, "tautges2011")
