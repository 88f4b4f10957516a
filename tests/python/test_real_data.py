# SPDX-License-Identifier: GPL-3.0-or-later
"""Recorded motion capture, where it is at hand: CMU and HDM05."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from sparse_mocap import (
    MotionDatabase,
    build_database,
    read_motion,
    read_positions,
    standard_motion,
)
from sparse_mocap.evaluation import performed
from sparse_mocap.evaluation.protocol import is_copy
from sparse_mocap.readings import all_readings

Cli = Callable[..., Result]


def test_both_formats_of_a_cmu_trial_are_one_motion(
    real_data: Path, cli: Cli, tmp_path: Path
) -> None:
    asf_amc = sorted((real_data / "cmu" / "asf_amc").rglob("02_*.amc"))
    pairs = [(amc, list((real_data / "cmu" / "bvh").rglob(f"{amc.stem}.bvh"))) for amc in asf_amc]
    pairs = [(amc, found[0]) for amc, found in pairs if found]
    assert pairs
    database = tmp_path / "db.smdb"
    assert cli("database", "build", pairs[0][0], "-o", database).exit_code == 0
    for pair in pairs[:3]:
        tables = []
        for path in pair:
            result = cli("convert", path, "-o", tmp_path / "p.csv", "--skeleton", database)
            assert result.exit_code == 0, result.output
            tables.append(read_positions(tmp_path / "p.csv")[2])
        frames = min(map(len, tables))
        assert frames >= max(map(len, tables)) - 1  # a leading rest pose is dropped
        difference = np.linalg.norm(tables[0][-frames:] - tables[1][-frames:], axis=2)
        assert difference.max() < 1e-3


def test_both_formats_of_a_cmu_trial_are_taken_once(real_data: Path, tmp_path: Path) -> None:
    amc = sorted((real_data / "cmu" / "asf_amc").glob("02_*.amc"))
    bvh = sorted((real_data / "cmu" / "bvh").glob("*.bvh"))
    both = {path.stem for path in amc} & {path.stem for path in bvh}
    assert both
    report = build_database([*amc, *bvh], tmp_path / "db.smdb", tempo_copies=())
    assert {Path(path).stem for path, _ in report.duplicates} == both
    for path, reason in report.duplicates:
        assert reason.endswith(f": the same motion as {Path(path).stem}.amc")


def test_repetitions_are_no_duplicates(real_data: Path, tmp_path: Path) -> None:
    report = build_database([real_data / "hdm05"], tmp_path / "db.smdb", tempo_copies=())
    assert report.num_files == 233
    assert report.duplicates == []


@pytest.fixture(scope="module")
def two_actors(real_data: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("hdm05")
    for path in sorted((real_data / "hdm05").iterdir()):
        if path.name.startswith(("HDM_bd", "HDM_mm")):
            shutil.copy(path, folder)
    return folder


def test_what_a_performer_reads_is_what_the_database_holds(
    two_actors: Path, cli: Cli, tmp_path: Path
) -> None:
    """Own proportions and a take's samples change a reading little beside how much it varies."""
    assert cli("database", "build", two_actors, "-o", tmp_path / "db.smdb").exit_code == 0
    database = MotionDatabase(tmp_path / "db.smdb")
    originals = [clip for clip in database.clips if not is_copy(clip)]
    for clip in originals[::10]:
        performance = performed(two_actors / clip.source)
        inputs = performance.inputs([["specific_force"]] * 4)
        readings = all_readings(performance.take, inputs, database.rate_hz).specific_force
        rows = database.array("specific_force_end")[clip.begin : clip.end, :12]
        held = rows[: len(readings)].reshape(-1, 4, 3)
        difference = np.linalg.norm(readings[: len(held)] - held, axis=2).mean()
        variation = np.linalg.norm(held - held.mean(axis=0), axis=2).mean()
        assert difference < 0.25 * variation


def test_an_unknown_actor_is_harder_than_a_known_one(
    two_actors: Path, cli: Cli, tmp_path: Path
) -> None:
    told = {}
    for scenario in (1, 3):
        path = tmp_path / f"{scenario}.json"
        result = cli(
            "evaluate", "--database-source", two_actors, "--scenario", scenario,
            "--json", path, "--cache", tmp_path / "cache", "--method", "path_regression",
        )  # fmt: skip
        assert result.exit_code == 0, result.output
        told[scenario] = json.loads(path.read_text(encoding="utf-8"))["methods"]
    for method in ("path_regression", "oracle", "playback"):
        assert told[1][method]["mean_cm"] < told[3][method]["mean_cm"]
    assert told[1]["oracle"]["mean_cm"] < 9.0
    assert told[1]["path_regression"]["mean_cm"] > told[1]["oracle"]["mean_cm"]


def test_a_standing_performer_feels_gravity(real_data: Path) -> None:
    path = next(iter(sorted((real_data / "hdm05").glob("HDM_bd_grabHighR_*.amc"))))
    motion = standard_motion(read_motion(path)[0])[0]
    height = np.ptp(motion.joint_positions("world")[0][:, 1])
    assert 1.3 < height < 2.1
    take = performed(path).take
    for record in take.sensors.values():
        assert np.median(np.linalg.norm(record.specific_force, axis=1)) == pytest.approx(
            9.81, abs=1.0
        )
