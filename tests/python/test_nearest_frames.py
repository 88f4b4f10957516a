# SPDX-License-Identifier: GPL-3.0-or-later
"""With one neighbour and one path, the paper's method shows the frame that is nearest of all."""

from __future__ import annotations

import numpy as np
import pytest
import sparse_mocap
from sparse_mocap import SensorRecord, Take

SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
ONE = {"num_neighbours": 1, "num_paths": 1, "scales_with_database": "false"}


def readings(database: sparse_mocap.MotionDatabase) -> np.ndarray:
    """(T, sensor, 3) m/s^2 of all frames; far away where the paper's method does not search."""
    rows = np.asarray(database.array("specific_force_end"))
    names = list(database.site_names)
    known = np.stack([rows[:, 3 * names.index(site) :][:, :3] for site in SITES], axis=1)
    for clip in database.clips:
        if clip.tempo != 1.0:
            known[clip.begin : clip.end] = 1e6
    return known


@pytest.mark.parametrize("spread_mps2", [0.0, 3.0])
def test_every_frame_is_the_nearest_of_the_database(
    database: sparse_mocap.MotionDatabase, spread_mps2: float
) -> None:
    known = readings(database)
    chance = np.random.default_rng(1)
    searched = np.flatnonzero(known[:, 0, 0] < 1e6)
    asked = known[chance.choice(searched, size=400)].astype(float)
    asked += spread_mps2 * chance.standard_normal(asked.shape)
    times_s = np.arange(len(asked)) / database.rate_hz
    take = Take({site: SensorRecord(times_s, asked[:, s]) for s, site in enumerate(SITES)})
    solved = sparse_mocap.reconstruct(take, database, method="tautges2011", options=ONE)
    measured = np.asarray(solved.readings.specific_force)
    squares = ((measured[:, None] - known[None]) ** 2).sum(axis=(2, 3))
    found = np.asarray(solved.diagnostics["database_frame"])[:, 0].astype(int)
    every = np.arange(len(found))
    np.testing.assert_allclose(squares[every, found], squares.min(axis=1), rtol=1e-5, atol=1e-6)
