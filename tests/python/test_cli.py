# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands, run inside this process."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from scipy.spatial.transform import Rotation
from sparse_mocap import (
    MotionDatabase,
    SensorRecord,
    Take,
    read_motion,
    read_positions,
    read_take,
    standard_motion,
    write_take,
)

Cli = Callable[..., Result]

COMMANDS = (
    ("database", "build"),
    ("database", "add"),
    ("database", "drop"),
    ("database", "info"),
    ("convert",),
    ("simulate",),
    ("reconstruct",),
    ("batch",),
    ("evaluate",),
    ("inspect",),
    ("ports",),
    ("record",),
    ("live",),
    ("emulate",),
)


@pytest.mark.parametrize("words", COMMANDS)
def test_every_command_has_help(cli: Cli, words: tuple[str, ...]) -> None:
    result = cli(*words, "--help")
    assert result.exit_code == 0
    assert result.output.startswith(f"Usage: app {' '.join(words)}")


def test_build_makes_the_database_it_tells_of(cli: Cli, library: Path, tmp_path: Path) -> None:
    path = tmp_path / "db.smdb"
    result = cli(
        "database", "build", library, "-o", path, "--fps", 30, "--mirror", "--reverse",
        "--exclude", "ADA_*", "--exclude", "*_walk_02.bvh",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    database = MotionDatabase(path)
    assert database.rate_hz == 30
    assert {clip.actor for clip in database.clips} == {"bruno"}
    assert "walk_02" not in {clip.name.partition("_")[2] for clip in database.clips}
    assert len(database.clips) == 4 * 3 * 5
    assert f"60 clips, {database.num_frames} frames" in result.output
    assert "from 5 files" in result.output


def test_build_says_what_it_left_out(cli: Cli, library: Path, tmp_path: Path) -> None:
    broken = tmp_path / "broken.bvh"
    broken.write_text("HIERARCHY\nROOT", encoding="utf-8")
    arguments = ("database", "build", library, broken, "-o", tmp_path / "db.smdb")
    result = cli(*arguments)
    assert result.exit_code == 0
    assert "1 skipped" in result.stdout
    assert f"warning: skipped: {broken}:2" in result.stderr
    (tmp_path / "db.smdb").unlink()
    strict = cli(*arguments, "--strict")
    assert strict.exit_code == 1
    assert strict.stderr.startswith(f"sparse-mocap: {broken}:2")
    assert not (tmp_path / "db.smdb").exists()


def test_info_as_json_is_what_the_database_holds(cli: Cli, database_path: Path) -> None:
    result = cli("database", "info", database_path, "--json")
    told = json.loads(result.stdout)
    database = MotionDatabase(database_path)
    assert told["frames"] == database.num_frames
    assert told["num_clips"] == len(told["clips"]) == len(database.clips) == 72
    assert (told["num_mirrored"], told["num_tempo_copies"]) == (36, 48)
    assert told["actors"] == {"ada": 36, "bruno": 36}
    assert told["build"]["mirror"] is True
    assert told["bytes"] == database_path.stat().st_size
    assert [clip["end"] for clip in told["clips"]] == [clip.end for clip in database.clips]


def test_info_is_readable(cli: Cli, database_path: Path) -> None:
    lines = cli("database", "info", database_path).stdout.splitlines()
    assert "actors   ada (36), bruno (36)" in lines
    assert all(line == line.rstrip() for line in lines)


def test_convert_keeps_the_files_own_skeleton(cli: Cli, performance: Path, tmp_path: Path) -> None:
    path = tmp_path / "copy.BVH"
    assert cli("convert", performance, "-o", path).exit_code == 0
    old, new = read_motion(performance)[0], read_motion(path)[0]
    assert new.skeleton.names == old.skeleton.names
    np.testing.assert_allclose(new.joint_positions(), old.joint_positions(), atol=1e-4)


@pytest.mark.parametrize("frame", ["heading", "root", "world"])
def test_convert_writes_positions_on_a_databases_skeleton(
    cli: Cli, performance: Path, database_path: Path, tmp_path: Path, frame: str
) -> None:
    path = tmp_path / "p.csv"
    result = cli("convert", performance, "-o", path, "--skeleton", database_path, "--frame", frame)
    assert result.exit_code == 0, result.output
    times, joints, positions = read_positions(path)
    skeleton = MotionDatabase(database_path).skeleton
    motion, _ = standard_motion(read_motion(performance)[0], skeleton)
    assert joints == skeleton.names
    np.testing.assert_allclose(times, np.arange(motion.num_frames) * motion.frame_time_s, atol=1e-6)
    np.testing.assert_allclose(positions, motion.joint_positions(frame), atol=1e-6)


def test_convert_writes_positions_with_the_clips_own_proportions(
    cli: Cli, performance: Path, tmp_path: Path
) -> None:
    assert cli("convert", performance, "-o", tmp_path / "p.csv", "--fps", 25).exit_code == 0
    motion = standard_motion(read_motion(performance)[0])[0].resampled(25.0)
    positions = read_positions(tmp_path / "p.csv")[2]
    np.testing.assert_allclose(positions, motion.joint_positions("heading"), atol=1e-6)


def test_simulate_writes_what_each_sensor_reads(
    cli: Cli, performance: Path, tmp_path: Path
) -> None:
    path = tmp_path / "take.csv"
    result = cli("simulate", performance, "-o", path, "--sites", "head,left_thigh", "--rate", 50)
    assert result.exit_code == 0, result.output
    take = read_take(path)
    assert take.sites == ["head", "left_thigh"]
    record = take.sensors["head"]
    np.testing.assert_allclose(np.diff(record.times_s), 0.02, atol=2e-6)
    assert np.median(np.linalg.norm(record.specific_force, axis=1)) == pytest.approx(9.81, abs=0.7)
    assert "noise none" in take.comments[0]


def test_simulate_is_repeatable_noise(cli: Cli, performance: Path, tmp_path: Path) -> None:
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        path = tmp_path / f"{name}.csv"
        cli("simulate", performance, "-o", path, "--noise", "consumer", "--seed", seed)
    a, b, c = ((tmp_path / f"{name}.csv").read_bytes() for name in "abc")
    assert a == b != c


def test_positions_are_simulated_when_asked_for(
    cli: Cli, performance: Path, tmp_path: Path
) -> None:
    path = tmp_path / "t.csv"
    cli("simulate", performance, "-o", path, "--sites", "head,left_ankle", "--with-positions")
    for site, record in read_take(path).sensors.items():
        assert record.position is not None
        assert record.orientation is not None
        height_m = 1.3 if site == "head" else 0.0
        assert (record.position[:, 1] > height_m).all(), site
        # Differentiated twice it is the specific force, turned into the world, without gravity.
        turns = Rotation.from_quat(np.roll(record.orientation, -1, axis=1))
        acceleration = turns.apply(record.specific_force) - [0.0, 9.81, 0.0]
        velocity = np.gradient(record.position, record.times_s, axis=0)
        change = velocity[150] - velocity[50]
        assert acceleration[50:150].sum(axis=0) * 0.01 == pytest.approx(change, abs=0.25), site


def test_the_old_name_of_a_position_along_the_bone_says_the_new_one(
    cli: Cli, performance: Path, tmp_path: Path
) -> None:
    for name, option in (("old", "--place"), ("new", "--position-along-bone")):
        path = tmp_path / f"{name}.csv"
        result = cli("simulate", performance, "-o", path, option, "left_ankle=0.4")
        assert result.exit_code == 0, result.output
        assert ("write --position-along-bone left_ankle=0.4" in result.output) == (name == "old")
    assert (tmp_path / "old.csv").read_bytes() == (tmp_path / "new.csv").read_bytes()
    assert "--place" not in cli("simulate", "--help").output


def test_a_position_along_the_bone_changes_the_reading(
    cli: Cli, performance: Path, tmp_path: Path
) -> None:
    cli("simulate", performance, "-o", tmp_path / "end.csv")
    cli(
        "simulate", performance, "-o", tmp_path / "mid.csv",
        "--position-along-bone", "left_ankle=0.4",
    )  # fmt: skip
    end, mid = read_take(tmp_path / "end.csv"), read_take(tmp_path / "mid.csv")
    for site in end.sites:
        is_same = np.allclose(end.sensors[site].specific_force, mid.sensors[site].specific_force)
        assert is_same == (site != "left_ankle")


@pytest.mark.parametrize(
    ("sensors", "apart_m"),
    # A clavicle that moves as fast as people can may twist by half a degree, which is left out
    # where the file is brought onto the standard skeleton.
    [("--no-gyroscopes", 2e-4), ("--gyroscopes", 3e-4)],
)
def test_reconstruct_writes_motion_positions_and_report(
    cli: Cli, take_path: Path, database_path: Path, tmp_path: Path, sensors: str, apart_m: float
) -> None:
    result = cli(
        "reconstruct", "--database", database_path, take_path, "-o", tmp_path / "out.bvh", sensors,
        "--positions", tmp_path / "out.csv", "--json", tmp_path / "out.json",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    motion, _ = read_motion(tmp_path / "out.bvh")
    times, joints, positions = read_positions(tmp_path / "out.csv")
    told = json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))
    assert motion.frame_time_s == pytest.approx(1 / 25)
    assert motion.num_frames == len(times) == len(positions) == len(told["frames"])
    assert joints == MotionDatabase(database_path).skeleton.names
    on_standard, _ = standard_motion(motion, MotionDatabase(database_path).skeleton)
    np.testing.assert_allclose(on_standard.joint_positions("heading"), positions, atol=apart_m)
    assert told["sites"] == ["left_wrist", "right_wrist", "left_ankle", "right_ankle"]
    assert (told["format"], told["format_version"]) == ("sparse_mocap_report", 1)
    assert told["options"]["method"] == "path_regression"
    assert f"{told['latency_ms']:.0f} ms delay" in result.stdout
    assert f"sensors match the motion database: {told['match']}" in result.stdout
    assert sum(told["clips"].values()) == len(times)
    assert set(told["frames"][0]) == {"time_s", "misfit_mps2", "spread_m", "clip"}


