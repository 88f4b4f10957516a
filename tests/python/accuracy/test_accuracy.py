# SPDX-License-Identifier: GPL-3.0-or-later
"""How well a performance comes out of a few sensors, by numbers that every change must hold.

The performer is nobody of the database: quicker by a quarter, taller, and going to the right where
its clips go to the left. Readings are worked out without the core. The figures are narrow on
purpose, upwards and downwards: a fault that costs little accuracy, or moves it elsewhere, is a
fault as well. A change that means to alter them states the new ones here; ``./dev mutants`` then
tells whether they still guard against what they are there for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from accuracy_motions import PERFORMER, perform_programme, write_library
from accuracy_pipeline import built, reconstructed, truth
from accuracy_sensors import worn
from numpy.typing import NDArray
from sparse_mocap import Motion, MotionDatabase, Take

Floats = NDArray[np.float64]
Solve = Callable[[str, str], Motion]

CM = 100.0
STANDING_MPS = 0.15
"""A foot that moves no faster than this in truth stands."""

DRIFT_FRAMES = 50  # two seconds

ANKLES = ("left_ankle", "right_ankle")
# "With inclinations": gyroscopes say how sensors stand against gravity, and not where they point.
FIGURES = [  # sensors, quality, what is measured, how much it is, and by how much it may differ
    ("wrists and ankles", "live", "error_cm", 3.040, 0.07),
    ("wrists and ankles", "live", "lag_ms", 5.8, 3.0),
    ("wrists and ankles", "live", "slide_cmps", 1.52, 0.3),
    ("wrists and ankles", "live", "jerk_kmps3", 0.0677, 0.004),
    ("wrists and ankles", "whole take", "error_cm", 2.788, 0.07),
    ("wrists and ankles", "whole take", "lag_ms", -0.2, 2.0),
    ("wrists and ankles", "whole take", "slide_cmps", 1.53, 0.3),
    ("wrists and ankles", "whole take", "jerk_kmps3", 0.0534, 0.004),
    ("wrists and ankles", "live", "wrist_turn_deg", 0.203, 0.03),
    ("wrists and ankles", "whole take", "wrist_turn_deg", 0.153, 0.03),
    ("with gyroscopes", "live", "error_cm", 2.662, 0.07),
    ("with gyroscopes", "live", "hands_cm", 4.68, 0.15),
    ("with gyroscopes", "live", "jerk_kmps3", 0.0665, 0.005),
    ("with gyroscopes", "whole take", "error_cm", 2.172, 0.07),
    ("with gyroscopes", "whole take", "hands_cm", 4.05, 0.15),
    ("with inclinations", "live", "error_cm", 2.742, 0.07),
    ("with inclinations", "live", "hands_cm", 5.02, 0.15),
    ("with inclinations", "whole take", "error_cm", 2.568, 0.07),
    ("with inclinations", "whole take", "hands_cm", 4.92, 0.15),
    ("with gyroscopes", "live", "heading_deg", 1.24, 0.3),
    ("with gyroscopes", "whole take", "heading_deg", 0.92, 0.3),
    ("wrists and ankles", "live", "sunk_cm", 0.0, 0.02),
    ("wrists and ankles", "whole take", "sunk_cm", 0.0, 0.02),
    ("wrists and ankles", "whole take", "root_cm", 6.4, 1.5),
    ("ankles", "live", "error_cm", 5.858, 0.15),
    ("ankles", "whole take", "error_cm", 4.812, 0.15),
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("accuracy")


@pytest.fixture(scope="module")
def database(folder: Path) -> MotionDatabase:
    return built(write_library(folder), folder / "library.smdb")


@pytest.fixture(scope="module")
def take(folder: Path) -> Take:
    return worn(PERFORMER.body, perform_programme(folder / "performance.bvh"), seed=3)


@pytest.fixture(scope="module")
def performed(folder: Path, take: Take, database: MotionDatabase) -> Motion:
    return truth(folder / "performance.bvh", database)


@pytest.fixture(scope="module")
def solve(take: Take, database: MotionDatabase) -> Iterator[Solve]:
    @cache
    def solved(sensors: str, quality: str) -> Motion:
        sites = ANKLES if sensors == "ankles" else take.sites
        return reconstructed(
            Take({site: take.sensors[site] for site in sites}),
            database,
            best_quality=quality == "whole take",
            gyroscopes=sensors in ("with gyroscopes", "with inclinations"),
            own_headings=sensors != "with inclinations",
        )

    yield solved
    solved.cache_clear()


@pytest.mark.parametrize(
    ("sensors", "quality", "measure", "expected", "tolerance"),
    [pytest.param(*row, id="-".join(row[:3]).replace(" ", "_")) for row in FIGURES],
)
def test_a_figure_is_held(
    performed: Motion,
    solve: Solve,
    sensors: str,
    quality: str,
    measure: str,
    expected: float,
    tolerance: float,
) -> None:
    estimate = solve(sensors, quality).without_extremities()
    assert abs(performed.num_frames - estimate.num_frames) <= 1
    num_frames = min(performed.num_frames, estimate.num_frames)
    measured = MEASURES[measure](performed.trimmed(0, num_frames), estimate.trimmed(0, num_frames))
    assert measured == pytest.approx(expected, abs=tolerance)


def in_heading(motion: Motion) -> Floats:
    """(T, 21, 3) m."""
    return np.asarray(motion.joint_positions("heading"))


def ankles(motion: Motion) -> Floats:
    """(T, 2, 3) m, world."""
    joints = [motion.skeleton.names.index(name) for name in ("ltibia", "rtibia")]
    return np.asarray(motion.joint_positions("world"))[:, joints]


def error_cm(performed: Motion, estimate: Motion) -> float:
    """RMS over the joints in the heading frame, mean over the frames."""
    squares = ((in_heading(estimate) - in_heading(performed)) ** 2).sum(axis=2)
    return CM * float(np.sqrt(squares.mean(axis=1)).mean())


def hands_cm(performed: Motion, estimate: Motion) -> float:
    """Mean distance of the two hands' bases from where they were, in the heading frame."""
    joints = [performed.skeleton.names.index(name) for name in ("lwrist", "rwrist")]
    difference = (in_heading(estimate) - in_heading(performed))[:, joints]
    return CM * float(np.linalg.norm(difference, axis=2).mean())


