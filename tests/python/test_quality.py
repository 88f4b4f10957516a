# SPDX-License-Identifier: GPL-3.0-or-later
"""What is foreseen of a reconstruction: good, fair or poor."""

from __future__ import annotations

import json
from math import exp, log
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from sparse_mocap import (
    MotionDatabase,
    SensorRecord,
    Take,
    _core,
    add_to_database,
    build_database,
    quality,
    quality_calibration,
    reconstruct,
)
from sparse_mocap.demo_motions import generate_library
from sparse_mocap.quality import quality_of
from sparse_mocap.quality_calibration import calibrate_quality

RATE_HZ = 10.0


def told(
    spread_m: list[float],
    misfit_mps2: list[float],
    *,
    best: bool = False,
    channels: tuple[str, ...] = ("specific_force",),
) -> Any:
    """A reconstruction that says this of its frames; the database's rows follow each other."""
    count = len(spread_m)
    swing = np.where(np.arange(count) % 2 == 0, 1.0, -1.0)
    force = np.zeros((count, 2, 3))
    force[:, 0, 0] = 3.0 * swing  # readings of the first sensor vary by 3, of the second by 0
    poses = np.zeros((count, 21, 3))
    poses[..., 1] = 0.2 * swing[:, None]
    return SimpleNamespace(
        latency_s=None if best else 0.075,
        diagnostics={
            "spread_m": np.tile(np.array(spread_m)[:, None], (1, 21)),
            "sensor_misfit_mps2": np.tile(np.array(misfit_mps2)[:, None], (1, 2)),
            "database_frame": np.arange(count, dtype=float)[:, None],
        },
        readings=SimpleNamespace(
            specific_force=force, times_s=np.arange(count) / RATE_HZ, channels=[list(channels)] * 2
        ),
        motion=SimpleNamespace(joint_positions=lambda frame: poses),
    )


def expected(spread_m: float, misfit_mps2: float) -> float:
    constant, spread, misfit, readings, poses, _ = quality.USUAL
    return exp(
        constant
        + spread * log(spread_m)
        + misfit * log(misfit_mps2)
        + readings * log(3.0 / np.sqrt(2.0))
        + poses * log(0.2)
    )


def test_the_expected_error_has_its_closed_form() -> None:
    for spread_m, misfit_mps2 in ((0.03, 0.8), (0.1, 2.0), (0.25, 6.0)):
        found = quality_of(told([spread_m] * 30, [misfit_mps2] * 30))
        assert found is not None
        share = expected(spread_m, misfit_mps2)
        assert found.share == pytest.approx(share, rel=1e-9)
        assert found.label == ("poor" if share > 0.95 else "fair" if share >= 0.65 else "good")
        best = quality_of(told([spread_m] * 30, [misfit_mps2] * 30, best=True))
        assert best is not None
        assert best.share == pytest.approx(share * exp(-0.07), rel=1e-9)


@pytest.mark.parametrize(
    ("channel", "logarithm"), [("angular_velocity", -0.1), ("orientation", -0.28)]
)
def test_sensors_that_say_more_are_trusted_more(channel: str, logarithm: float) -> None:
    plain = quality_of(told([0.1] * 30, [2.0] * 30))
    more = quality_of(told([0.1] * 30, [2.0] * 30, channels=("specific_force", channel)))
    assert plain is not None
    assert more is not None
    assert more.share == pytest.approx(plain.share * exp(logarithm), rel=1e-9)
    judge = quality.JudgedFrame(0.1, 2.0, 1.0, np.ones((2, 3)), np.zeros((21, 3)))
    live = [judge, judge._replace(specific_force=np.zeros((2, 3)))]
    without = quality.judged(live).share
    assert quality.judged(live, channels=[["specific_force", channel]] * 2).share == pytest.approx(
        without * exp(logarithm), rel=1e-9
    )


