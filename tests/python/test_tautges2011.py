# SPDX-License-Identifier: GPL-3.0-or-later
"""The method of Tautges et al. 2011 beside NumPy: what its ablations leave of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sparse_mocap import (
    MotionDatabase,
    Reconstruction,
    build_database,
    graph_times,
    read_motion,
    reconstruct,
    simulated,
    to_standard,
    write_bvh,
)
from sparse_mocap.evaluation.changed_motion import scaled
from sparse_mocap.take import Take

SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")


@pytest.fixture(scope="module")
def take(performance: Path) -> Take:
    motion, _ = to_standard(read_motion(performance)[0])
    return simulated(motion.trimmed(100, 240), SITES, 100.0)


def solved(take: Take, database: MotionDatabase, **options: object) -> Reconstruction:
    fixed = {"follow_s": 0, "scales_with_database": False}
    return reconstruct(take, database, method="tautges2011", options=fixed | options)


def nearest(
    solution: Reconstruction, database: MotionDatabase, count: int
) -> list[tuple[np.ndarray, np.ndarray]]:
    """For each reading the nearest frames of the database and their distances, ascending."""
    at = [3 * database.site_names.index(site) + k for site in SITES for k in range(3)]
    rows = np.asarray(database.array("specific_force_end"), float)[:, at]
    for clip in database.clips:
        if clip.tempo != 1.0:
            rows[clip.begin : clip.end] = np.inf
    found = []
    for reading in np.asarray(solution.readings.specific_force):
        distances = np.linalg.norm(rows - reading.reshape(-1), axis=1)
        best = np.argsort(distances, kind="stable")[:count]
        found.append((best, distances[best]))
    return found


def test_a_mean_pose_is_that_of_the_nearest_frames_by_equation_1(
    take: Take, database: MotionDatabase
) -> None:
    solution = solved(take, database, pose="mean", num_neighbours=4, num_paths=4, window_readings=1)
    angles = np.asarray(database.array("angles"), float)
    rotations = np.asarray(solution.motion.without_extremities().rotations)
    compared = 0
    for t, (rows, distances) in enumerate(nearest(solution, database, 4)):
        poses = angles[rows]
        if np.ptp(poses, axis=0).max() > 3.0:
            continue  # angles that are a whole turn apart
        weights = distances.max() - distances
        mean = (weights / weights.sum()) @ poses
        found = database.skeleton.angles(rotations[t : t + 1], mean[None])[0]
        is_alike = np.abs(found[3:] - mean[3:]) < 1e-3
        assert is_alike.mean() > 0.85  # the rest is held within human limits
        compared += 1
    assert compared > 0.5 * len(rotations)


def test_a_reconstruction_tells_its_components_and_iterations(
    take: Take, database: MotionDatabase
) -> None:
    usual = solved(take, database).diagnostics
    assert usual["iterations"].max() <= 50
    assert usual["iterations"].mean() > 1.5
    assert 1 < usual["components"].mean() < 43
    least = solved(take, database, max_iterations=1, pca_variance=0.01).diagnostics
    assert set(least["iterations"].ravel()) == {1.0}
    assert set(least["components"].ravel()) == {1.0}
    mean = solved(take, database, pose="mean").diagnostics
    assert set(mean["iterations"].ravel()) == {0.0}


def test_the_components_keep_the_share_of_variance(take: Take, database: MotionDatabase) -> None:
    """As many as NumPy needs for 95 % of the weighted variance of the nearest frames."""
    wanted = {"num_neighbours": 9, "num_paths": 9, "window_readings": 1, "pca_variance": 0.95}
    solution = solved(take, database, pose="mean", **wanted)
    angles = np.asarray(database.array("angles"), float)
    told = solution.diagnostics["components"].ravel()
    compared = 0
    for t, (rows, distances) in enumerate(nearest(solution, database, 9)):
        poses = angles[rows]
        if np.ptp(poses, axis=0).max() > 3.0:
            continue
        weights = (distances.max() - distances) / (distances.max() - distances).sum()
        spread = np.sqrt(weights)[:, None] * (poses - weights @ poses)
        values = np.linalg.svd(spread, compute_uv=False) ** 2
        shares = np.cumsum(values) / values.sum()
        if np.abs(shares - 0.95).min() < 1e-3:
            continue
        assert told[t] == 1 + int(np.sum(shares < 0.95))
        compared += 1
    assert compared > 0.3 * len(told)


def test_a_graph_made_anew_from_all_readings_is_the_online_one(
    take: Take, database: MotionDatabase
) -> None:
    readings = solved(take, database).readings
    count = len(readings.times_s)
    for window in (1, count):
        online_s, anew_s, same = graph_times(database, readings, window)
        assert same == 1.0
        assert online_s >= 0.0
        assert anew_s >= 0.0
    assert 0.0 < graph_times(database, readings, 8)[2] < 1.0
    with pytest.raises(ValueError, match="window"):
        graph_times(database, readings, 0)


def test_readings_can_be_those_of_each_bodys_own_proportions(library: Path, tmp_path: Path) -> None:
    small = read_motion(library / "ada_walk_01.bvh")[0]
    large = scaled(small, 1.4)
    write_bvh(tmp_path / "a_walk_1.bvh", small)
    write_bvh(tmp_path / "b_walk_1.bvh", large)

    def built(names: str, **options: bool) -> MotionDatabase:
        path = tmp_path / f"{names}_{len(options)}.smdb"
        files = [tmp_path / f"{name}_walk_1.bvh" for name in names]
        build_database(files, path, mirror=True, tempo_copies=(), keep_duplicates=True, **options)
        return MotionDatabase(path)

    averaged, own = built("ab"), built("ab", own_proportions=True)
    alone = [np.asarray(built(name).array("specific_force_end")) for name in "ab"]
    readings = np.asarray(own.array("specific_force_end"))
    np.testing.assert_allclose(readings, np.concatenate(alone), atol=0.05)
    np.testing.assert_array_equal(own.array("positions"), averaged.array("positions"))
    shared = np.asarray(averaged.array("specific_force_end"))
    assert np.abs(shared - readings).max() > 0.5
    assert '"own_proportions":true' in own.build_info.replace(" ", "")
