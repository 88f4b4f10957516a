# SPDX-License-Identifier: GPL-3.0-or-later
"""The virtual sensor against a real one: an IMU whose place and orientation cameras recorded.

The recordings are those of BROAD (Laidig, Caruso, Cereatti, Seel 2021).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import sparse_mocap
from numpy.typing import NDArray

loadmat = pytest.importorskip("scipy.io").loadmat
Rotation = pytest.importorskip("scipy.spatial.transform").Rotation

Floats = NDArray[np.float64]

TRIALS = (
    "08_undisturbed_fast_rotation_with_breaks_A",
    "15_undisturbed_fast_translation_A",
    "21_undisturbed_fast_combined",
)
RATE_HZ = 25.0

# East, north, up become x, -z, y of the project's world.
R_WORLD_ENU = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
# The sensor at the pelvis: x up, z forward, so y to the right.
R_ROOT_SENSOR = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def stiff_motion(
    skeleton: sparse_mocap.Skeleton, rate_hz: float, positions: Floats, R_world_sensor: Floats
) -> sparse_mocap.Motion:
    """A body in rest pose whose pelvis goes where the sensor went."""
    rotations = np.zeros((len(positions), len(skeleton.names), 4))
    rotations[:, :, 0] = 1.0
    root = Rotation.from_matrix(R_world_sensor @ R_ROOT_SENSOR.T)
    rotations[:, 0] = root.as_quat()[:, [3, 0, 1, 2]]
    return sparse_mocap.Motion(skeleton, 1.0 / rate_hz, positions, rotations)


def correlation(a: Floats, b: Floats) -> float:
    return float(np.corrcoef(a.ravel(), b.ravel())[0, 1])


@pytest.mark.parametrize("trial", TRIALS)
def test_the_virtual_sensor_reads_what_a_real_one_reads(
    trial: str, real_data: Path, performance: Path
) -> None:
    skeleton = sparse_mocap.standard_motion(sparse_mocap.read_motion(performance)[0])[0].skeleton
    data = loadmat(real_data / "imu" / "broad" / f"{trial}.mat", squeeze_me=True)
    rate_hz = float(data["sampling_rate"])
    times = np.arange(len(data["imu_acc"])) / rate_hz
    # Where the cameras lost the sensor, it is bridged, and not compared.
    seen = ~np.isnan(data["opt_pos"]).any(axis=1) & ~np.isnan(data["opt_quat"]).any(axis=1)
    at = np.flatnonzero(seen)
    nearest = at[np.clip(np.searchsorted(at, np.arange(len(times))), 0, len(at) - 1)]
    enu = np.stack([np.interp(times, times[at], c[at]) for c in data["opt_pos"].T], axis=1)
    R_enu_sensor = Rotation.from_quat(data["opt_quat"][nearest][:, [1, 2, 3, 0]]).as_matrix()
    motion = stiff_motion(
        skeleton, rate_hz, enu @ R_WORLD_ENU.T, np.asarray(R_WORLD_ENU @ R_enu_sensor)
    )
    virtual = sparse_mocap.simulate(motion, ["pelvis"], rate_hz)

    wanted = np.arange(1.0, times[-1] - 1.0, 1.0 / RATE_HZ)
    unseen = sparse_mocap.filtered_at(times, (~seen)[:, np.newaxis].astype(float), wanted)[:, 0]
    moving = np.interp(wanted, times, data["movement"].astype(float)) > 0.99
    chosen = wanted[moving & (unseen < 1e-12)]
    assert len(chosen) > 1000
    force, measured_force, turn, measured_turn = (
        sparse_mocap.filtered_at(times, values, chosen)
        for values in (
            virtual["specific_force"][0],
            data["imu_acc"],
            virtual["angular_velocity"][0],
            data["imu_gyr"],
        )
    )
    of_force, of_turn = correlation(force, measured_force), correlation(turn, measured_turn)
    print(f"{trial}: accelerometer {of_force:.4f}, gyroscope {of_turn:.4f}")
    assert of_force >= 0.98
    assert of_turn >= 0.98
