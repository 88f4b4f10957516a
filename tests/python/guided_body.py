# SPDX-License-Identifier: GPL-3.0-or-later
"""A body, on the standard skeleton, that stands and then makes guided movements; its sensors.

guided_body.py OUT.csv PLANTED.npy ELBOWS_S SQUATS_S END_S: writes what sensors at wrists and ankles
read that are turned and scaled on their limbs, and how each is turned, (4, 3, 3) R_site_sensor.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from sparse_mocap import (
    Motion,
    SensorRecord,
    Skeleton,
    Take,
    read_motion,
    simulated,
    to_standard,
    write_bvh,
    write_take,
)
from sparse_mocap.demo_motions.library import generate_performance

Floats = NDArray[np.float64]
Span = tuple[float, float]

SITES = ("left_wrist", "right_wrist", "left_ankle", "right_ankle")
RATE_HZ = 100.0


def bends(times_s: Floats, begin_s: float, end_s: float) -> Floats:
    """0 to 1 and back every two seconds."""
    inside = (times_s >= begin_s) & (times_s < end_s)
    return np.where(inside, 0.5 * (1 - np.cos(np.pi * (times_s - begin_s))), 0.0)


def turn(axis: Floats, angles: Floats) -> Rotation:
    return Rotation.from_rotvec(np.outer(angles, axis))


def guided(skeleton: Skeleton, elbows: Span, squats: Span, end_s: float) -> Motion:
    """Stands with hanging arms and upright legs, bends the elbows forward, squats on the spot."""
    names, bones = skeleton.names, skeleton.bones
    times = np.arange(int(end_s * RATE_HZ)) / RATE_HZ
    still = Rotation.identity(len(times))
    R = {name: still for name in names}  # in the world
    x = np.array([1.0, 0.0, 0.0])
    elbow, knee = 1.9 * bends(times, *elbows), 1.4 * bends(times, *squats)
    for side in "lr":
        hang = Rotation.align_vectors(
            [[0, -1, 0], [0, 0, 1]], [bones[names.index(f"{side}humerus")], [0, 0, 1]]
        )[0]
        R[f"{side}humerus"] = still * hang
        R[f"{side}radius"] = R[f"{side}wrist"] = turn(-x, elbow) * hang
        upright = Rotation.align_vectors(
            [[0, -1, 0], [0, 0, 1]], [bones[names.index(f"{side}femur")], [0, 0, 1]]
        )[0]
        R[f"{side}femur"] = turn(-x, 0.5 * knee) * upright
        R[f"{side}tibia"] = turn(x, 0.5 * knee) * upright
    legs = sum(R[f"l{bone}"].apply(bones[names.index(f"l{bone}")]) for bone in ("femur", "tibia"))
    local = [
        R[name] if parent < 0 else R[names[parent]].inv() * R[name]
        for name, parent in zip(names, skeleton.parents, strict=True)
    ]
    rotations = np.stack([r.as_quat()[:, [3, 0, 1, 2]] for r in local], axis=1)
    return Motion(skeleton, 1.0 / RATE_HZ, np.array([0.0, 1.0, 0.0]) - legs + legs[:1], rotations)


def worn(record: SensorRecord, turned: Rotation, scale: float, seed: int) -> SensorRecord:
    noise = np.random.default_rng(seed)
    back = turned.inv()
    force = back.apply(record.specific_force) + 0.05 * noise.normal(size=(len(record.times_s), 3))
    assert record.angular_velocity is not None
    rate = back.apply(record.angular_velocity) + 0.01 * noise.normal(size=force.shape)
    return SensorRecord(record.times_s, force / scale, rate)


def planted_turns(source: np.random.Generator) -> list[Rotation]:
    """A turn of up to 30 degrees for each sensor."""
    axes = source.normal(size=(len(SITES), 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    return [Rotation.from_rotvec(axis * np.radians(source.uniform(0, 30))) for axis in axes]


def main(out: Path, planted: Path, *times_s: str) -> None:
    """Writes the take, what is to be found in it, and the body's motion beside it."""
    elbows_s, squats_s, end_s = map(float, times_s)
    with tempfile.TemporaryDirectory() as folder:
        performance = generate_performance(Path(folder) / "performance.bvh")
        skeleton = to_standard(read_motion(performance)[0])[0].skeleton
    body = guided(skeleton, (elbows_s, squats_s), (squats_s, end_s), end_s)
    ideal = simulated(body, list(SITES), RATE_HZ)
    turned = planted_turns(np.random.default_rng(5))
    sensors = {site: worn(ideal.sensors[site], turned[i], 1.03, i) for i, site in enumerate(SITES)}
    write_take(out, Take(sensors))
    write_bvh(out.with_name("body.bvh"), body)
    np.save(planted, np.array([turn.as_matrix() for turn in turned]))


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), *sys.argv[3:])
