# SPDX-License-Identifier: GPL-3.0-or-later
"""The evaluation: its protocol, its figures, and that they are what anyone would compute."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from sparse_mocap import MotionDatabase, Take, read_take, write_take
from sparse_mocap.evaluation import (
    BASELINES,
    ClipResult,
    Evaluation,
    Movement,
    Settings,
    TestClip,
    contenders,
    evaluate,
    frame_errors,
    interpolated,
    joint_angle_errors_deg,
    joint_errors,
    mean_jerk,
)
from sparse_mocap.evaluation.metrics import LIMBS, euler_errors_deg

Cli = Callable[..., Result]

LIVE = ("path_regression", "tautges2011")


def test_errors_have_their_closed_form() -> None:
    truth = np.zeros((2, 2, 3))
    estimate = np.array([[[3.0, 4, 0], [0, 0, 0]], [[0, 0, 1], [0, 1, 0]]])
    errors = joint_errors(truth, estimate)
    np.testing.assert_allclose(errors, [[5, 0], [1, 1]])
    np.testing.assert_allclose(frame_errors(errors), [np.sqrt(12.5), 1])


def test_angle_errors_are_the_angles_between_rotations() -> None:
    half = np.radians(30.0) / 2
    turned = np.array([[[np.cos(half), np.sin(half), 0, 0], [-1.0, 0, 0, 0]]])
    still = np.array([[[1.0, 0, 0, 0], [1.0, 0, 0, 0]]])
    np.testing.assert_allclose(joint_angle_errors_deg(still, turned), [[30.0, 0.0]], atol=1e-6)


def test_euler_errors_are_means_of_the_shorter_turns() -> None:
    truth = np.radians([[0.0, 179.0], [10.0, 20.0]])
    estimate = np.radians([[2.0, -179.0], [4.0, 20.0]])
    np.testing.assert_allclose(euler_errors_deg(truth, estimate), [2.0, 3.0])


def test_angles_turn_joints_as_rotations_do(database: MotionDatabase) -> None:
    angles = np.asarray(database.array("angles")[:20], float)
    skeleton, motion = database.skeleton, database.clip_motion(0)
    found = skeleton.angles(motion.rotations[:20], angles)
    np.testing.assert_allclose(found[:, 3:], angles[:, 3:], atol=1e-3)  # the root has a heading
    with pytest.raises(ValueError, match="rotations"):
        skeleton.angles(motion.rotations[:, :5])


def test_jerk_is_the_third_derivative() -> None:
    times = np.arange(50) / 25
    cubic = np.zeros((50, 1, 3))
    cubic[:, 0, 1] = 2.0 * times**3
    assert mean_jerk(cubic, 25.0) == pytest.approx(12.0 / 1000)
    assert np.isnan(mean_jerk(cubic[:3], 25.0))


def test_values_are_interpolated_linearly() -> None:
    values = np.array([[0.0, 10.0], [1.0, 20.0]])
    np.testing.assert_allclose(
        interpolated(np.array([0.0, 2.0]), values, np.array([0.5, 2.0])), [[0.25, 12.5], [1, 20]]
    )


@pytest.fixture(scope="module")
def found(library: Path, tmp_path_factory: pytest.TempPathFactory, cli_once: Cli) -> dict:
    folder = tmp_path_factory.mktemp("evaluation")
    result = cli_once(
        "evaluate", "--database-source", library, "--scenario", 1, "--offline",
        "--json", folder / "e.json", "--plots", folder / "plots", "--cache", folder / "cache",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    told = json.loads((folder / "e.json").read_text(encoding="utf-8"))
    return told | {"folder": folder, "stdout": result.stdout}


@pytest.fixture(scope="module")
def cli_once() -> Cli:
    from click.testing import CliRunner
    from sparse_mocap.cli.app import app

    return lambda *words: CliRunner().invoke(app, [str(word) for word in words])


def test_every_method_is_tested_on_every_clip(found: dict) -> None:
    methods = ["path_regression", "path_regression, best", "tautges2011", *BASELINES]
    assert (found["format"], found["format_version"]) == ("sparse_mocap_evaluation", 1)
    assert list(found["methods"]) == methods
    assert len(found["tests"]) == 2 * 4
    for test in found["tests"]:
        assert list(test["error_cm"]) == methods
        # The kicks mirror each other, and the squats are one movement at two tempos.
        assert test["excluded_clips"] == (6 if test["motion_class"] == "walk" else 12)
    assert found["left_out"] == []


def test_the_figures_are_means_over_clips(found: dict) -> None:
    for name, method in found["methods"].items():
        errors = [test["error_cm"][name] for test in found["tests"]]
        assert method["mean_cm"] == pytest.approx(np.mean(errors))
        assert method["median_cm"] == pytest.approx(np.median(errors))
        assert set(method["class_errors_cm"]) == {"walk", "squat", "kickleft", "kickright"}
        assert len(method["joint_errors_cm"]) == 21
        assert sum(method["histogram"]["frames"]) > 100
        frames = method["root_frame"]["histogram"]["frames"]
        assert sum(frames) == sum(method["histogram"]["frames"])
        root_frame = [test["root_frame_cm"][name] for test in found["tests"]]
        assert method["root_frame"]["p90_cm"] == pytest.approx(np.percentile(root_frame, 90))
        assert 0 < method["centred_cm"] <= method["mean_cm"] * 1.01
        assert set(method["limb_angles_deg"]) == set(LIMBS)
        assert (method["joint_angle_deg"] is None) == (name in BASELINES)
        assert (method["latency_ms"] is None) == (name not in LIVE)


def test_the_oracle_bounds_what_the_database_can_give(found: dict) -> None:
    methods = found["methods"]
    assert methods["oracle"]["mean_cm"] < methods["playback"]["mean_cm"]
    assert methods["oracle"]["mean_cm"] < methods["window of 10"]["mean_cm"]
    assert methods["mean pose"]["jerk_kmps3"] == 0
    assert 0 < methods["path_regression"]["mean_cm"] < methods["mean pose"]["mean_cm"]


def test_movement_is_a_mean_over_clips_beside_the_truth(found: dict) -> None:
    truth = found["truth_movement"]
    assert 0 < truth["turn_deg"]["lwrist"] < 10
    assert truth["under_floor"] == 0
    for name, method in found["methods"].items():
        assert (method["movement"] == {}) == (name in BASELINES)
        if name in BASELINES:
            continue
        moved = [test["movement"][name] for test in found["tests"]]
        for figure in ("standing_cmps", "under_floor", "fast_turns"):
            known = [told[figure] for told in moved if told[figure] is not None]
            assert method["movement"][figure] == pytest.approx(np.mean(known))
        steps = [told["largest_step_cm"] for told in moved]
        assert method["movement"]["largest_step_cm"] == max(steps)
        assert method["jumps"]["over_50_cm"] == sum(step > 50 for step in steps)
        ratios = [t["jerk_kmps3"][name] / t["jerk_kmps3"]["truth"] for t in found["tests"]]
        assert method["jerk_ratio"] == pytest.approx(np.mean(ratios))
        walks = [t for t in found["tests"] if t["motion_class"] == "walk"]
        of_walks = method["classes"]["walk"]
        assert of_walks["tests"] == len(walks) > 0
        sunk = [test["movement"][name]["under_floor"] for test in walks]
        assert of_walks["movement"]["under_floor"] == pytest.approx(np.mean(sunk))
        assert of_walks["largest_jerk_ratio"] == pytest.approx(
            max(t["jerk_kmps3"][name] / t["jerk_kmps3"]["truth"] for t in walks)
        )


def test_warnings_are_right_where_a_held_pose_is_better() -> None:
    def clip(mean_cm: float, match: str) -> TestClip:
        held = ClipResult(np.array([10.0]), np.zeros(1), 0.0)
        tried = ClipResult(np.array([mean_cm]), np.zeros(1), 0.1, match=match)
        movement = Movement(np.zeros(1), 0.0, 1.0, 1.0, 0.0, 0.0, {}, {})
        return TestClip("a", "a", "a", 1, 0, 0.1, movement, {"m": tried, "mean pose": held})

    told = [(12.0, "poor"), (13.0, "good"), (14.0, "poor"), (5.0, "poor"), (6.0, "fair")]
    tests = [clip(*one) for one in told]
    found = Evaluation(1, {}, ["root"], {"m": None, "mean pose": None}, tests)
    assert found.warnings("m") == pytest.approx({"precision": 2 / 3, "recall": 2 / 3})
    assert found.warnings("mean pose") == {"precision": None, "recall": None}


def test_an_evaluation_is_told_drawn_and_kept(found: dict) -> None:
    for word in ("oracle", "latency (ms)", "kickleft", "rwrist", "sunk (%)", "warnings"):
        assert word in found["stdout"]
    pictures = sorted((found["folder"] / "plots").iterdir())
    names = [path.name for path in pictures]
    assert [name for name in names if not name.endswith("_angles.png")] == [
        f"scenario1_{what}.png" for what in ("classes", "histogram", "joints")
    ]
    assert "scenario1_ada_walk_01_angles.png" in names  # frame by frame
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in pictures)
    assert len(list((found["folder"] / "cache").glob("*.smdb"))) == 1


@pytest.mark.parametrize("scenario", [2, 3])
def test_other_scenarios_hide_more(database: MotionDatabase, library: Path, scenario: int) -> None:
    settings = Settings(scenario, tests="ada_walk_01.bvh")
    result = evaluate(database, library, settings)
    assert result.tests[0].num_excluded == {2: 6 + 36, 3: 36}[scenario]


def test_an_actor_without_other_clips_is_left_out_of_scenario_2(
    library: Path, tmp_path: Path, cli: Cli
) -> None:
    (tmp_path / "ada_walk_01.bvh").write_bytes((library / "ada_walk_01.bvh").read_bytes())
    for name in ("bruno_walk_01.bvh", "bruno_squat_01.bvh"):
        (tmp_path / name).write_bytes((library / name).read_bytes())
    result = cli(
        "evaluate", "--database-source", tmp_path, "--scenario", 2, "--method", "path_regression"
    )
    assert result.exit_code == 0, result.output
    assert "warning: not tested: ada_walk_01" in result.stderr
    assert "2 clips" in result.stdout


def independent_error(truth: Path, result: Path) -> float:
    """The mean error in cm of one positions file against another, by nothing of the package."""
    tables = []
    for path in (truth, result):
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        tables.append((rows[0], np.array(rows[1:], float)))
    (head, one), (other_head, two) = tables
    assert head == other_head
    inside = one[one[:, 0] <= two[-1, 0] + 1e-6]
    columns = [np.interp(inside[:, 0], two[:, 0], two[:, k]) for k in range(1, two.shape[1])]
    square = ((np.stack(columns, 1) - inside[:, 1:]) ** 2).reshape(len(inside), -1, 3).sum(2)
    return float(100 * np.sqrt(square.mean(1)).mean())


@pytest.mark.parametrize(
    ("method", "gyroscopes"),
    [("path_regression", False), ("path_regression", True), ("tautges2011", False)],
)
def test_hidden_is_as_good_as_absent(
    library: Path,
    database: MotionDatabase,
    tmp_path: Path,
    cli: Cli,
    method: str,
    gyroscopes: bool,
) -> None:
    """The evaluation's figure is that of the commands on a database built without the clip."""
    name = "bruno_walk_01.bvh"
    settings = Settings(1, tuple(contenders((method,))), tests=name, with_gyroscopes=gyroscopes)
    (test,) = evaluate(database, library, settings).tests
    path = {
        what: tmp_path / what
        for what in ("db.smdb", "everything.csv", "take.csv", "o.bvh", "o.csv", "t.csv")
    }
    for words in (
        ("database", "build", library, "-o", path["db.smdb"], "--mirror", "--exclude", name),
        ("simulate", library / name, "-o", path["everything.csv"]),
    ):
        result = cli(*words)
        assert result.exit_code == 0, result.output
    simulated = read_take(path["everything.csv"]).sensors
    write_take(
        path["take.csv"],
        Take({site: replace(record, orientation=None) for site, record in simulated.items()}),
    )
    for words in (
        ("reconstruct", "--database", path["db.smdb"], path["take.csv"], "-o", path["o.bvh"],
         "--method", method, "--gyroscopes" if gyroscopes else "--no-gyroscopes",
         "--positions", path["o.csv"]),
        ("convert", library / name, "-o", path["t.csv"], "--skeleton", path["db.smdb"],
         "--fps", 25),
    ):  # fmt: skip
        result = cli(*words)
        assert result.exit_code == 0, result.output
    error = independent_error(path["t.csv"], path["o.csv"])
    assert test.results[method].mean_cm == pytest.approx(error, abs=0.02)


