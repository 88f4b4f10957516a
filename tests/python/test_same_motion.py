# SPDX-License-Identifier: GPL-3.0-or-later
"""A test's own movement is never in its database, whatever its files are called."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from sparse_mocap import Motion, MotionDatabase, build_database, read_motion, write_bvh
from sparse_mocap.evaluation import Settings, evaluate
from sparse_mocap.evaluation.same_motion import same_motion, seen_in_a_mirror

BEGIN, END = 300, 800
"""Frames of the performance that are the test clip."""


def at_another_tempo(motion: Motion, tempo: float) -> Motion:
    return Motion(
        motion.skeleton, motion.frame_time_s / tempo, motion.root_positions, motion.rotations
    )


def made_clips(performance: Path) -> tuple[dict[str, Motion], dict[str, Motion]]:
    """Clips with the test's movement, by name, and clips with other movements."""
    whole = read_motion(performance)[0]
    cut = whole.trimmed(BEGIN, END)
    same = {
        "cut_hop_1": cut,
        "zoe_swim_1": whole,
        "zoe_swim_2": whole.trimmed(BEGIN - 37, END + 51),
        "yan_dance_1": whole.trimmed(BEGIN + 2, END).resampled(47.0),
        "yan_dance_2": cut.mirrored(),
        "yan_dance_3": cut.reversed(),
        "yan_dance_4": whole.mirrored().reversed(),
        "xia_jump_1": whole.trimmed(BEGIN + 100, END - 100),
        "xia_jump_2": at_another_tempo(cut, 0.8),
        "xia_jump_3": whole.trimmed(BEGIN + 100, END + 90),  # most of it
    }
    return same, {"other_hop_1": whole.trimmed(END + 150, whole.num_frames)}


@pytest.fixture(scope="module")
def folder(
    performance: Path, library: Path, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Path, set[str]]:
    folder = tmp_path_factory.mktemp("same")
    same, others = made_clips(performance)
    for name, motion in (same | others).items():
        write_bvh(folder / f"{name}.bvh", motion)
    for path in library.glob("ada_*.bvh"):
        shutil.copy(path, folder)
    return folder, {f"{name}.bvh" for name in same}


@pytest.fixture(scope="module")
def database(folder: tuple[Path, set[str]], tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("same_database") / "same.smdb"
    build_database([folder[0]], path, mirror=True, tempo_copies=(), keep_duplicates=True)
    return path


def test_the_same_movement_is_found_by_its_poses(
    folder: tuple[Path, set[str]], database: Path
) -> None:
    opened = MotionDatabase(database)
    (clip,) = [c for c in opened.clips if c.source == "cut_hop_1.bvh" and not c.is_mirrored]
    assert same_motion(opened).sources_with(clip.begin, clip.end) == folder[1]


def test_a_longer_take_hides_the_clips_that_were_cut_out_of_it(
    folder: tuple[Path, set[str]], database: Path
) -> None:
    opened = MotionDatabase(database)
    (whole,) = [c for c in opened.clips if c.source == "zoe_swim_1.bvh" and not c.is_mirrored]
    found = same_motion(opened).sources_with(whole.begin, whole.end)
    assert found == folder[1] | {"other_hop_1.bvh"}


def test_a_still_pose_is_not_the_same_as_another() -> None:
    from sparse_mocap.evaluation.same_motion import SameMotion

    still = np.zeros((60, 6))
    still[30:, 1] += 0.001
    clips = [(0, 30, "one"), (30, 60, "other")]
    assert SameMotion(still, clips, ["lone", "rone"]).sources_with(0, 30) == frozenset()


def test_the_evaluation_hides_all_of_it(folder: tuple[Path, set[str]], database: Path) -> None:
    path, same = folder
    settings = Settings(1, tests="cut_hop_1.bvh", with_baselines=False)
    (test,) = evaluate(MotionDatabase(database), path, settings).tests
    assert test.num_excluded == 2 * len(same)  # mirrored copies as well


def test_a_mirror_is_that_of_the_database(database: Path) -> None:
    opened = MotionDatabase(database)
    clip, copy = opened.clips[:2]
    assert (clip.source, copy.is_mirrored) == (copy.source, True)
    rows = np.asarray(opened.array("positions"), float)
    mirrored = seen_in_a_mirror(rows[clip.begin : clip.end], opened.skeleton.names)
    np.testing.assert_allclose(mirrored, rows[copy.begin : copy.end], atol=2e-3)