def test_reconstruct_starts_when_the_take_does(
    cli: Cli, take_path: Path, database_path: Path, tmp_path: Path
) -> None:
    take = read_take(take_path)
    late = {
        site: replace(record, times_s=record.times_s + 12.345)
        for site, record in take.sensors.items()
    }
    write_take(tmp_path / "late.csv", Take(late))
    positions = {}
    for name, path in (("a", take_path), ("b", tmp_path / "late.csv")):
        out = tmp_path / f"{name}.csv"
        cli(
            "reconstruct", "--database", database_path, path, "-o", tmp_path / "out.bvh",
            "--positions", out, "--frame", "world", "--offline",
        )  # fmt: skip
        positions[name] = read_positions(out)
    np.testing.assert_allclose(positions["b"][0] - positions["a"][0], 12.345, atol=2e-6)
    np.testing.assert_allclose(positions["b"][2], positions["a"][2], atol=1e-3)


def test_reconstruct_says_when_readings_cannot_be_specific_forces(
    cli: Cli, take_path: Path, database_path: Path, tmp_path: Path
) -> None:
    take = read_take(take_path)
    in_g = {
        site: SensorRecord(record.times_s, record.specific_force / 9.81)
        for site, record in take.sensors.items()
    }
    write_take(tmp_path / "g.csv", Take(in_g))
    result = cli(
        "reconstruct", "--database", database_path, tmp_path / "g.csv", "-o", tmp_path / "o.bvh"
    )
    assert result.exit_code == 0
    assert "warning: left_wrist reads 1.0" in result.stderr


