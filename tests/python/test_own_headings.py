# SPDX-License-Identifier: GPL-3.0-or-later
"""Sensors with a gyroscope, or with an orientation, tell where limbs point about the vertical.

An arm that is held out and swings a little reads the same to the front and to the side: neither
accelerations nor inclination nor turn rates differ, only where its sensor points against others.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from sparse_mocap import (
    Motion,
    MotionDatabase,
    SensorRecord,
    Skeleton,
    Take,
    build_database,
    reconstruct,
    simulated,
    write_bvh,
)
from sparse_mocap.rotations import about_axis, product

Floats = NDArray[np.float64]

RATE_HZ = 50.0
SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
UP = (0.0, 1.0, 0.0)
HANGING, SIDE, FRONT = (-80.0, 0.0), (0.0, 0.0), (0.0, -90.0)
"""Elevation of the left arm, and its turn about the vertical from the left side, degrees."""


def smooth(begin: float, end: float, duration_s: float) -> Floats:
    part = np.linspace(0.0, 1.0, round(duration_s * RATE_HZ), endpoint=False)
    return begin + (end - begin) * (0.5 - 0.5 * np.cos(np.pi * part))


def held(place: tuple[float, float], duration_s: float) -> Floats:
    return np.tile(place, (round(duration_s * RATE_HZ), 1))


def moved(begin: tuple[float, float], end: tuple[float, float]) -> Floats:
    return np.stack([smooth(b, e, 1.0) for b, e in zip(begin, end, strict=True)], axis=1)


def motion(
    skeleton: Skeleton, path_deg: Floats, phase: float, turning_degps: float = 0.0
) -> Motion:
    """The left arm goes along a path, and all limbs swing a little meanwhile."""
    names, count = list(skeleton.names), len(path_deg)
    times_s = np.arange(count) / RATE_HZ
    swing_deg = 8.0 * np.sin(2.0 * np.pi * 0.9 * times_s + phase)
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (count, len(names), 1))
    rest = np.asarray(skeleton.bones)[names.index("lhumerus")]
    rest_deg = np.degrees(np.arcsin(rest[1] / np.linalg.norm(rest)))
    for t in range(count):
        elevation_deg, turn_deg = path_deg[t]
        rise = Rotation.from_euler("z", elevation_deg - rest_deg, degrees=True)
        turn = Rotation.from_euler("y", turn_deg + swing_deg[t], degrees=True)
        rotations[t, names.index("lhumerus")] = (turn * rise).as_quat()[[3, 0, 1, 2]]
    for name in ("rhumerus", "lfemur", "rfemur"):
        rotations[:, names.index(name)] = [
            about_axis((1.0, 0.0, 0.0), float(np.radians(angle))) for angle in swing_deg
        ]
    rotations[:, 0] = [about_axis(UP, float(np.radians(turning_degps * t))) for t in times_s]
    roots = np.tile([0.0, 0.95, 0.0], (count, 1))
    return Motion(skeleton, 1.0 / RATE_HZ, roots, rotations)


@pytest.fixture(scope="module")
def ambiguous(tmp_path_factory: pytest.TempPathFactory, database: MotionDatabase) -> MotionDatabase:
    folder = tmp_path_factory.mktemp("arms")
    clips = {
        "hanging": held(HANGING, 4.0),
        "side": held(SIDE, 4.0),
        "front": held(FRONT, 4.0),
        "raise": np.concatenate([held(HANGING, 1.0), moved(HANGING, SIDE), held(SIDE, 0.5)]),
        "sweep": np.concatenate([held(SIDE, 0.5), moved(SIDE, FRONT), held(FRONT, 0.5)]),
    }
    for name, path_deg in clips.items():
        for n, phase in enumerate((0.0, 1.5, 3.0, 4.5)):
            write_bvh(folder / f"{name}_{n}.bvh", motion(database.skeleton, path_deg, phase))
    build_database([folder], folder / "arms.smdb")
    return MotionDatabase(folder / "arms.smdb")


@pytest.fixture(scope="module")
def performed_motion(ambiguous: MotionDatabase) -> Motion:
    path_deg = [held(HANGING, 3.0), moved(HANGING, SIDE), held(SIDE, 3.0), moved(SIDE, FRONT)]
    whole_deg = np.concatenate([*path_deg, held(FRONT, 4.0)])
    return motion(ambiguous.skeleton, whole_deg, 0.7, turning_degps=25.0)


def worn(performed: Motion, *, gives: str) -> Take:
    """What sensors read of it; their orientations are in a world that is turned from ours."""
    sensors = {}
    for site, record in simulated(performed, SITES, 100.0).sensors.items():
        force = record.specific_force
        if gives == "angular_velocity":
            sensors[site] = SensorRecord(record.times_s, force, record.angular_velocity)
        elif gives == "orientation":
            turned = product(about_axis(UP, 1.3), record.orientation)
            sensors[site] = SensorRecord(record.times_s, force, None, turned)
        else:
            sensors[site] = SensorRecord(record.times_s, force)
    return Take(sensors)


def wrist_error_cm(
    database: MotionDatabase, performed: Motion, take: Take, *, best: bool, own_headings: bool
) -> float:
    """The mean error of the left wrist while the arm is held to the front."""
    solved = reconstruct(
        take, database, best_quality=best, options={"use_own_headings": own_headings}
    )
    wrist = list(database.skeleton.names).index("lradius")
    found = np.asarray(solved.motion.joint_positions("heading"))[:, wrist]
    times_s = np.asarray(solved.readings.times_s)
    truth = np.asarray(performed.joint_positions("heading"))[:, wrist]
    counted = (times_s > 9.5) & (times_s < 11.5)
    wanted = truth[np.round(times_s[counted] * RATE_HZ).astype(int)]
    return float(100.0 * np.linalg.norm(found[counted] - wanted, axis=-1).mean())


@pytest.mark.parametrize("best", [True, False])
def test_an_arm_to_the_front_is_told_from_one_to_the_side(
    ambiguous: MotionDatabase, performed_motion: Motion, best: bool
) -> None:
    gyroscopes = worn(performed_motion, gives="angular_velocity")
    with_headings, without = (
        wrist_error_cm(ambiguous, performed_motion, gyroscopes, best=best, own_headings=own)
        for own in (True, False)
    )
    orientations = wrist_error_cm(
        ambiguous,
        performed_motion,
        worn(performed_motion, gives="orientation"),
        best=best,
        own_headings=True,
    )
    print(f"best quality: {best}; {without:.1f} cm; headings found {with_headings:.1f}, "
          f"orientations {orientations:.1f}")  # fmt: skip
    assert without > 15.0  # it cannot be told
    assert with_headings < 6.0
    assert orientations < 6.0
