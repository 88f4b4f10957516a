# SPDX-License-Identifier: GPL-3.0-or-later
"""Liu et al. 2011 on simulated trackers of position and orientation."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from sparse_mocap import (
    ConfigError,
    MotionDatabase,
    Reconstruction,
    SensorRecord,
    Take,
    reconstruct,
)
from sparse_mocap.evaluation import Performance, excluded_clips, performed
from sparse_mocap.rotations import product, rotated

SITES = ("left_hand", "right_hand", "left_ankle", "right_ankle", "head", "torso")
BOTH = ("position", "orientation")
CLIP = "ada_walk_01"

Floats = NDArray[np.float64]


@pytest.fixture(scope="module")
def ideal(library: Path) -> Performance:
    return performed(library / f"{CLIP}.bvh", sites=SITES)


def solved(
    database: MotionDatabase,
    performance: Performance,
    take: Take,
    options: dict[str, object] | None = None,
    *,
    tracker_yaw_rad: float = 0.0,
    best_quality: bool = False,
    method: str = "liu2011",
) -> Reconstruction:
    """Returns the reconstruction without the clip itself, on the performer's body."""
    names = [clip.name for clip in database.clips]
    return reconstruct(
        take,
        database,
        best_quality=best_quality,
        method=method,
        options=options or {},
        body=performance.motion.skeleton,
        tracker_yaw_rad=tracker_yaw_rad,
        excluded_clips=excluded_clips(database.clips, names.index(CLIP), 1),
    )


def errors_cm(found: Reconstruction, performance: Performance) -> Floats:
    """Returns the mean distance of the joints in the world, frame by frame."""
    return _errors_cm(found, performance, "world")


def heading_errors_cm(found: Reconstruction, performance: Performance) -> Floats:
    """Returns the same in the heading frame."""
    return _errors_cm(found, performance, "heading")


def _errors_cm(found: Reconstruction, performance: Performance, frame: str) -> Floats:
    truth = np.asarray(performance.motion.resampled(found.rate_hz).joint_positions(frame))
    ours = np.asarray(found.motion.without_extremities().joint_positions(frame))
    count = min(len(truth), len(ours))
    return 100 * np.linalg.norm(ours[:count] - truth[:count], axis=-1).mean(axis=1)


def all_give(channels: tuple[str, ...]) -> dict[str, tuple[str, ...]]:
    return dict.fromkeys(SITES, channels)


@pytest.mark.parametrize(("channels", "limit_cm"), [(BOTH, 0.7), (("position",), 1.2)])
def test_six_trackers_tell_a_movement_in_the_world(
    database: MotionDatabase, ideal: Performance, channels: tuple[str, ...], limit_cm: float
) -> None:
    found = solved(database, ideal, ideal.seen(all_give(channels)))
    assert found.latency_s == 0.0
    assert errors_cm(found, ideal).mean() < limit_cm


def test_it_begins_where_and_as_the_sensors_say(
    database: MotionDatabase, ideal: Performance
) -> None:
    take = ideal.seen(all_give(("position",)))
    assert errors_cm(solved(database, ideal, take), ideal)[0] < 0.6
    turned = solved(database, ideal, take, tracker_yaw_rad=2.8)  # faces the other way
    np.testing.assert_allclose(
        heading_errors_cm(turned, ideal), heading_errors_cm(solved(database, ideal, take), ideal),
        atol=1.0,
    )  # fmt: skip


def test_orientations_alone_tell_the_pose(database: MotionDatabase, ideal: Performance) -> None:
    found = solved(database, ideal, ideal.seen(all_give(("orientation",))))
    assert heading_errors_cm(found, ideal).mean() < 2.5


def test_wrong_positions_are_held_off(
    database: MotionDatabase, library: Path, ideal: Performance
) -> None:
    noisy = performed(library / f"{CLIP}.bvh", sites=SITES, noise="ultrasonic", seed=1)
    found = solved(database, ideal, noisy.seen(all_give(("position",))))
    errors = errors_cm(found, ideal)
    assert errors.mean() < 2.0
    assert errors.max() < 8.0


def test_a_silent_tracker_is_bridged(database: MotionDatabase, ideal: Performance) -> None:
    take = ideal.seen(all_give(BOTH))
    record = take.sensors["left_ankle"]
    assert record.position is not None
    assert record.orientation is not None
    kept = (record.times_s < 1.0) | (record.times_s > 2.0)
    short = SensorRecord(
        record.times_s[kept],
        record.specific_force[kept],
        None,
        record.orientation[kept],
        record.position[kept],
    )
    found = solved(database, ideal, Take(take.sensors | {"left_ankle": short}))
    assert errors_cm(found, ideal).mean() < 2.0


def test_accelerations_alone_are_refused(database: MotionDatabase, ideal: Performance) -> None:
    with pytest.raises(ConfigError, match="needs orientation or position of every sensor"):
        solved(database, ideal, ideal.seen(all_give(("specific_force",))))


def test_fewer_than_six_trackers_are_enough(database: MotionDatabase, ideal: Performance) -> None:
    take = ideal.seen(dict.fromkeys(("left_hand", "right_ankle", "torso"), BOTH))
    assert heading_errors_cm(solved(database, ideal, take), ideal).mean() < 4.0


