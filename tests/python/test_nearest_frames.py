# SPDX-License-Identifier: GPL-3.0-or-later
"""What the paper's method says of a take's first reading follows from the frames nearest to it."""

from __future__ import annotations

import numpy as np
import pytest
import sparse_mocap
from sparse_mocap import SensorRecord, Take

SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
NUM_FRAMES, NUM_NEIGHBOURS = 12, 500
OPTIONS = {"num_neighbours": 500, "num_paths": 500, "scales_with_database": "false", "penalty": 1.0}


def searched_readings(database: sparse_mocap.MotionDatabase) -> np.ndarray:
    """(T, sensor, 3) m/s^2 of all frames but those of copies at another tempo."""
    rows = np.asarray(database.array("specific_force_end"), dtype=float)
    names = list(database.site_names)
    of_sites = np.stack([rows[:, 3 * names.index(site) :][:, :3] for site in SITES], axis=1)
    clips = [clip for clip in database.clips if clip.tempo == 1.0]
    return np.concatenate([of_sites[clip.begin : clip.end] for clip in clips])


def expected_misfit(known: np.ndarray, measured: np.ndarray) -> np.ndarray:
    """(sensor,) of the mean of the nearest readings, the farthest of which counts nothing."""
    heard = np.isfinite(measured).all(axis=1)
    distances = np.sqrt(((known - measured)[:, heard] ** 2).sum(axis=(1, 2)))
    nearest = np.argsort(distances, kind="stable")[:NUM_NEIGHBOURS]
    weights = distances[nearest[-1]] - distances[nearest]
    mean = np.einsum("i,isk->sk", weights / weights.sum(), known[nearest])
    return np.linalg.norm(measured - mean, axis=1)


@pytest.mark.parametrize("silent", [None, "right_wrist"])
def test_the_nearest_frames_are_found(
    database: sparse_mocap.MotionDatabase, silent: str | None
) -> None:
    known = searched_readings(database)
    assert len(known) > 3 * NUM_NEIGHBOURS
    chance = np.random.default_rng(1)
    times_s = np.arange(NUM_FRAMES) / database.rate_hz
    for _ in range(10):
        reading = known[chance.integers(len(known))] + chance.standard_normal((4, 3))
        records = {
            site: SensorRecord(times_s, np.tile(reading[s], (NUM_FRAMES, 1)))
            for s, site in enumerate(SITES)
        }
        if silent is not None:
            late = records[silent]
            records[silent] = SensorRecord(late.times_s[-3:], late.specific_force[-3:])
        solved = sparse_mocap.reconstruct(
            Take(records), database, method="tautges2011", options=OPTIONS
        )
        measured = np.asarray(solved.readings.specific_force)[0]
        misfit = np.asarray(solved.diagnostics["sensor_misfit_mps2"])[0]
        np.testing.assert_allclose(misfit, expected_misfit(known, measured), rtol=1e-4)