def test_noise_is_part_of_the_evaluation(database: MotionDatabase, library: Path) -> None:
    clean, dirty = (
        evaluate(
            database,
            library,
            Settings(1, tests="bruno_walk_01.bvh", noise=noise),
        )
        for noise in ("none", "consumer")
    )
    assert clean.clip_means_cm("oracle") == dirty.clip_means_cm("oracle")
    assert clean.clip_means_cm("path_regression") != dirty.clip_means_cm("path_regression")


def test_a_papers_comparison_is_run_variant_by_variant(
    library: Path, tmp_path: Path, cli: Cli
) -> None:
    result = cli(
        "evaluate", "--database-source", library, "--scenario", 1, "--experiment", "prior",
        "--tests", "ada_walk_01.bvh", "--json", tmp_path / "e.json",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    told = json.loads((tmp_path / "e.json").read_text(encoding="utf-8"))
    variants = ["kernel regression", "Mahalanobis distances"]
    assert [name in told["methods"] for name in variants] == [True, True]
    means = [told["methods"][name]["mean_cm"] for name in variants]
    assert means[0] != means[1]


def test_trackers_are_compared_with_their_own_channels(
    library: Path, tmp_path: Path, cli: Cli
) -> None:
    result = cli(
        "evaluate", "--database-source", library, "--scenario", 1, "--experiment", "combinations",
        "--method", "liu2011", "--tests", "ada_walk_01.bvh", "--fps", 40,
        "--json", tmp_path / "e.json",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    told = json.loads((tmp_path / "e.json").read_text(encoding="utf-8"))
    assert told["settings"]["rate_hz"] == 40.0
    angles = {name: method["euler_angle_deg"] for name, method in told["methods"].items()}
    assert angles["positions and orientations"] < angles["positions"]
    (frames,) = [test["euler_angle_deg"]["positions"] for test in told["tests"]]
    assert np.mean(frames) == pytest.approx(angles["positions"], abs=1e-3)


def test_only_methods_that_can_use_the_channels_are_evaluated(
    library: Path, tmp_path: Path, cli: Cli
) -> None:
    result = cli(
        "evaluate", "--database-source", library, "--scenario", 1, "--channels", "orientation",
        "--tests", "ada_walk_01.bvh", "--json", tmp_path / "e.json",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    told = json.loads((tmp_path / "e.json").read_text(encoding="utf-8"))
    assert [name for name in told["methods"] if name not in BASELINES] == ["liu2011 default"]
    wrong = cli("evaluate", "--database-source", library, "--scenario", 1, "--channels", "smell")
    assert wrong.exit_code == 2
    assert "'smell' is none of specific_force" in wrong.output


def test_training_and_test_clips_can_be_paired(database: MotionDatabase, library: Path) -> None:
    settings = Settings(1, pairs=(("ada_*.bvh", "bruno_walk_01.bvh"),))
    (test,) = evaluate(database, library, settings).tests
    known = [clip for clip in database.clips if clip.actor == "ada"]
    originals = [clip for clip in known if not clip.is_mirrored and clip.tempo == 1.0]
    assert test.num_excluded == len(database.clips) - len(originals)
