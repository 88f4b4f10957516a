# SPDX-License-Identifier: GPL-3.0-or-later
"""A performer's own clips with the takes to them: aligned, kept in the database, and of use.

The performers are generated, and their sensors are simulated here from joint positions by NumPy.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import sparse_mocap as sm
from click.testing import Result
from numpy.typing import NDArray
from sparse_mocap.alignment import AlignmentError
from sparse_mocap.rotations import from_rotation_vectors, inverse, product
from sparse_mocap.take import SensorRecord, Take

Floats = NDArray[np.float64]
Cli = Callable[..., Result]

SITES = {"left_wrist": "lradius", "right_wrist": "rradius", "left_ankle": "ltibia",
         "right_ankle": "rtibia"}  # fmt: skip
MOUNTED = {"left_wrist": (0.0, 0.0, 1.2), "right_wrist": (0.9, 0.0, 0.4),
           "left_ankle": (0.0, 1.1, 0.0), "right_ankle": (-0.5, 0.6, 0.5)}  # fmt: skip
"""How sensors are turned on the body, rad, against what the database assumes."""
OFFSET_MPS2 = (0.3, -0.2, 0.25)
"""What they read too much."""


def rotated(rotations: Floats, vectors: Floats) -> Floats:
    """Vectors (T, 3) turned by rotations (T, 4), w x y z."""
    padded = np.concatenate([np.zeros((len(vectors), 1)), vectors], axis=1)
    return np.asarray(product(product(rotations, padded), inverse(rotations))[:, 1:], np.float64)


def performed(path: Path, begin_s: float = 0.0, *, gyroscopes: bool = False) -> Take:
    """What turned and offset sensors measure: second differences of where they are, and gravity."""
    motion, _ = sm.to_standard(sm.read_motion(path)[0])
    names = list(motion.skeleton.names)
    ends = np.asarray(motion.joint_positions("world"))
    times_s = begin_s + np.arange(motion.num_frames) * motion.frame_time_s
    ideal = sm.simulated(motion, list(SITES), 1.0 / motion.frame_time_s)
    sensors = {}
    for site, joint in SITES.items():
        track = ends[:, names.index(joint)]
        acceleration = np.gradient(np.gradient(track, axis=0), axis=0) / motion.frame_time_s**2
        orientation = np.asarray(ideal.sensors[site].orientation)[: len(times_s)]
        mounted = from_rotation_vectors(np.array([MOUNTED[site]]))
        turned = product(orientation, np.repeat(mounted, len(times_s), axis=0))
        world = acceleration + np.array([0.0, sm.GRAVITY_MPS2, 0.0])
        force = rotated(inverse(turned), world) + np.array(OFFSET_MPS2)
        rates = None
        if gyroscopes:
            steps = np.asarray(product(inverse(turned[:-1]), turned[1:]), np.float64)
            steps *= np.sign(steps[:, :1])
            turns = np.concatenate([2.0 * steps[:, 1:], np.zeros((1, 3))])
            rates = np.asarray(turns / motion.frame_time_s, np.float64)
        sensors[site] = SensorRecord(times_s, force, rates)
    return Take(sensors)


def written(folder: Path, name: str, take: Take) -> Path:
    path = folder / f"{name}.csv"
    sm.write_take(path, take)
    return path


def late(take: Take, before: Take, pause_s: float = 0.0) -> Take:
    """The take after another one, on one clock that has no gap."""
    gap = before.end_s + 0.01 + pause_s - take.begin_s
    sensors = {}
    for site, record in take.sensors.items():
        first = before.sensors[site]
        sensors[site] = SensorRecord(
            np.concatenate([first.times_s, record.times_s + gap]),
            np.concatenate([first.specific_force, record.specific_force]),
        )
    return Take(sensors)


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from sparse_mocap.demo_motions import generate_library

    folder = tmp_path_factory.mktemp("library")
    generate_library(folder)
    return folder


@pytest.fixture(scope="module")
def stranger(library: Path) -> str:
    """A performer whom the databases do not know."""
    return sorted({path.name.split("_")[0] for path in library.glob("*.bvh")})[-1]


@pytest.fixture(scope="module")
def others(library: Path, stranger: str, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A database of everybody else."""
    path = tmp_path_factory.mktemp("others") / "others.smdb"
    sm.build_database([library], path, exclude=[f"{stranger}_*"], tempo_copies=())
    return path


