# SPDX-License-Identifier: GPL-3.0-or-later
"""Reconstruction through Python: one facade for every method, and what it promises."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sparse_mocap import (
    Cancelled,
    Clip,
    ConfigError,
    LiveReconstructor,
    MotionDatabase,
    Readings,
    SensorRecord,
    Take,
    nearest_poses,
    nearest_windows,
    playback_best_path,
    read_take,
    reconstruct,
    with_extremities,
)
from sparse_mocap.capture.sample_log import SAMPLE
from sparse_mocap.methods import method_info, methods, option_values, renamed_preset
from sparse_mocap.quality import quality_of
from sparse_mocap.readings import SensorInput, all_readings
from sparse_mocap.report import LiveMatch, match, match_of, unit_warnings

WAYS = [
    (method.name, best)
    for method in methods()
    for best in (False, True)
    if method.needs == ("database",)
    and method.can_use(["specific_force"])
    and (method.works_on_whole_takes if best else method.works_live)
]


@pytest.fixture(scope="module")
def take(take_path: Path) -> Take:
    return read_take(take_path)


@pytest.fixture(scope="module")
def short(take: Take) -> Take:
    return shortened(take, 2.5)


@pytest.fixture(scope="module")
def readings(take: Take, database: MotionDatabase) -> Readings:
    return all_readings(take, [SensorInput(site) for site in take.sites], database.rate_hz)


def shortened(take: Take, seconds: float, sites: Sequence[str] = ()) -> Take:
    sensors = {}
    for site in sites or take.sites:
        record = take.sensors[site]
        kept = record.times_s <= take.begin_s + seconds
        sensors[site] = SensorRecord(record.times_s[kept], record.specific_force[kept])
    return Take(sensors)


def test_methods_say_what_they_are() -> None:
    assert methods()[0].name == "path_regression"
    assert method_info("tautges2011").paper
    assert not method_info("tautges2011").works_on_whole_takes
    for method in methods():
        assert method.options
        assert all(option.help and option.default for option in method.options)
    known = ", ".join(method.name for method in methods())
    with pytest.raises(ConfigError, match=f"known are {known}"):
        method_info("magic")


@pytest.mark.parametrize(
    ("method", "preset", "expected", "told"),
    [
        (None, "paper", ("tautges2011", None), "--method tautges2011"),
        ("tautges2011", "default", ("path_regression", None), "--method path_regression"),
        ("tautges2011", "paper", ("tautges2011", "paper"), ""),
        (None, "default", (None, "default"), ""),
        (None, None, (None, None), ""),
    ],
)
def test_presets_of_old_scripts_still_work(
    method: str | None, preset: str | None, expected: tuple[Any, ...], told: str
) -> None:
    *found, message = renamed_preset(method, preset)
    assert tuple(found) == expected
    assert told in message


@pytest.mark.parametrize(("method", "best_quality"), WAYS)
def test_a_take_is_solved_frame_by_frame(
    database: MotionDatabase, take: Take, readings: Readings, method: str, best_quality: bool
) -> None:
    solved = reconstruct(take, database, method=method, best_quality=best_quality)
    frames = len(readings)
    assert solved.motion.num_frames == frames
    assert solved.motion.frame_time_s == pytest.approx(1 / database.rate_hz)
    assert solved.motion.skeleton.names == with_extremities(database.skeleton).names
    assert (solved.latency_s is None) == best_quality
    shapes = {"spread_m": 21, "sensor_misfit_mps2": 4, "clip": 1, "database_frame": 1}
    for name, width in shapes.items():
        values = solved.diagnostics[name]
        assert values.shape == (frames, width), name
        assert np.isfinite(values).all(), name
    assert ((solved.contacts >= 0) & (solved.contacts <= 1)).all()
    clips: list[Clip] = database.clips
    used = zip(solved.diagnostics["clip"], solved.diagnostics["database_frame"], strict=True)
    for clip, frame in used:
        assert clips[int(clip[0])].begin <= frame[0] < clips[int(clip[0])].end
    np.testing.assert_array_equal(solved.readings.times_s, readings.times_s)
    np.testing.assert_array_equal(solved.readings.specific_force, readings.specific_force)


def samples_of(take: Take) -> np.ndarray:
    """The take as a capture would log it, in the order of time."""
    parts = []
    for number, record in enumerate(take.sensors.values()):
        part = np.zeros(len(record.times_s), SAMPLE)
        part["sensor"], part["arrival_ns"] = number, record.times_s * 1e9
        part["device_time_s"] = record.times_s
        part["specific_force"] = record.specific_force
        part["angular_velocity"] = part["orientation"] = np.nan
        parts.append(part)
    samples = np.concatenate(parts)
    return samples[np.argsort(samples["arrival_ns"], kind="stable")]


def test_live_poses_are_those_of_the_whole_take(database: MotionDatabase, short: Take) -> None:
    solved = reconstruct(short, database)
    live = LiveReconstructor(
        dict(enumerate(short.sites)), [["specific_force"]] * len(short.sites), database
    )
    samples = samples_of(short)
    estimates = []
    for chunk in np.array_split(samples, 37):
        live.push(chunk)
        estimates += live.advance(float(chunk["arrival_ns"][-1]) * 1e-9)
    estimates += live.flush()
    assert len(estimates) == len(solved.readings)
    assert live.num_skipped == 0
    np.testing.assert_allclose(
        [one.time_s for one in estimates], solved.readings.times_s, atol=1e-3
    )
    difference = np.array([one.positions for one in estimates]) - np.asarray(
        solved.motion.joint_positions("heading")
    )
    assert np.linalg.norm(difference, axis=2).mean() < 2e-3  # samples are logged as floats
    np.testing.assert_allclose(
        np.linalg.norm([one.rotations for one in estimates], axis=2), 1, atol=1e-9
    )
    told = LiveMatch(len(estimates), database)
    assert told.match == ""
    for estimate in estimates:
        told.add(estimate)
    as_a_take = quality_of(solved, database)
    assert told.quality is not None
    assert as_a_take is not None
    assert told.quality.share == pytest.approx(as_a_take.share, rel=1e-3)
    assert (told.match, told.advice) == (match(solved, database), as_a_take.advice)


def test_a_live_preview_that_falls_behind_uses_the_newest_reading(
    database: MotionDatabase, short: Take
) -> None:
    live = LiveReconstructor(
        dict(enumerate(short.sites)),
        [["specific_force"]] * len(short.sites),
        database,
        largest_backlog=5,
    )
    live.push(samples_of(short))
    assert len(live.advance(short.end_s)) <= 1
    assert live.num_skipped > 40


def test_the_same_take_gives_the_same_bits(database: MotionDatabase, short: Take) -> None:
    one, two = (reconstruct(short, database).motion.rotations for _ in range(2))
    np.testing.assert_array_equal(one, two)


def test_silent_sensors_are_done_without(database: MotionDatabase, take: Take) -> None:
    cut = {}
    for index, (site, record) in enumerate(take.sensors.items()):
        since = record.times_s - take.begin_s
        is_silent = (since > 0.8) & (since < 1.8) & (index == 1) | (since > 2.0) & (since < 2.3)
        kept = ~is_silent & (since < 3.2)
        cut[site] = replace(
            record,
            times_s=record.times_s[kept],
            specific_force=record.specific_force[kept],
            angular_velocity=None,
            orientation=None,
        )
    solved = reconstruct(Take(cut), database)
    assert np.isnan(solved.readings.specific_force).any()
    assert np.isfinite(solved.motion.rotations).all()


@pytest.mark.parametrize("sites", [["left_wrist"], ["right_ankle", "left_wrist", "left_ankle"]])
def test_other_sets_of_sensors_work(database: MotionDatabase, take: Take, sites: list[str]) -> None:
    solved = reconstruct(shortened(take, 1.5, sites), database)
    assert solved.readings.sites == sites
    assert np.isfinite(solved.motion.rotations).all()


def test_options_reach_the_method(database: MotionDatabase, short: Take) -> None:
    plain = reconstruct(short, database)
    few = reconstruct(short, database, options={"num_paths": 1, "use_tempo_copies": False})
    assert few.diagnostics["spread_m"].max() < 1e-6 < plain.diagnostics["spread_m"].max()
    assert option_values({"a": True, "b": 0.5, "c": "x"}) == {"a": "true", "b": "0.5", "c": "x"}


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ({"method": "magic"}, "unknown method 'magic'"),
        ({"preset": "magic"}, "unknown preset 'magic'"),
        ({"options": {"num_pathes": 3}}, "did you mean 'num_paths'"),
        ({"options": {"num_paths": 0}}, "num_paths must be a whole number from 1"),
        ({"method": "tautges2011", "best_quality": True}, "has no best quality"),
        ({"excluded_clips": range(100_000)}, "is not in the database"),
    ],
)
def test_wrong_arguments_are_refused(
    database: MotionDatabase, short: Take, arguments: dict[str, Any], told: str
) -> None:
    with pytest.raises(ConfigError, match=told):
        reconstruct(short, database, **arguments)


def test_what_a_method_lacks_is_said(database: MotionDatabase, short: Take) -> None:
    with pytest.raises(ConfigError, match="needs a motion database"):
        reconstruct(short)
    with pytest.raises(ConfigError, match="unknown sensor 'nose'"):
        reconstruct(Take({"nose": short.sensors[short.sites[0]]}), database)
    with pytest.raises(ConfigError, match="every clip of the database is excluded"):
        reconstruct(short, database, excluded_clips=range(len(database.clips)))


def test_excluded_clips_are_never_used(database: MotionDatabase, short: Take) -> None:
    excluded = [i for i, clip in enumerate(database.clips) if clip.motion_class == "walk"]
    solved = reconstruct(short, database, excluded_clips=excluded)
    assert not set(solved.diagnostics["clip"][:, 0].astype(int).tolist()) & set(excluded)


def test_a_solution_can_be_stopped(database: MotionDatabase, short: Take) -> None:
    with pytest.raises(Cancelled):
        reconstruct(short, database, progress=lambda *_: False)


def test_best_quality_says_how_far_it_is_to_the_end_and_can_be_stopped_there(
    database: MotionDatabase, short: Take
) -> None:
    fractions: list[float] = []

    def follow(done: int, total: int, _: str) -> bool:
        fractions.append(done / total)
        return True

    reconstruct(short, database, best_quality=True, progress=follow)
    assert fractions == sorted(fractions)
    assert fractions[-1] > 2 / 3  # while the take is fitted as a whole, too
    with pytest.raises(Cancelled):
        reconstruct(short, database, best_quality=True, progress=lambda *now: now[2] != "fitting")


def test_other_threads_run_during_a_solution(database: MotionDatabase, take: Take) -> None:
    ticks: list[float] = []
    done = threading.Event()

    def tick() -> None:
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.perf_counter()
    reconstruct(take, database)
    end = time.perf_counter()
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


def test_the_nearest_window_is_the_nearest(database: MotionDatabase, readings: Readings) -> None:
    force = database.array("specific_force_end")[:, :12].astype(float)
    query = readings[:50].specific_force.reshape(50, 12)
    hidden, window = [0, 5], 4

    def windows(rows: np.ndarray) -> np.ndarray:
        before = np.maximum(np.arange(len(rows))[:, None] - np.arange(window), 0)
        return rows[before].reshape(len(rows), -1)

    clips = shown_clips(database, hidden)
    frames = np.concatenate([np.arange(c.begin, c.end) for c in clips])
    features = np.concatenate([windows(force[c.begin : c.end]) for c in clips])
    distances = np.linalg.norm(windows(query)[:, None] - features[None], axis=2)
    found = nearest_windows(database, readings[:50], window, hidden)
    place = {int(frame): index for index, frame in enumerate(frames)}
    got = distances[np.arange(50), [place[frame] for frame in found.tolist()]]
    np.testing.assert_allclose(got, distances.min(axis=1), atol=1e-4)


def test_played_back_frames_are_the_databases(database: MotionDatabase, readings: Readings) -> None:
    found = playback_best_path(database, readings, [0, 1, 2])
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
    (line,) = unit_warnings(take)
    assert line.startswith("left_wrist")
    assert told in line


def test_the_larger_the_misfit_the_worse_the_match() -> None:
    assert [match_of(misfit) for misfit in (0.0, 2.4, 2.5, 4.4, 4.5, 9.0)] == [
        "good", "good", "fair", "fair", "poor", "poor",
    ]  # fmt: skip
