# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures of an evaluation, beside NumPy's alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sparse_mocap import Motion, MotionDatabase, read_motion, reconstruct, simulated, to_standard
from sparse_mocap.evaluation import Settings, contenders, evaluate
from sparse_mocap.evaluation.changed_motion import at_tempos, scaled
from sparse_mocap.evaluation.metrics import LIMBS, centred_errors, limb_angles_deg

SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
NAME = "bruno_walk_01.bvh"


def matrices(quaternions: np.ndarray) -> np.ndarray:
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def in_root_frame(motion: Motion) -> np.ndarray:
    """The joints seen from the root, by its rotation alone."""
    world = np.asarray(motion.joint_positions("world"))
    seen = world - np.asarray(motion.pivot_positions())[:, :1]
    return np.einsum("tji,tkj->tki", matrices(np.asarray(motion.rotations)[:, 0]), seen)


def in_heading_frame(motion: Motion) -> np.ndarray:
    """The joints seen from the root, turned so that the hips lie along x."""
    names = list(motion.skeleton.names)
    world = np.asarray(motion.joint_positions("world"))
    seen = world - np.asarray(motion.pivot_positions())[:, :1]
    hips = world[:, names.index("lhipjoint")] - world[:, names.index("rhipjoint")]
    yaw = np.arctan2(-hips[:, 2], hips[:, 0])
    turned = np.copy(seen)
    turned[..., 0] = np.cos(yaw)[:, None] * seen[..., 0] - np.sin(yaw)[:, None] * seen[..., 2]
    turned[..., 2] = np.sin(yaw)[:, None] * seen[..., 0] + np.cos(yaw)[:, None] * seen[..., 2]
    return turned