def test_each_second_is_judged_by_what_is_near() -> None:
    found = quality_of(told([0.02] * 40 + [0.4] * 40, [0.5] * 40 + [9.0] * 40))
    assert found is not None
    assert found.second_labels[:3] == ("good",) * 3
    assert found.second_labels[5:] == ("poor",) * 3


def test_advice_says_whether_the_readings_or_the_poses_are_in_doubt() -> None:
    unlike = quality_of(told([0.1] * 30, [12.0] * 30))
    alike = quality_of(told([0.8] * 30, [2.5] * 30))
    good = quality_of(told([0.02] * 30, [0.5] * 30))
    assert unlike is not None
    assert alike is not None
    assert good is not None
    assert (unlike.label, alike.label, good.label) == ("poor", "poor", "good")
    assert unlike.is_unlike_the_database
    assert not alike.is_unlike_the_database
    assert "calibrate" in unlike.advice
    assert "gyroscopes" in alike.advice
    assert good.advice == ""


def test_a_method_that_retrieves_nothing_is_not_judged() -> None:
    solved = told([0.1] * 5, [1.0] * 5)
    del solved.diagnostics["spread_m"]
    assert quality_of(solved) is None


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A folder of a few clips, and a calibrated database of the many others."""
    folder, few = tmp_path_factory.mktemp("many"), tmp_path_factory.mktemp("few")
    generate_library(folder)
    for path in sorted(folder.glob("ada_walk*.bvh")):
        path.rename(few / path.name)
    path = tmp_path_factory.mktemp("large") / "large.smdb"
    build_database([folder], path, mirror=True, tempo_copies=())
    return few, path


def test_what_is_tested_is_hidden(large: tuple[Path, Path]) -> None:
    database = MotionDatabase(large[1])
    held_out = quality_calibration._held_out(database)
    assert [kind for kind, _, _ in held_out] == ["source", "actor", "motion_class"]
    for kind, tests, excluded in held_out:
        labels = [getattr(clip, kind) for clip in database.clips]
        known = {label for i, label in enumerate(labels) if i not in set(excluded)}
        assert tests
        assert known
        assert not known & {labels[i] for i in tests}


def test_a_database_learns_what_is_good_and_keeps_it(
    large: tuple[Path, Path], tmp_path: Path
) -> None:
    few, path = large
    database = MotionDatabase(path)
    kept = database.section("quality", 1)
    assert kept is not None
    found = json.loads(kept["calibration"])
    assert len(found["coefficients"]) == len(quality.USUAL)
    assert np.abs(np.array(found["coefficients"]) - quality.USUAL).max() > 1e-3
    assert 0.0 < found["spread_m"] < 0.5
    before = path.read_bytes()
    calibrate_quality(path)
    assert path.read_bytes() == before
    # Texts that were made from other rows are not believed.
    other = tmp_path / "other.smdb"
    other.write_bytes(before)
    _core.store_section(other, "quality", kept, version=1, rows="0" * 16)
    assert MotionDatabase(other).section("quality", 1) is None
    add_to_database(path, [few], other)
    added = MotionDatabase(other).section("quality", 1)
    assert added is not None
    assert added != kept


def test_known_movement_is_good_and_noise_is_poor(large: tuple[Path, Path]) -> None:
    database = MotionDatabase(large[1])
    clip = next(clip for clip in database.clips if "squat" in clip.name)
    rows = slice(clip.begin, clip.end)
    forces = database.array("specific_force_end")[rows].astype(float)
    times_s = np.arange(clip.end - clip.begin) / database.rate_hz
    chance = np.random.default_rng(1)
    columns = {site: 3 * database.site_names.index(site) for site in quality_calibration.SITES}
    true = Take({s: SensorRecord(times_s, forces[:, at : at + 3]) for s, at in columns.items()})
    noise = Take(
        {s: SensorRecord(times_s, chance.normal(0.0, 9.0, (len(times_s), 3))) for s in columns}
    )
    labels = []
    for take in (true, noise):
        found = quality_of(reconstruct(take, database), database)
        assert found is not None
        labels.append(found.label)
    assert labels == ["good", "poor"]
