# SPDX-License-Identifier: GPL-3.0-or-later
"""A recorded performance by the orientations and accelerations of six of its sixteen sensors.

Upper arms and thighs have no sensor that is used; the others say how they were.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recorded_body import (
    LIMBS,
    SCORED,
    angles_deg,
    directions,
    exceeds_human_limits,
    recorded_sensors,
    reference,
    turns,
)
from scipy.spatial.transform import Rotation
from sparse_mocap import MotionDatabase, SensorRecord, Take, build_database, reconstruct

LIMB_ALONG_Y = {
    "arm": [[0, -1, 0], [0, 0, 1], [-1, 0, 0]],
    "leg": [[0, -1, 0], [0, 0, -1], [1, 0, 0]],
}
UPRIGHT = [[0, 1, 0], [0, 0, 1], [1, 0, 0]]
WORN = {
    "left_wrist": ("forearm_left", LIMB_ALONG_Y["arm"]),
    "right_wrist": ("forearm_right", LIMB_ALONG_Y["arm"]),
    "left_ankle": ("lower_leg_left", LIMB_ALONG_Y["leg"]),
    "right_ankle": ("lower_leg_right", LIMB_ALONG_Y["leg"]),
    "head": ("head", UPRIGHT),
    "pelvis": ("hip", UPRIGHT),
}
"""Segments, and R_site_segment: they have y up the limb, and x forward at legs, head and hip;
elbows bend about the forearms' x.
"""
HAS_SENSOR = np.array(["lower_leg" in name or "forearm" in name for name in LIMBS])
Y_UP = Rotation.from_matrix([[1, 0, 0], [0, 0, 1], [0, -1, 0]])  # the recording's z is up
BEGIN_S, END_S = SCORED[0] - 2.0, SCORED[0] + 15.0


@pytest.fixture(scope="module")
def recorded(real_data: Path) -> Any:
    return recorded_sensors(real_data)


@pytest.fixture(scope="module")
def take(recorded: Any) -> Take:
    times = recorded["t"] - recorded["t"][0]
    is_used = (times >= BEGIN_S) & (times <= END_S)
    sensors = {}
    for site, (name, R) in WORN.items():
        segment, R_site_segment = turns(recorded, name), Rotation.from_matrix(R)
        rate = (segment[:-1].inv() * segment[1:]).as_rotvec()
        gyroscope = recorded[name].gyr
        R_segment_box, _ = Rotation.align_vectors(rate, (gyroscope[1:] + gyroscope[:-1]) / 200)
        force = (R_site_segment * R_segment_box).apply(recorded[name].acc)
        turned = (Y_UP * segment * R_site_segment.inv()).as_quat()[:, [3, 0, 1, 2]]
        sensors[site] = SensorRecord(times[is_used], force[is_used], None, turned[is_used])
    return Take(sensors)


@pytest.fixture(scope="module")
def walks(real_data: Path, tmp_path_factory: pytest.TempPathFactory) -> MotionDatabase:
    path = tmp_path_factory.mktemp("trackers") / "walks.smdb"
    build_database([real_data / "cmu" / "bvh"], path)
    return MotionDatabase(path)


@pytest.mark.parametrize(
    ("method", "best_quality", "with_sensor_deg", "without_deg"),
    [
        ("path_regression", False, 6.0, 15.0),
        ("path_regression", True, 6.0, 12.0),
        ("liu2011", False, 6.5, 19.0),
    ],
)
def test_limbs_point_as_they_did(
    recorded: Any,
    take: Take,
    walks: MotionDatabase,
    method: str,
    best_quality: bool,
    with_sensor_deg: float,
    without_deg: float,
) -> None:
    solved = reconstruct(take, walks, method=method, best_quality=best_quality)
    assert exceeds_human_limits(solved.motion) == []
    times = np.asarray(solved.readings.times_s)
    is_scored = times >= SCORED[0]
    truth = reference(recorded)[np.round(times[is_scored] * 100).astype(int)]
    found = directions(solved.motion)[is_scored]
    errors = angles_deg(found, truth).mean(axis=0)[: len(LIMBS)]
    assert errors[HAS_SENSOR].mean() < with_sensor_deg
    assert errors[~HAS_SENSOR].mean() < without_deg