def test_best_quality_is_evener_and_no_farther(
    database: MotionDatabase, library: Path, ideal: Performance
) -> None:
    noisy = performed(library / f"{CLIP}.bvh", sites=SITES, noise="ultrasonic", seed=1)
    take = noisy.seen(all_give(BOTH))
    live, best = (
        solved(database, ideal, take, best_quality=best_quality) for best_quality in (False, True)
    )
    assert best.latency_s is None
    assert heading_errors_cm(best, ideal).mean() < 1.1 * heading_errors_cm(live, ideal).mean()

    def jerk(found: Reconstruction) -> float:
        positions = np.asarray(found.motion.without_extremities().joint_positions("heading"))
        return float(np.linalg.norm(np.diff(positions, 3, axis=0), axis=-1).mean())

    assert jerk(best) < 0.6 * jerk(live)


def test_lost_track_is_found_again(database: MotionDatabase, ideal: Performance) -> None:
    """The trackers' world turns and moves while they are not looked at."""
    here = ideal.seen(all_give(BOTH))
    half_turn = np.array([np.cos(1.25), 0.0, np.sin(1.25), 0.0])
    sensors = {}
    for site, record in here.sensors.items():
        is_late = record.times_s > 1.5
        position, orientation = record.position, record.orientation
        assert position is not None
        assert orientation is not None
        turned = rotated(np.repeat(half_turn[None], len(position), axis=0), position)
        sensors[site] = SensorRecord(
            record.times_s,
            record.specific_force,
            None,
            np.where(is_late[:, None], product(half_turn, orientation), orientation),
            np.where(is_late[:, None], turned + np.array([2.0, 0.0, 1.0]), position),
        )
    found = solved(database, ideal, Take(sensors))
    lost = solved(database, ideal, Take(sensors), {"restart_after_s": 0})
    late = slice(int(2.5 * found.rate_hz), None)
    assert heading_errors_cm(found, ideal)[late].mean() < 2.0
    assert heading_errors_cm(lost, ideal)[late].mean() > 4.0


def test_drifting_headings_are_set_right(database: MotionDatabase, ideal: Performance) -> None:
    """One forearm's heading drifts by 30 degrees while nothing says where the hands are."""
    take = ideal.seen(all_give(("orientation",)))
    record = take.sensors["left_hand"]
    half = 0.5 * np.radians(12.0) * record.times_s
    zero = np.zeros_like(half)
    drift = np.stack([np.cos(half), zero, np.sin(half), zero], axis=1)
    assert record.orientation is not None
    off = SensorRecord(
        record.times_s, record.specific_force, None, product(drift, record.orientation)
    )
    drifting = Take(take.sensors | {"left_hand": off})
    trusted = heading_errors_cm(solved(database, ideal, drifting), ideal)
    followed = heading_errors_cm(
        solved(database, ideal, drifting, {"heading_drift_deg": 12}), ideal
    )
    assert followed[-30:].mean() < 0.8 * trusted[-30:].mean()


@pytest.mark.parametrize("best_quality", [False, True])
def test_the_default_method_places_limbs_as_orientations_say(
    database: MotionDatabase, ideal: Performance, best_quality: bool
) -> None:
    def errors(channels: tuple[str, ...], yaw_rad: float = 0.0) -> float:
        take = ideal.seen(all_give(channels))
        found = solved(
            database, ideal, take, method="path_regression",
            best_quality=best_quality, tracker_yaw_rad=yaw_rad,
        )  # fmt: skip
        return float(heading_errors_cm(found, ideal).mean())

    alone = errors(("specific_force",))
    together = errors(("specific_force", "orientation"))
    assert together < 0.95 * alone
    assert errors(("specific_force", "orientation"), 2.5) == pytest.approx(together, abs=0.15)


@pytest.mark.parametrize("best_quality", [False, True])
def test_the_default_method_turns_limbs_that_no_motion_tells(
    database: MotionDatabase, library: Path, best_quality: bool
) -> None:
    """A kick among walks and squats: shanks and forearm are where their trackers say."""
    kick = performed(library / "ada_kickleft_01.bvh", sites=SITES)
    found = reconstruct(
        kick.seen(all_give(("specific_force", "orientation"))),
        database,
        best_quality=best_quality,
        excluded_clips=[i for i, clip in enumerate(database.clips) if "kick" in clip.name],
    )
    limbs = (("lfemur", "ltibia"), ("rfemur", "rtibia"), ("lhumerus", "lradius"))
    assert np.mean([_limb_angle_deg(found, kick, *limb) for limb in limbs]) < 11.0


def _limb_angle_deg(found: Reconstruction, performance: Performance, near: str, far: str) -> float:
    """Returns the mean angle between a limb, from joint end to joint end, and the true one."""
    motion = found.motion.without_extremities()
    ends = [list(motion.skeleton.names).index(name) for name in (near, far)]
    truth = np.asarray(performance.motion.resampled(found.rate_hz).joint_positions("heading"))
    ours = np.asarray(motion.joint_positions("heading"))
    count = min(len(truth), len(ours))
    limbs = [joints[:count, ends[1]] - joints[:count, ends[0]] for joints in (truth, ours)]
    limbs = [limb / np.linalg.norm(limb, axis=1, keepdims=True) for limb in limbs]
    cosines = (limbs[0] * limbs[1]).sum(axis=1)
    return float(np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))).mean())
