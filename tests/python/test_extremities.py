# SPDX-License-Identifier: GPL-3.0-or-later
"""Feet, toes and hands: from motion files through databases and methods to what is written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from safetensors.numpy import load_file
from scipy.spatial.transform import Rotation
from sparse_mocap import (
    Motion,
    MotionDatabase,
    build_database,
    map_skeleton,
    noise_presets,
    noisy,
    read_motion,
    read_positions,
    reconstruct,
    simulated,
    standard_joint_names,
    standard_motion,
    with_extremities,
    write_acclaim,
    write_bvh,
)

Cli = Callable[..., Result]
NAMES = ["lfoot", "ltoes", "lhand", "rfoot", "rtoes", "rhand"]
SITES = ["left_wrist", "right_wrist", "left_ankle", "right_ankle"]


def rotations(motion: Motion, name: str) -> Rotation:
    """How a joint is turned in its parent."""
    values = np.asarray(motion.rotations)[:, motion.skeleton.names.index(name)]
    return Rotation.from_quat(values[:, [1, 2, 3, 0]])


def bone(motion: Motion, name: str) -> np.ndarray:
    """(T, 3) from where a joint turns to where it ends, world."""
    joint = motion.skeleton.names.index(name)
    return np.asarray(motion.joint_positions("world") - motion.pivot_positions())[:, joint]


def elevation(vectors: np.ndarray) -> np.ndarray:
    return np.arcsin(vectors[:, 1] / np.linalg.norm(vectors, axis=1))


def full_motion(path: Path) -> Motion:
    """A file's motion on a standard skeleton of its proportions with feet, toes and hands."""
    motion = read_motion(path)[0]
    plain = standard_motion(motion)[0]
    return standard_motion(motion, with_extremities(plain.skeleton))[0]


@pytest.fixture(scope="module")
def clip(real_data: Path) -> Path:
    return real_data / "hdm05" / "HDM_bd_sneak2StepsLStart_001_120.amc"


def world_rotations(motion: Motion, name: str) -> Rotation:
    """How a joint is turned in the world."""
    names, parents = motion.skeleton.names, motion.skeleton.parents
    joint = names.index(name)
    turned = rotations(motion, name)
    while (joint := parents[joint]) >= 0:
        turned = rotations(motion, names[joint]) * turned
    return turned


def test_feet_turn_as_the_files_do(real_data: Path) -> None:
    """What differs from the file's own bones is how they lie in rest, in every frame alike."""
    clips = sorted((real_data / "hdm05").glob("HDM_*_sneak*_001_120.amc"))[:3]
    clips += sorted((real_data / "cmu" / "asf_amc").glob("02_0[13].amc"))
    assert len(clips) >= 3
    for path in clips:
        file, standard = read_motion(path)[0], full_motion(path)
        begin = file.num_frames - standard.num_frames
        for name in ("lfoot", "rfoot", "ltoes", "rtoes"):
            apart = world_rotations(file, name)[begin:].inv() * world_rotations(standard, name)
            assert np.degrees((apart.mean().inv() * apart).magnitude()).max() < 0.01, (path, name)
            if name.endswith("toes"):
                continue
            theirs, ours = bone(file, name)[begin:], bone(standard, name)
            across = np.cross(theirs, ours)[:, 1] / (
                np.linalg.norm(theirs[:, [0, 2]], axis=1) * np.linalg.norm(ours[:, [0, 2]], axis=1)
            )
            assert np.median(np.abs(across)) < 0.12, (path, name)


def test_hands_bend_as_the_files_do(clip: Path) -> None:
    file, standard = read_motion(clip)[0], full_motion(clip)
    begin = file.num_frames - standard.num_frames
    for hand, wrist in (("lhand", "lwrist"), ("rhand", "rwrist")):

        def bend(motion: Motion, hand: str = hand, wrist: str = wrist) -> np.ndarray:
            a, b = bone(motion, hand), bone(motion, wrist)
            cosine = (a * b).sum(axis=1) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1)
            return np.degrees(np.arccos(np.clip(cosine, -1, 1)))

        np.testing.assert_allclose(bend(standard), bend(file)[begin:], atol=2.0)