def clips_of(library: Path, stranger: str, movement: str) -> list[Path]:
    found = sorted(library.glob(f"{stranger}_{movement}_*.bvh"))
    assert len(found) > 1
    return found


def error_cm(database: Path, path: Path) -> float:
    """How far the joints are off when the stranger's sensors see a motion file."""
    opened = sm.MotionDatabase(database)
    solved = sm.reconstruct(performed(path), opened)
    motion, _ = sm.to_standard(sm.read_motion(path)[0], opened.skeleton)
    truth = np.asarray(motion.joint_positions("heading"))
    at = np.asarray(solved.readings.times_s) / motion.frame_time_s
    rows = np.clip(np.round(at).astype(int), 0, len(truth) - 1)
    found, _ = sm.to_standard(solved.motion.without_extremities(), opened.skeleton)
    apart = np.asarray(found.joint_positions("heading"))[:, :21] - truth[rows][:, :21]
    return float(100.0 * np.sqrt((apart**2).sum(-1).mean(-1)).mean())


def test_a_second_performance_gets_better_and_other_movements_lose_nothing(
    library: Path, stranger: str, others: Path, tmp_path: Path
) -> None:
    taught_clip, second, *_ = clips_of(library, stranger, "squat")
    other = clips_of(library, stranger, "walk")[0]
    take = written(tmp_path, "take", performed(taught_clip))
    plain, paired = tmp_path / "plain.smdb", tmp_path / "paired.smdb"
    sm.add_to_database(others, [taught_clip], plain)
    taught = sm.teach_database(others, taught_clip, take, paired)
    assert taught.pairing.quality == "very good"
    files = {"none": others, "plain": plain, "paired": paired}
    errors = {name: error_cm(path, second) for name, path in files.items()}
    assert errors["paired"] < 0.4 * errors["none"], errors
    assert errors["paired"] < 0.4 * errors["plain"], errors
    assert error_cm(paired, other) < error_cm(others, other) + 0.1


def test_a_known_time_is_found_to_a_sample(library: Path, stranger: str, tmp_path: Path) -> None:
    walk, reach = (clips_of(library, stranger, name)[0] for name in ("walk", "reachleft"))
    before, begins = performed(walk), performed(reach)
    take = written(tmp_path, "take", late(begins, before))
    pairing, _ = sm.pair_take(reach, take)
    sample_s = float(np.diff(begins.sensors["left_wrist"].times_s)[0])
    assert abs(pairing.begin_s - (before.end_s + 0.01)) < sample_s
    assert pairing.coverage > 0.98


def test_another_movements_take_is_refused(
    library: Path, stranger: str, others: Path, tmp_path: Path
) -> None:
    movements = ("walk", "reachleft", "squat")
    files = {name: clips_of(library, stranger, name)[0] for name in movements}
    takes = {name: written(tmp_path, name, performed(path)) for name, path in files.items()}
    before = others.read_bytes()
    for motion in movements:
        for take in movements:
            if motion == take:
                assert sm.pair_take(files[motion], takes[take])[0].correlation > 0.9
                continue
            with pytest.raises(AlignmentError) as refused:
                sm.teach_database(others, files[motion], takes[take])
            assert "\n" not in str(refused.value)
            assert "check that" in str(refused.value) or "cut the motion" in str(refused.value)
    assert others.read_bytes() == before