def test_reconstruct_says_when_rates_cannot_be_radians(
    cli: Cli, take_path: Path, database_path: Path, tmp_path: Path
) -> None:
    take = read_take(take_path)
    in_degrees = {
        site: SensorRecord(
            record.times_s, record.specific_force, np.degrees(record.angular_velocity)
        )
        for site, record in take.sensors.items()
    }
    write_take(tmp_path / "deg.csv", Take(in_degrees))
    for path, is_told in ((tmp_path / "deg.csv", True), (take_path, False)):
        result = cli("reconstruct", "--database", database_path, path, "-o", tmp_path / "o.bvh")
        assert result.exit_code == 0
        assert ("rad/s on median" in result.stderr) == is_told


def test_reconstruct_says_when_the_database_knows_nothing_of_it(
    cli: Cli, take_path: Path, database_path: Path, tmp_path: Path
) -> None:
    told = {}
    rng = np.random.default_rng(0)
    shaken = {
        site: SensorRecord(np.arange(300) / 100, 60 * rng.normal(size=(10, 3)).repeat(30, axis=0))
        for site in read_take(take_path).sites
    }
    write_take(tmp_path / "shaken.csv", Take(shaken))
    for name, path in (("known", take_path), ("unknown", tmp_path / "shaken.csv")):
        arguments = ("--database", database_path, path, "-o", tmp_path / "o.bvh")
        told[name] = cli("reconstruct", *arguments).stdout.splitlines()
    assert len(told["known"]) == 1
    assert len(told["unknown"]) == 2
    assert "has nothing like this take" in told["unknown"][1]
