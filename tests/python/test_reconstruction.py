# SPDX-License-Identifier: GPL-3.0-or-later
"""Reconstruction through Python: one interface for every method, and what it promises."""

from __future__ import annotations

import threading
import time
from pathlib import Path

import numpy as np
import pytest
from sparse_mocap import (
    Cancelled,
    Clip,
    ConfigError,
    MotionDatabase,
    Reconstructor,
    SensorRecord,
    Take,
    method_names,
    nearest_poses,
    nearest_windows,
    playback_best_path,
    preset_names,
    read_take,
    resampled,
)
from sparse_mocap.reconstruction import suspicions

SITES = ["left_wrist", "right_wrist", "left_ankle", "right_ankle"]


@pytest.fixture(scope="module")
def readings(take_path: Path, database: MotionDatabase) -> np.ndarray:
    return resampled(read_take(take_path), database.rate_hz)[1]


def test_the_papers_settings_are_a_preset_of_the_main_method() -> None:
    assert "tautges2011" in method_names()
    assert {"default", "paper"} <= set(preset_names("tautges2011"))


@pytest.mark.parametrize("offline", [False, True])
def test_a_take_is_solved_frame_by_frame(
    database: MotionDatabase, readings: np.ndarray, offline: bool
) -> None:
    solved = Reconstructor(database, SITES).solve(readings, offline=offline)
    frames = len(readings)
    assert solved.motion.num_frames == frames
    assert solved.motion.frame_time_s == pytest.approx(1 / database.rate_hz)
    assert solved.motion.skeleton.names == database.skeleton.names
    shapes = {
        "angles": (43,),
        "positions": (21, 3),
        "contacts": (2,),
        "spread_m": (21,),
        "sensor_misfit_mps2": (4,),
        "clips": (),
        "database_frames": (),
    }
    for name, shape in shapes.items():
        values = getattr(solved, name)
        assert values.shape == (frames, *shape), name
        assert np.isfinite(values).all(), name
    assert ((solved.contacts >= 0) & (solved.contacts <= 1 + 1e-9)).all()
    clips: list[Clip] = database.clips
    for clip, frame in zip(solved.clips.tolist(), solved.database_frames.tolist(), strict=True):
        assert clips[clip].begin <= frame < clips[clip].end
    positions = solved.motion.joint_positions("heading")
    np.testing.assert_allclose(positions, solved.positions, atol=1e-5)


def test_steps_and_a_flush_are_an_online_solution(
    database: MotionDatabase, readings: np.ndarray
) -> None:
    reconstructor = Reconstructor(database, SITES)
    solved = reconstructor.solve(readings)
    reconstructor.reset()
    steps = [reconstructor.step(reading) for reading in readings]
    assert [step is None for step in steps] == [
        index < reconstructor.latency_frames for index in range(len(steps))
    ]
    estimates = [step for step in steps if step is not None] + reconstructor.flush()
    assert len(estimates) == len(readings)
    np.testing.assert_array_equal([one.angles for one in estimates], solved.angles)
    np.testing.assert_array_equal([one.clip for one in estimates], solved.clips)
    assert estimates[0].rotations.shape == (21, 4)
    np.testing.assert_allclose(
        np.linalg.norm([one.rotations for one in estimates], axis=2), 1, atol=1e-9
    )


def test_the_same_take_gives_the_same_bits(database: MotionDatabase, readings: np.ndarray) -> None:
    one, two = (Reconstructor(database, SITES).solve(readings[:60]) for _ in range(2))
    np.testing.assert_array_equal(one.angles, two.angles)


def test_silent_sensors_are_done_without(database: MotionDatabase, readings: np.ndarray) -> None:
    partly = readings[:80].copy()
    partly[20:45, 1] = np.nan
    partly[50:55] = np.nan
    solved = Reconstructor(database, SITES).solve(partly)
    assert np.isfinite(solved.positions).all()


@pytest.mark.parametrize("sites", [["left_wrist"], ["right_ankle", "head", "pelvis"]])
def test_other_sets_of_sensors_work(
    database: MotionDatabase, readings: np.ndarray, sites: list[str]
) -> None:
    solved = Reconstructor(database, sites).solve(readings[:40, : len(sites)])
    assert np.isfinite(solved.positions).all()


def test_wrong_arguments_are_refused(database: MotionDatabase, readings: np.ndarray) -> None:
    with pytest.raises(ConfigError, match="at least one sensor"):
        Reconstructor(database, [])
    with pytest.raises(ConfigError, match="unknown sensor 'nose'"):
        Reconstructor(database, ["nose"])
    with pytest.raises(ConfigError, match="magic"):
        Reconstructor(database, SITES, method="magic")
    with pytest.raises(ConfigError, match="magic"):
        Reconstructor(database, SITES, preset="magic")
    with pytest.raises(ConfigError, match="every clip of the database is excluded"):
        Reconstructor(database, SITES, excluded_clips=range(len(database.clips)))
    with pytest.raises(ValueError, match="places"):
        Reconstructor(database, SITES, places=[1.0])
    reconstructor = Reconstructor(database, SITES)
    with pytest.raises(ValueError, match=r"\(any, 4, 3\), got \(3, 3, 3\)"):
        reconstructor.solve(readings[:3, :3])
    with pytest.raises(ValueError, match=r"\(4, 3\), got \(3,?\)"):
        reconstructor.step(np.zeros(3))