@pytest.fixture(scope="module")
def walks(real_data: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("walks") / "db.smdb"
    files = sorted((real_data / "hdm05").glob("HDM_bd_sneak*.amc"))
    build_database(files, path, tempo_copies=(), mirror=True)
    return path


def test_a_database_keeps_them(walks: Path, real_data: Path) -> None:
    database = MotionDatabase(walks)
    public = load_file(walks)
    lengths = [one.end - one.begin for one in database.clips]
    scale = np.repeat(public["extremities/scale"], lengths, axis=0)
    rows = (public["extremities"] * scale).reshape(-1, 6, 3)
    np.testing.assert_allclose(database.array("extremities").reshape(rows.shape), rows)
    first = database.clips[0]
    truth = full_motion(real_data / "hdm05" / first.source).resampled(database.rate_hz)
    for index, name in enumerate(NAMES):
        held = Rotation.from_rotvec(rows[first.begin : first.end, index])
        apart = (held.inv() * rotations(truth, name)[: len(held)]).magnitude()
        assert apart.max() < 0.1, name
    (mirrored,) = (one for one in database.clips if one.is_mirrored and one.source == first.source)
    other = rows[mirrored.begin : mirrored.end][:, [3, 4, 5, 0, 1, 2]]
    np.testing.assert_allclose(other * [1, -1, -1], rows[first.begin : first.end], atol=2e-3)


def solve(walks: Path, clip: Path, method: str, best: bool) -> Motion:
    performed = standard_motion(read_motion(clip)[0])[0]
    take = noisy(simulated(performed, SITES, 100.0), noise_presets()["consumer"], 1)
    return reconstruct(take, walks, method=method, best_quality=best).motion


@pytest.mark.parametrize(
    ("method", "best"),
    [("path_regression", False), ("path_regression", True), ("tautges2011", False)],
)
def test_methods_give_them(walks: Path, clip: Path, method: str, best: bool) -> None:
    motion = solve(walks, clip, method, best)
    assert list(motion.skeleton.names) == [*standard_joint_names(), *NAMES]
    truth = full_motion(clip).resampled(1.0 / motion.frame_time_s)
    count = min(truth.num_frames, motion.num_frames)
    for name in ("lfoot", "rfoot"):
        found, wanted = rotations(motion, name)[:count], rotations(truth, name)[:count]
        apart = np.degrees((found.inv() * wanted).magnitude())
        still = np.degrees((found.mean().inv() * wanted).magnitude())
        assert np.median(apart) < 18.0, name
        assert np.median(apart) < np.median(still) + 8.0, name
    ends = np.asarray(motion.joint_positions("world"))[:, 21:, 1]
    assert ends.min() > -0.005
    steps = [
        (rotations(motion, name)[:-1].inv() * rotations(motion, name)[1:]).magnitude()
        for name in NAMES
    ]
    assert np.degrees(np.max(steps)) < 60.0


def test_they_are_written_and_read_again(walks: Path, clip: Path, tmp_path: Path) -> None:
    motion = solve(walks, clip, "path_regression", True)
    write_bvh(tmp_path / "take.bvh", motion)
    write_acclaim(tmp_path / "take.amc", motion)
    for name in ("take.bvh", "take.amc"):
        again = read_motion(tmp_path / name)[0]
        for joint in NAMES:
            begins = [
                one.pivot_positions()[:, one.skeleton.names.index(joint)] for one in (again, motion)
            ]
            np.testing.assert_allclose(*begins, atol=2e-4)
            apart = (rotations(again, joint).inv() * rotations(motion, joint)).magnitude()
            assert apart.max() < 1e-4


def test_rigs_turn_feet_toes_and_hands(walks: Path, clip: Path, real_data: Path) -> None:
    motion = solve(walks, clip, "path_regression", True)
    rig = read_motion(clip)[0]
    mapping = map_skeleton(rig)
    assert mapping.extremities == {name: name for name in NAMES}
    moved = mapping.to_rig(motion)
    for name in ("lfoot", "rfoot"):
        change = np.degrees(elevation(bone(moved, name)) - elevation(bone(motion, name)))
        assert np.std(change) < 3.0
    assert set(NAMES) <= set(mapping.turned_joints)


@pytest.mark.parametrize("best", [False, True])
def test_standing_feet_lie_flat(performance: Path, database_path: Path, best: bool) -> None:
    performed = standard_motion(read_motion(performance)[0])[0]
    take = noisy(simulated(performed, SITES, 100.0), noise_presets()["consumer"], 1)
    solved = reconstruct(take, database_path, best_quality=best)
    names = list(solved.motion.skeleton.names)
    ends = np.asarray(solved.motion.joint_positions("world"))
    balls, tips = (ends[:, [names.index(s + part) for s in "lr"], 1] for part in ("foot", "toes"))
    assert balls.min() > -0.005
    assert tips.min() > -0.005
    stands = np.asarray(solved.contacts) > 0.9
    settled = np.all([np.roll(stands, shift, axis=0) for shift in range(-4, 9)], axis=0)
    assert settled[10:-10].sum() > 20
    assert np.abs(balls - tips)[10:-10][settled[10:-10]].max() < 0.01


def test_positions_files_have_them_when_asked(
    cli: Cli, performance: Path, database_path: Path, tmp_path: Path
) -> None:
    take, table = tmp_path / "take.csv", tmp_path / "positions.csv"
    assert cli("simulate", performance, "-o", take).exit_code == 0
    arguments = ("reconstruct", "--database", database_path, take, "-o", tmp_path / "take.bvh")
    assert cli(*arguments, "--positions", table).exit_code == 0
    assert read_positions(table)[1] == standard_joint_names()
    assert cli(*arguments, "--positions", table, "--extremities").exit_code == 0
    _, names, points = read_positions(table)
    assert names == [*standard_joint_names(), *NAMES]
    assert points.shape[1:] == (27, 3)
    assert cli("convert", performance, "-o", table, "--extremities").exit_code == 0
    assert read_positions(table)[1] == names
    assert cli("convert", performance, "-o", table).exit_code == 0
    assert read_positions(table)[1] == standard_joint_names()


def test_inspect_says_which_are_in_the_file(cli: Cli, performance: Path) -> None:
    told = cli("inspect", performance).output
    for name in NAMES:
        assert any(line.startswith(name) for line in told.splitlines()), told
