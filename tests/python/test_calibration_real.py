# SPDX-License-Identifier: GPL-3.0-or-later
"""A recorded performance of sixteen sensors, four of which are used: forearms and shanks.

Their orientations, which no method here sees, are the reference for the directions of the limbs.
"""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recorded_body import (
    LIMBS,
    SCORED,
    TRUNK,
    angles_deg,
    directions,
    exceeds_human_limits,
    recorded_sensors,
    reference,
    turns,
)
from scipy.spatial.transform import Rotation
from sparse_mocap import (
    MotionDatabase,
    SensorRecord,
    Take,
    build_database,
    reconstruct,
)
from sparse_mocap.calibration import Calibration, Steps, calibrate

WORN = {
    "left_wrist": "forearm_left",
    "right_wrist": "forearm_right",
    "left_ankle": "lower_leg_left",
    "right_ankle": "lower_leg_right",
}
# The wearer stands for 4 s, then lifts both forearms; from 55 s on there is steady locomotion.
STEPS = Steps((0.0, 4.0), (("bend_elbows", (4.5, 6.0)), ("walk", (55.0, 75.0))))


@pytest.fixture(scope="module")
def recorded(real_data: Path) -> Any:
    return recorded_sensors(real_data)


@pytest.fixture(scope="module")
def take(recorded: Any) -> Take:
    times = recorded["t"] - recorded["t"][0]
    return Take(
        {site: SensorRecord(times, recorded[n].acc, recorded[n].gyr) for site, n in WORN.items()}
    )


@pytest.fixture(scope="module")
def calibration(take: Take) -> Calibration:
    return calibrate(take, STEPS)


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
        assert not found.is_position_determined  # nothing stays still while running


def since(take: Take, begin_s: float) -> Take:
    """The take from a time on."""
    sensors = {}
    for name, record in take.sensors.items():
        kept = record.times_s >= begin_s
        assert record.angular_velocity is not None
        sensors[name] = SensorRecord(
            record.times_s[kept], record.specific_force[kept], record.angular_velocity[kept]
        )
    return Take(sensors)


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
    part = since(take, SCORED[0] - 5)
    limbs = reference(recorded)
    errors, held_still = {}, 0.0
    for uses_gyroscopes, offline in itertools.product((False, True), repeat=2):
        solved = reconstruct(
            part,
            database,
            best_quality=offline,
            calibration=calibration,
            use_gyroscopes=uses_gyroscopes,
        )
        assert exceeds_human_limits(solved.motion) == []
        times = np.asarray(solved.readings.times_s)
        scored = times >= SCORED[0]
        truth = limbs[np.round(times[scored] * 100).astype(int)]
        found = directions(solved.motion)[scored]
        errors[uses_gyroscopes, offline] = angles_deg(found, truth).mean(axis=0)
        mean = truth.mean(axis=0) / np.linalg.norm(truth.mean(axis=0), axis=1, keepdims=True)
        held_still = angles_deg(mean, truth).mean(axis=0)
    with capsys.disabled():
        for told, of in (("limbs", LIMBS), ("limbs and trunk", [*LIMBS, TRUNK])):
            means = [error[: len(of)].mean() for error in (*errors.values(), held_still)]
            print("\n{}: online {:.1f}, offline {:.1f}; with gyroscopes {:.1f}, {:.1f}; the mean "
                  "pose held still {:.1f} degrees".format(told, *means))  # fmt: skip
    limbs_alone = slice(0, len(LIMBS))
    means = {how: error[limbs_alone].mean() for how, error in errors.items()}
    assert means[False, True] < 0.9 * held_still[limbs_alone].mean()
    assert means[False, False] < held_still[limbs_alone].mean()
    for offline in (False, True):
        assert means[True, offline] < means[False, offline] - 0.5
