# SPDX-License-Identifier: GPL-3.0-or-later
"""A recorded performance of sixteen sensors, four of which are used: forearms and shanks.

Their orientations, which no method here sees, are the reference for the directions of the limbs.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import loadmat
from scipy.spatial.transform import Rotation
from sparse_mocap import (
    Motion,
    MotionDatabase,
    Reconstructor,
    SensorRecord,
    Take,
    build_database,
    resampled,
)
from sparse_mocap.calibration import Calibration, Steps, apply, calibrate, places_of

WORN = {
    "left_wrist": "forearm_left",
    "right_wrist": "forearm_right",
    "left_ankle": "lower_leg_left",
    "right_ankle": "lower_leg_right",
}
LIMBS = {
    "upper_arm_left": ("lclavicle", "lhumerus"),
    "forearm_left": ("lhumerus", "lradius"),
    "upper_arm_right": ("rclavicle", "rhumerus"),
    "forearm_right": ("rhumerus", "rradius"),
    "upper_leg_left": ("lhipjoint", "lfemur"),
    "lower_leg_left": ("lfemur", "ltibia"),
    "upper_leg_right": ("rhipjoint", "rfemur"),
    "lower_leg_right": ("rfemur", "rtibia"),
}
# The wearer stands for 4 s, then lifts both forearms; from 55 s on there is steady locomotion.
STEPS = Steps((0.0, 4.0), (("bend_elbows", (4.5, 6.0)), ("walk", (55.0, 75.0))))
SCORED = (55.0, 100.0)


@pytest.fixture(scope="module")
def recorded(real_data: Path) -> Any:
    path = real_data / "imu" / "qmt_full_body" / "full_body_example_data.mat"
    return loadmat(path, squeeze_me=True, struct_as_record=False)


@pytest.fixture(scope="module")
def take(recorded: Any) -> Take:
    times = recorded["t"] - recorded["t"][0]
    return Take(
        {site: SensorRecord(times, recorded[n].acc, recorded[n].gyr) for site, n in WORN.items()}
    )


@pytest.fixture(scope="module")
def calibration(take: Take) -> Calibration:
    return calibrate(take, STEPS)


def turns(recorded: Any, name: str) -> Rotation:
    return Rotation.from_quat(recorded[name].quat[:, [1, 2, 3, 0]])


def reference(recorded: Any) -> np.ndarray:
    """(T, 8, 3) limb directions in the heading frame; segments have y upwards along the limb."""
    right = turns(recorded, "hip").apply([0, 0, 1]) * [1, 1, 0]
    left = -right / np.linalg.norm(right, axis=1, keepdims=True)
    axes = np.stack([left, np.tile([0, 0, 1.0], (len(left), 1)), np.cross(left, [0, 0, 1])], 1)
    limbs = [turns(recorded, name).apply([0, -1, 0]) for name in LIMBS]
    return np.einsum("tij,ltj->tli", axes, np.array(limbs))


def directions(motion: Motion) -> np.ndarray:
    positions, names = motion.joint_positions("heading"), motion.skeleton.names
    limbs = [positions[:, names.index(b)] - positions[:, names.index(a)] for a, b in LIMBS.values()]
    return np.stack([v / np.linalg.norm(v, axis=1, keepdims=True) for v in limbs], 1)


def mean_angle_deg(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.degrees(np.arccos(np.clip((a * b).sum(axis=-1), -1, 1))).mean())


def test_boxes_turned_by_half_a_right_angle_are_found(
    recorded: Any, calibration: Calibration
) -> None:
    """The shanks' boxes sit on the inner side of the shin: 45 degrees about the limb."""
    for site in ("left_ankle", "right_ankle"):
        segment = turns(recorded, WORN[site])
        rate = (segment[:-1].inv() * segment[1:]).as_rotvec()
        gyroscope = recorded[WORN[site]].gyr
        R_segment_box, _ = Rotation.align_vectors(rate, (gyroscope[1:] + gyroscope[:-1]) / 200)
        # The site: x down the limb, z forward; the segment: y up the limb, x forward.
        R_site_segment = Rotation.from_matrix([[0, -1, 0], [0, 0, -1], [1, 0, 0]])
        found = calibration.sensors[site]
        off = (R_site_segment * R_segment_box).inv() * Rotation.from_matrix(found.R_site_sensor)
        assert np.degrees(off.magnitude()) < 15.0
        assert found.is_mounting_determined
        assert not found.is_place_determined  # nothing stays still while running


def test_limbs_point_where_the_reference_says(
    recorded: Any,
    real_data: Path,
    take: Take,
    calibration: Calibration,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = tmp_path / "db.smdb"
    build_database([real_data / "hdm05", real_data / "cmu" / "bvh"], path)
    database = MotionDatabase(path)
    worn = apply(calibration, take)
    times, readings = resampled(worn, database.rate_hz)
    part = times >= SCORED[0] - 5
    scored = times[part] >= SCORED[0]
    limbs = reference(recorded)
    truth = limbs[np.round(times[part][scored] * 100).astype(int)]
    mean = truth.mean(axis=0) / np.linalg.norm(truth.mean(axis=0), axis=1, keepdims=True)
    held_still = mean_angle_deg(np.broadcast_to(mean, truth.shape), truth)
    errors = {}
    for offline in (False, True):
        method = Reconstructor(database, worn.sites, places=places_of(calibration, take))
        solved = method.solve(readings[part], offline=offline)
        errors[offline] = mean_angle_deg(directions(solved.motion)[scored], truth)
    with capsys.disabled():
        print(
            f"\nlimb directions: online {errors[False]:.1f}, offline {errors[True]:.1f}, "
            f"the mean pose held still {held_still:.1f} degrees"
        )
    assert errors[True] < 0.9 * held_still
    assert errors[False] < held_still