def with_jerk(path: Path, folder: Path) -> Path:
    """The motion with a sudden movement of the whole body, which all sensors see."""
    motion, _ = sm.to_standard(sm.read_motion(path)[0])
    times_s = np.arange(motion.num_frames) * motion.frame_time_s
    roots = np.array(motion.root_positions)
    roots[:, 1] += 0.15 * np.exp(-0.5 * ((times_s - 0.5 * times_s[-1]) / 0.05) ** 2)
    changed = folder / f"{path.stem}_jerk.bvh"
    sm.write_bvh(changed, sm.Motion(motion.skeleton, motion.frame_time_s, roots, motion.rotations))
    return changed


def test_a_clap_says_which_repetition_it_is(library: Path, stranger: str, tmp_path: Path) -> None:
    squat = with_jerk(clips_of(library, stranger, "squat")[0], tmp_path)
    once = performed(squat)
    take = written(tmp_path, "twice", late(once, once))
    with pytest.raises(AlignmentError, match="several times"):
        sm.pair_take(squat, take)
    second_s = once.end_s + 0.01
    pairing, _ = sm.pair_take(squat, take, clap=(second_s, second_s + once.end_s))
    assert abs(pairing.begin_s - second_s) < 0.02
    assert pairing.correlation > 0.9


def test_what_the_take_lacks_stays_virtual(
    library: Path, stranger: str, others: Path, tmp_path: Path
) -> None:
    reach = clips_of(library, stranger, "reachleft")[0]
    whole = performed(reach, gyroscopes=True)
    part = Take({site: whole.sensors[site] for site in ("left_wrist", "right_ankle")})
    taught = sm.teach_database(
        others, reach, written(tmp_path, "gyroscopes", part), tmp_path / "taught.smdb"
    )
    channels = ["specific_force", "angular_velocity", "gravity_direction"]
    assert taught.real == {"left_wrist": channels, "right_ankle": channels}
    assert taught.notes == ["orientation stays virtual at left_wrist, right_ankle"]
    no_turns = Take({s: SensorRecord(r.times_s, r.specific_force) for s, r in part.sensors.items()})
    taught = sm.teach_database(
        others, reach, written(tmp_path, "forces", no_turns), tmp_path / "forces.smdb"
    )
    assert taught.notes[0].startswith("turning (no gyroscope) stays virtual at left_wrist")


def test_the_commands_teach_and_show_it(
    cli: Cli, library: Path, stranger: str, others: Path, tmp_path: Path
) -> None:
    def run(*arguments: object) -> str:
        result = cli(*arguments)
        assert result.exit_code == 0, result.output
        return result.output

    reach = clips_of(library, stranger, "reachleft")[0]
    take, taught = written(tmp_path, "take", performed(reach, 5.0)), tmp_path / "taught.smdb"
    said = run("database", "add", others, reach, "--take", take, "-o", taught)
    assert "the motion begins at 5.00 s of the take; their agreement is very good" in said
    shown = run("database", "info", taught)
    assert f"take     {reach.stem}" in shown
    assert run("inspect", taught) == shown
    (told,) = json.loads(run("database", "info", taught, "--json"))["takes"]
    assert told["name"] == "take.csv"
    assert told["channels"]["left_wrist"] == ["specific_force"]


@pytest.mark.parametrize(
    "arguments",
    [
        ["{reach}", "--clap", "1:2"],
        ["{reach}", "{reach}", "--take", "{take}"],
        ["{folder}", "--take", "{take}"],
        ["{reach}", "--take", "{take}", "--rebuild"],
    ],
)
def test_options_that_do_not_go_together(
    cli: Cli, library: Path, stranger: str, others: Path, tmp_path: Path, arguments: list[str]
) -> None:
    reach = clips_of(library, stranger, "reachleft")[0]
    names = {"reach": str(reach), "folder": str(library), "take": str(tmp_path / "take.csv")}
    filled = [argument.format(**names) for argument in arguments]
    result = cli("database", "add", others, *filled)
    assert result.exit_code == 2
    assert "--take" in result.output