def test_excluded_clips_are_never_leant_on(database: MotionDatabase, readings: np.ndarray) -> None:
    excluded = [i for i, clip in enumerate(database.clips) if clip.motion_class == "walk"]
    solved = Reconstructor(database, SITES, excluded_clips=excluded).solve(readings[:60])
    assert not set(solved.clips.tolist()) & set(excluded)


def test_a_solution_can_be_stopped(database: MotionDatabase, readings: np.ndarray) -> None:
    with pytest.raises(Cancelled):
        Reconstructor(database, SITES).solve(readings, progress=lambda *_: False)


def test_other_threads_run_during_a_solution(
    database: MotionDatabase, readings: np.ndarray
) -> None:
    long = np.concatenate([readings] * 3)
    ticks: list[float] = []
    done = threading.Event()

    def tick() -> None:
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.001)

    reconstructor = Reconstructor(database, SITES)
    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.monotonic()
    reconstructor.solve(long)
    end = time.monotonic()
    done.set()
    thread.join()
    during = [at for at in ticks if begin <= at <= end]
    assert len(during) > 20 * (end - begin)


def shown_clips(database: MotionDatabase, hidden: list[int]) -> list[Clip]:
    """What baselines look at: no copies at other tempos, which are not part of the paper."""
    clips = enumerate(database.clips)
    return [clip for i, clip in clips if i not in hidden and clip.tempo == 1.0]


def test_the_nearest_pose_is_the_nearest(database: MotionDatabase) -> None:
    positions = database.array("positions")
    hidden = [i for i, clip in enumerate(database.clips) if clip.actor == "ada"]
    shown = np.concatenate([np.arange(c.begin, c.end) for c in shown_clips(database, hidden)])
    wanted = positions[::97].astype(float)
    found = nearest_poses(database, wanted.reshape(-1, 21, 3), hidden)
    distances = np.linalg.norm(positions[shown][None] - wanted[:, None], axis=2)
    np.testing.assert_allclose(
        np.linalg.norm(positions[found] - wanted, axis=1), distances.min(axis=1), atol=1e-6
    )
    assert set(found.tolist()) <= set(shown.tolist())


def test_the_nearest_window_is_the_nearest(database: MotionDatabase, readings: np.ndarray) -> None:
    force = database.array("specific_force_end")[:, :12].astype(float)
    query = readings[:50].reshape(50, 12)
    hidden, window = [0, 5], 4

    def windows(rows: np.ndarray) -> np.ndarray:
        before = np.maximum(np.arange(len(rows))[:, None] - np.arange(window), 0)
        return rows[before].reshape(len(rows), -1)

    clips = shown_clips(database, hidden)
    frames = np.concatenate([np.arange(c.begin, c.end) for c in clips])
    features = np.concatenate([windows(force[c.begin : c.end]) for c in clips])
    distances = np.linalg.norm(windows(query)[:, None] - features[None], axis=2)
    found = nearest_windows(database, SITES, readings[:50], window, hidden)
    place = {int(frame): index for index, frame in enumerate(frames)}
    got = distances[np.arange(50), [place[frame] for frame in found.tolist()]]
    np.testing.assert_allclose(got, distances.min(axis=1), atol=1e-4)


def test_played_back_frames_are_the_databases(
    database: MotionDatabase, readings: np.ndarray
) -> None:
    found = playback_best_path(database, SITES, readings, [0, 1, 2])
    assert len(found) == len(readings)
    hidden = database.clips[2].end
    assert ((found >= hidden) & (found < database.num_frames)).all()


@pytest.mark.parametrize(
    ("force", "told"),
    [
        (np.zeros(3), "reads 0.00 m/s^2 on median"),
        (np.array([0.0, 0.0, 1.0]), "reads 1.00 m/s^2 on median"),  # in g
        (np.array([0.0, 0.0, 9.81]), "always reads the same"),
    ],
)
def test_readings_that_can_hardly_be_are_told(force: np.ndarray, told: str) -> None:
    times_s = np.arange(50) / 100
    sound = np.column_stack([np.sin(times_s), 0 * times_s, 9.81 + 0 * times_s])
    take = Take(
        {
            "left_wrist": SensorRecord(times_s, np.tile(force, (50, 1))),
            "right_wrist": SensorRecord(times_s, sound),
        }
    )
    (line,) = suspicions(take)
    assert line.startswith("left_wrist")
    assert told in line