def slide_cmps(performed: Motion, estimate: Motion) -> float:
    """Mean speed over the floor of the feet that stand in truth."""
    stands = np.linalg.norm(np.diff(ankles(performed), axis=0), axis=2) < (
        STANDING_MPS * performed.frame_time_s
    )
    assert stands.mean() > 0.3
    moved = np.linalg.norm(np.diff(ankles(estimate)[:, :, [0, 2]], axis=0), axis=2)
    return CM * float(moved[stands].mean()) / performed.frame_time_s


def lag_ms(performed: Motion, estimate: Motion) -> float:
    """How late the estimate is: where the squared error over time shifts would be least."""
    one, other = in_heading(performed), in_heading(estimate)
    inner = slice(1, -1)
    early, now, late = (
        float(((np.roll(other, -shift, axis=0) - one)[inner] ** 2).sum()) for shift in (-1, 0, 1)
    )
    frames = 0.5 * (early - late) / (early - 2.0 * now + late)
    return 1000.0 * frames * performed.frame_time_s


def jerk_kmps3(performed: Motion, estimate: Motion) -> float:
    """Mean size of the joints' third derivative in the heading frame."""
    third = np.diff(in_heading(estimate), 3, axis=0) / performed.frame_time_s**3
    return float(np.linalg.norm(third, axis=2).mean()) / 1000.0


def wrist_turn_deg(performed: Motion, estimate: Motion) -> float:
    """Mean turn of the two wrists from frame to frame."""
    joints = [estimate.skeleton.names.index(name) for name in ("lwrist", "rwrist")]
    turns = np.asarray(estimate.rotations)[:, joints]
    cosine = np.abs((turns[1:] * turns[:-1]).sum(axis=2))
    return float(np.degrees(2.0 * np.arccos(np.minimum(cosine, 1.0))).mean())


def heading_deg(performed: Motion, estimate: Motion) -> float:
    """How far the heading has drifted after two seconds, mean over all beginnings."""
    turned = [yaw[DRIFT_FRAMES:] - yaw[:-DRIFT_FRAMES] for yaw in map(yaws, (performed, estimate))]
    return float(np.degrees(np.abs(turned[1] - turned[0])).mean())


def root_cm(performed: Motion, estimate: Motion) -> float:
    """How far the root's path differs in length after two seconds, mean over all beginnings."""
    ways = []
    for motion in (performed, estimate):
        root = np.asarray(motion.joint_positions("world"))[:, 0][:, [0, 2]]
        ways.append(np.linalg.norm(root[DRIFT_FRAMES:] - root[:-DRIFT_FRAMES], axis=1))
    return CM * float(np.abs(ways[1] - ways[0]).mean())


def sunk_cm(performed: Motion, estimate: Motion) -> float:
    """Mean depth of the ankles below the lowest place that they ever have in truth."""
    lowest = ankles(performed)[..., 1].min()
    return CM * float(np.maximum(lowest - ankles(estimate)[..., 1], 0.0).mean())


def yaws(motion: Motion) -> Floats:
    """(T,) rad: where the axis of the hips points."""
    names = motion.skeleton.names
    ends = np.asarray(motion.joint_positions("world"))
    axis = ends[:, names.index("lhipjoint")] - ends[:, names.index("rhipjoint")]
    return np.asarray(np.unwrap(np.arctan2(-axis[:, 2], axis[:, 0])))


MEASURES: dict[str, Callable[[Motion, Motion], float]] = {
    measure.__name__: measure
    for measure in (
        error_cm,
        hands_cm,
        slide_cmps,
        lag_ms,
        jerk_kmps3,
        wrist_turn_deg,
        heading_deg,
        root_cm,
        sunk_cm,
    )
}