def at_times(times: np.ndarray, values: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    after = np.clip(np.searchsorted(times, wanted), 1, len(times) - 1)
    share = (wanted - times[after - 1]) / (times[after] - times[after - 1])
    return values[after - 1] + share[:, None, None] * (values[after] - values[after - 1])


def rms_cm(off: np.ndarray) -> np.ndarray:
    return 100 * np.sqrt((off**2).sum(axis=2).mean(axis=1))


def test_all_figures_of_a_clip_are_those_of_numpy(library: Path, database: MotionDatabase) -> None:
    settings = Settings(1, tuple(contenders(("tautges2011",))), tests=NAME)
    found = evaluate(database, library, settings)
    motion, _ = to_standard(read_motion(library / NAME)[0])
    hidden = [i for i, clip in enumerate(database.clips) if clip.source == NAME]
    solved = reconstruct(
        simulated(motion, SITES, 100.0), database, method="tautges2011", excluded_clips=hidden
    )
    truth = to_standard(motion, database.skeleton)[0].resampled(25.0)
    shown, _ = to_standard(solved.motion.without_extremities(), database.skeleton)
    times, true_times = np.asarray(solved.readings.times_s), np.arange(truth.num_frames) / 25.0
    is_known = (true_times > times[0] - 1e-6) & (true_times < times[-1] + 1e-6)
    off = {
        frame: at_times(times, seen(shown), true_times[is_known]) - seen(truth)[is_known]
        for frame, seen in (("heading", in_heading_frame), ("root", in_root_frame))
    }
    told = found.summary("tautges2011")
    assert told["mean_cm"] == pytest.approx(rms_cm(off["heading"]).mean(), abs=1e-3)
    assert told["root_frame"]["mean_cm"] == pytest.approx(rms_cm(off["root"]).mean(), abs=1e-3)
    centred = rms_cm(off["heading"] - off["heading"].mean(axis=0)).mean()
    assert told["centred_cm"] == pytest.approx(centred, abs=1e-3)
    assert sum(told["root_frame"]["histogram"]["frames"]) == is_known.sum()
    assert told["latency_ms"] is not None

    names = list(database.skeleton.names)
    true, estimate = seen_limbs(in_heading_frame(truth)[is_known], names), None
    estimate = seen_limbs(at_times(times, in_heading_frame(shown), true_times[is_known]), names)
    cosine = np.clip((true * estimate).sum(axis=2), -1, 1)
    np.testing.assert_allclose(
        list(told["limb_angles_deg"].values()), np.degrees(np.arccos(cosine)).mean(0), atol=0.01
    )


def seen_limbs(positions: np.ndarray, names: list[str]) -> np.ndarray:
    ends = [
        positions[:, names.index(end)] - positions[:, names.index(begin)]
        for begin, end in LIMBS.values()
    ]
    limbs = np.stack(ends, axis=1)
    return limbs / np.linalg.norm(limbs, axis=2, keepdims=True)


def test_what_is_always_off_alike_is_taken_off() -> None:
    truth = np.zeros((4, 2, 3))
    estimate = np.zeros((4, 2, 3)) + np.array([0.1, 0.0, 0.2])
    np.testing.assert_allclose(centred_errors(truth, estimate), 0.0, atol=1e-12)
    estimate[:2, 0, 1], estimate[2:, 0, 1] = 0.3, -0.3
    np.testing.assert_allclose(centred_errors(truth, estimate), [[0.3, 0.0]] * 4, atol=1e-12)


def test_limbs_are_off_by_the_angle_between_them(database: MotionDatabase) -> None:
    names = list(database.skeleton.names)
    truth = np.asarray(database.array("positions")[:1], float).reshape(1, -1, 3)
    turned = np.copy(truth)
    elbow, wrist = (names.index(name) for name in ("lhumerus", "lradius"))
    forearm = truth[0, wrist] - truth[0, elbow]
    across = np.cross(forearm, [0.3, 0.5, 0.8])
    across *= np.linalg.norm(forearm) / np.linalg.norm(across)
    angle = np.radians(25.0)
    turned[0, wrist] = truth[0, elbow] + np.cos(angle) * forearm + np.sin(angle) * across
    off = dict(zip(LIMBS, limb_angles_deg(truth, turned, names)[0], strict=True))
    assert off.pop("left forearm") == pytest.approx(25.0)
    np.testing.assert_allclose(list(off.values()), 0.0, atol=1e-6)


def test_a_larger_body_moves_its_joints_farther(library: Path) -> None:
    motion, _ = to_standard(read_motion(library / NAME)[0])
    larger = scaled(motion, 1.3)
    np.testing.assert_allclose(
        larger.joint_positions("world"), 1.3 * np.asarray(motion.joint_positions("world")),
        atol=1e-9,
    )  # fmt: skip


def test_a_motion_at_two_tempos_passes_the_same_poses_later(library: Path) -> None:
    motion, _ = to_standard(read_motion(library / NAME)[0])
    rate = 1.0 / motion.frame_time_s
    slower, curve = at_tempos(motion, (0.5,))
    assert slower.num_frames == motion.num_frames
    assert slower.frame_time_s == pytest.approx(2.0 * motion.frame_time_s)
    assert curve[0][-1] == pytest.approx(2.0 * curve[1][-1])

    swaying, (done_s, clip_s) = at_tempos(motion, (0.7, 1.4, 0.7))
    assert swaying.frame_time_s == motion.frame_time_s
    tempo = np.interp(clip_s, [0.0, clip_s[-1] / 2, clip_s[-1]], [0.7, 1.4, 0.7])
    np.testing.assert_allclose(np.gradient(clip_s, done_s)[5:-5], tempo[5:-5], rtol=0.01)
    frames = np.interp(np.arange(swaying.num_frames) / rate, done_s, clip_s) * rate
    nearest = np.asarray(motion.joint_positions("world"))[np.rint(frames).astype(int)]
    step = np.abs(np.diff(motion.joint_positions("world"), axis=0)).max()
    assert np.abs(swaying.joint_positions("world") - nearest).max() < 0.6 * step
    with pytest.raises(ValueError, match="positive"):
        at_tempos(motion, (1.0, 0.0))


def test_a_body_of_another_size_and_tempo_is_compared_in_its_own_poses(
    library: Path, database: MotionDatabase
) -> None:
    """The oracle sees the truth: size does not matter to it, and tempo hardly."""
    usual, larger, faster = (
        evaluate(database, library, Settings(1, tests=NAME, **changed)).clip_means_cm("oracle")[0]
        for changed in ({}, {"body_scale": 1.4}, {"tempos": (0.8, 1.2)})
    )
    assert larger == pytest.approx(usual, abs=0.05)
    assert faster == pytest.approx(usual, abs=1.0)
