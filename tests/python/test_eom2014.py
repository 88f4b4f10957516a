# SPDX-License-Identifier: GPL-3.0-or-later
"""The method of Eom et al. 2014: a walk from one phone on an ankle."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from numpy.typing import NDArray
from scipy.optimize import minimize
from sparse_mocap import (
    Cancelled,
    ConfigError,
    FormatError,
    Model,
    Motion,
    Reconstruction,
    TrainingClip,
    read_model,
    read_motion,
    read_take,
    simulated,
    to_standard,
    train,
    write_take,
)
from sparse_mocap.evaluation import frame_errors, joint_errors
from sparse_mocap.evaluation.movement import headings_rad
from sparse_mocap.reconstruction import reconstruct
from sparse_mocap.take import SensorRecord, Take

Cli = Callable[..., Result]
Floats = NDArray[np.float64]

SITE = "left_ankle"
FEW = {"iterations": "40"}


def squared_distances(a: Floats) -> Floats:
    return np.asarray(((a[:, None] - a[None]) ** 2).sum(axis=2))


def likelihood(K: Floats, Y: Floats) -> float:
    """Equations 2 and 4 as they stand, at the W that makes them largest."""
    n, d = Y.shape
    inverse = np.linalg.inv(K)
    weights = np.sqrt(n / np.einsum("id,ij,jd->d", Y, inverse, Y))
    scaled = Y * weights
    return float(
        -0.5 * np.trace(inverse @ scaled @ scaled.T)
        - 0.5 * d * np.linalg.slogdet(K)[1]
        + n * np.log(weights).sum()
    )


def log_posterior(X: Floats, alpha: Floats, beta: Floats, Y: Floats, V: Floats) -> float:
    """Equation 6, of centred poses and velocities of one sequence, with the prior of X."""
    K = alpha[0] * np.exp(-0.5 * alpha[1] * squared_distances(X)) + alpha[2] * np.eye(len(X))
    steps = np.diff(X, axis=0)
    K_steps = beta[0] * (steps @ steps.T) * np.exp(
        -0.5 * beta[1] * squared_distances(steps) - 0.5 * beta[2] * squared_distances(X[1:])
    ) + beta[3] * np.eye(len(steps))
    priors = np.log(alpha).sum() + np.log(beta).sum() + 0.5 * (X**2).sum()
    return likelihood(K, Y) + likelihood(K_steps, V) - float(priors)


def centred(values: Floats) -> Floats:
    values = np.asarray(values, float)
    moving = values[:, values.std(axis=0) > 1e-6]
    return np.asarray(moving - moving.mean(axis=0))


@pytest.fixture(scope="module")
def walk(library: Path) -> Motion:
    return to_standard(read_motion(library / "ada_walk_01.bvh")[0])[0]


@pytest.fixture(scope="module")
def other_walk(library: Path) -> Motion:
    return to_standard(read_motion(library / "ada_walk_02.bvh")[0])[0]


@pytest.fixture(scope="module")
def model(walk: Motion) -> Model:
    return train("eom2014", [TrainingClip("walk", walk)], options=FEW)


def solved(model: Model, take: Take, **options: object) -> Reconstruction:
    return reconstruct(
        take, None, best_quality=True, method="eom2014", model=model, options=options
    )


def error_cm(found: Reconstruction, truth: Motion) -> float:
    """The mean error over joints and frames, without the ends."""
    positions = np.asarray(truth.resampled(found.rate_hz).joint_positions("heading"))
    ours = np.asarray(found.motion.without_extremities().joint_positions("heading"))
    count = min(len(ours), len(positions))
    return 100.0 * float(frame_errors(joint_errors(positions[:count], ours[:count])).mean())


def ankle_take(motion: Motion, site: str = SITE) -> Take:
    return simulated(motion, [site], 100.0)


def changed(take: Take, change: Callable[[SensorRecord], SensorRecord]) -> Take:
    return Take({name: change(record) for name, record in take.sensors.items()})


def test_the_posterior_is_that_of_a_numpy_transcription(model: Model) -> None:
    told = float(model.metadata["type0.log_posterior"])
    ours = log_posterior(
        np.asarray(model.tensor("type0.latent")),
        np.asarray(model.tensor("type0.alpha")),
        np.asarray(model.tensor("type0.beta")),
        centred(model.tensor("type0.poses")),
        centred(model.tensor("type0.velocities")),
    )
    assert told == pytest.approx(ours, rel=1e-6)


def test_training_ends_where_scipy_does(walk: Motion) -> None:
    options = {"motion_frames": "16", "latent_dimensions": "2", "iterations": "2000"}
    learnt = train("eom2014", [TrainingClip("walk", walk)], options=options)
    Y, V = centred(learnt.tensor("type0.poses")), centred(learnt.tensor("type0.velocities"))

    def cost(values: Floats) -> float:
        alpha = np.exp(np.concatenate([[0.0], values[-5:-3]]))
        beta = np.exp(np.concatenate([[0.0], values[-3:]]))
        return -log_posterior(values[:-5].reshape(len(Y), 2), alpha, beta, Y, V)

    # From principal components, as the method starts.
    U, s, _ = np.linalg.svd(Y / Y.std(axis=0), full_matrices=False)
    X = U[:, :2] * s[:2] * np.sqrt(len(Y)) / s[0]
    noise = 0.1 * (np.diff(X, axis=0) ** 2).sum(axis=1).mean()
    start = np.concatenate([X.ravel(), [0.0, np.log(0.01), 0.0, 0.0, np.log(noise)]])
    found = minimize(cost, start, method="L-BFGS-B", options={"maxiter": 250, "maxfun": 100_000})
    assert float(learnt.metadata["type0.log_posterior"]) >= -found.fun - 0.001 * abs(found.fun)


def test_a_walk_comes_back_from_an_ankle(model: Model, walk: Motion, other_walk: Motion) -> None:
    again = solved(model, ankle_take(walk))
    assert error_cm(again, walk) < 2.0
    held = np.asarray(walk.resampled(30.0).joint_positions("heading"))
    still_cm = 100.0 * float(frame_errors(joint_errors(held, held.mean(axis=0)[None])).mean())
    assert error_cm(solved(model, ankle_take(other_walk)), other_walk) < 0.6 * still_cm


def way_from_start(motion: Motion) -> Floats:
    """Returns where the root gets to, left and forward of where it began (m)."""
    names = list(motion.skeleton.names)
    ends = np.asarray(motion.joint_positions("world"))
    left, right = (ends[:1, names.index(name)] for name in ("lhipjoint", "rhipjoint"))
    yaw = headings_rad(left, right)[0]
    x, _, z = motion.root_positions[-1] - motion.root_positions[0]
    return np.array([np.cos(yaw) * x - np.sin(yaw) * z, np.sin(yaw) * x + np.cos(yaw) * z])


def test_it_gets_as_far_as_the_performer(model: Model, walk: Motion) -> None:
    found = solved(model, ankle_take(walk)).motion
    truth = way_from_start(walk.resampled(30.0))
    assert np.linalg.norm(truth) > 0.5
    assert np.linalg.norm(way_from_start(found) - truth) < 0.15 * np.linalg.norm(truth)


def test_phases_are_recognised(model: Model, walk: Motion) -> None:
    found = solved(model, ankle_take(walk)).diagnostics["phase"][:, 0]
    names = list(walk.skeleton.names)
    ends = np.asarray(walk.resampled(30.0).joint_positions("world"))
    left, right = (ends[:, names.index(name), 1] for name in ("ltibia", "rtibia"))
    # 1: the left foot steps, 2: the right one; the higher ankle is that of the step for most of it.
    is_clear = (np.abs(left - right) > 0.04) & np.isin(found, (1, 2))
    agrees = np.where(left > right, 1, 2)[is_clear] == found[is_clear]
    assert is_clear.sum() > 10
    assert agrees.mean() > 0.75
    # The performer stands first and last: 4 starts, 5 stops.
    assert {0, 1, 2, 4, 5} == set(found.astype(int).tolist())
    assert np.flatnonzero(found == 4).max() < np.flatnonzero(found == 5).min()


def test_a_strap_that_is_turned_is_noticed(model: Model, walk: Motion) -> None:
    turn = np.radians(30.0)
    R = np.array([[1, 0, 0], [0, np.cos(turn), -np.sin(turn)], [0, np.sin(turn), np.cos(turn)]])
    turned = changed(
        ankle_take(walk),
        lambda r: SensorRecord(r.times_s, r.specific_force @ R, r.angular_velocity @ R),
    )
    found = solved(model, turned)
    (told,) = (int(d) for note in found.notes for d in re.findall(r"turned by (\d+) degrees", note))
    assert told == pytest.approx(30, abs=4)
    assert error_cm(found, walk) < 2.0
    assert error_cm(solved(model, turned, estimates_mounting=False), walk) > 2.0


def test_the_other_leg_is_told_apart(model: Model, walk: Motion) -> None:
    take = ankle_take(walk, "right_ankle")
    assert not any("other leg" in note for note in solved(model, take).notes)
    wrong = Take({SITE: take.sensors["right_ankle"]})
    assert any("is the sensor on the other leg?" in note for note in solved(model, wrong).notes)


def test_conventions_of_phones_are_recognised_and_said(model: Model, walk: Motion) -> None:
    take = ankle_take(walk)
    straight = solved(model, take)
    for change, note in (
        ((-1.0, 1.0), "the sign of an iPhone"),
        ((1.0 / 9.81, 1.0), "converted from g"),
        ((1.0, 180.0 / np.pi), "converted from degrees a second"),
    ):
        force, turn = change
        told = changed(
            take,
            lambda r, force=force, turn=turn: SensorRecord(
                r.times_s, force * r.specific_force, turn * r.angular_velocity
            ),
        )
        found = solved(model, told)
        assert any(note in line for line in found.notes)
        np.testing.assert_allclose(
            found.motion.joint_positions("heading"),
            straight.motion.joint_positions("heading"),
            atol=0.03,
        )


def test_what_cannot_be_used_is_refused_in_a_line(
    model: Model, walk: Motion, library: Path
) -> None:
    take = ankle_take(walk)
    record = take.sensors[SITE]
    free = record.specific_force - record.specific_force.mean(axis=0)
    with pytest.raises(ConfigError, match="no gravity in them: 0 cm/s"):
        solved(model, Take({SITE: SensorRecord(record.times_s, free, record.angular_velocity)}))
    short = SensorRecord(
        record.times_s[:60], record.specific_force[:60], record.angular_velocity[:60]
    )
    with pytest.raises(ConfigError, match="too short"):
        solved(model, Take({SITE: short}))
    with pytest.raises(ConfigError, match="angular_velocity"):
        solved(model, Take({SITE: SensorRecord(record.times_s, record.specific_force)}))
    with pytest.raises(ConfigError, match="trained for a sensor at left_ankle, right_ankle"):
        solved(model, ankle_take(walk, "head"))
    squat = to_standard(read_motion(library / "ada_squat_01.bvh")[0])[0]
    with pytest.raises(ConfigError, match="the clip 'squat' has no steps"):
        train("eom2014", [TrainingClip("squat", squat)], options=FEW)


@pytest.mark.parametrize("movement", ["kickleft_01", "kickright_01", "squat_01"])
def test_another_movement_is_said_to_be_unknown(model: Model, library: Path, movement: str) -> None:
    """Of a leg that kicks, of one that stands meanwhile, and of a squat."""
    kick = to_standard(read_motion(library / f"ada_{movement}.bvh")[0])[0]
    found = solved(model, ankle_take(kick))
    assert any("unlike the clips" in note for note in found.notes)
    positions = np.asarray(found.motion.joint_positions("heading"))
    assert np.abs(positions).max() < 2.0


def test_training_can_be_cancelled(walk: Motion) -> None:
    told: list[tuple[int, int, str]] = []

    def progress(done: int, total: int, what: str) -> bool:
        told.append((done, total, what))
        return len(told) < 5

    with pytest.raises(Cancelled):
        train("eom2014", [TrainingClip("walk", walk)], progress=progress)
    assert len(told) == 5
    assert told[0][2] == "learning the motion"


def test_a_phone_export_becomes_a_motion_on_the_command_line(
    cli: Cli, library: Path, walk: Motion, tmp_path: Path
) -> None:
    folder, model_path = tmp_path / "phone", tmp_path / "walk.smmodel"
    write_sensor_logger(folder, ankle_take(walk).sensors[SITE])
    output, take_path = tmp_path / "out.bvh", tmp_path / "take.csv"
    cli("train", library / "ada_walk_01.bvh", "--method", "eom2014", "-o", model_path,
        "--set", "iterations=40")  # fmt: skip
    assert read_model(model_path).method == "eom2014"
    cli("import", folder, "-o", take_path, "--site", f"phone={SITE}")
    done = cli("reconstruct", take_path, "-o", output, "--method", "eom2014", "--model",
               model_path, "--offline")  # fmt: skip
    assert "sensors match the model: good" in done.output
    assert "misfit of the readings" in done.output
    assert read_motion(output)[0].num_frames == pytest.approx(30 * 0.99 * walk_s(walk), abs=3)
    assert len(read_take(take_path).sensors[SITE].times_s) > 100


def walk_s(motion: Motion) -> float:
    return motion.num_frames * motion.frame_time_s


def write_sensor_logger(folder: Path, record: SensorRecord) -> None:
    """An iPhone's export: in g and of the opposite sign, at uneven times, some samples missing."""
    folder.mkdir()
    random = np.random.default_rng(5)
    assert record.angular_velocity is not None
    times = record.times_s + random.uniform(-0.002, 0.002, len(record.times_s))
    kept = random.uniform(size=len(times)) > 0.05
    for name, values in (
        ("TotalAcceleration", -record.specific_force / 9.80665),
        ("Gyroscope", record.angular_velocity),
    ):
        with (folder / f"{name}.csv").open("w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["time", "seconds_elapsed", "z", "y", "x"])
            for t, (x, y, z) in zip(times[kept], values[kept], strict=True):
                writer.writerow([int(1e9 * t), t, z, y, x])
    with (folder / "Metadata.csv").open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["version", "platform", "standardisation"])
        writer.writerow(["3", "ios", "false"])


def test_it_is_evaluated_on_files_that_it_was_not_trained_on(
    cli: Cli, library: Path, tmp_path: Path
) -> None:
    done = cli("evaluate", "--database-source", library, "--scenario", "1", "--train",
               "ada_walk_01.bvh", "--tests", "ada_walk_02.bvh", "--method", "eom2014", "--sites",
               SITE, "--gyroscopes", "--set", "iterations=40", "--offline")  # fmt: skip
    assert "eom2014 default, best" in done.output
    for part in ("upper body", "lower body", "per axis", "frames under 5 cm"):
        assert part in done.output


def test_a_model_of_another_method_or_a_broken_one_is_refused(model: Model, walk: Motion) -> None:
    tensors = {name: np.array(model.tensor(name)) for name, *_ in model.tensor_infos}
    tensors["type0.alpha"][2] = -1.0
    broken = Model("eom2014", tensors, metadata=model.metadata, version=model.version)
    with pytest.raises(FormatError, match="are positive; train it again"):
        solved(broken, ankle_take(walk))
    other = Model("held_pose", {}, metadata=model.metadata)
    with pytest.raises(FormatError, match="is a model of 'held_pose'"):
        solved(other, ankle_take(walk))


@pytest.mark.parametrize(("test", "highest_cm"), [("35_03", 3.0), ("07_01", 9.0)])
def test_recorded_walks_come_back_from_a_single_clip(
    real_data: Path, test: str, highest_cm: float
) -> None:
    folder = real_data / "cmu" / "bvh"
    known, truth = (to_standard(read_motion(folder / f"{n}.bvh")[0])[0] for n in ("35_02", test))
    learnt = train("eom2014", [TrainingClip("35_02", known)])
    found = solved(learnt, ankle_take(truth))
    motion = to_standard(found.motion.without_extremities(), truth.skeleton)[0]
    positions = np.asarray(truth.resampled(30.0).joint_positions("heading"))
    ours = np.asarray(motion.joint_positions("heading"))
    count = min(len(ours), len(positions))
    errors = frame_errors(joint_errors(positions[:count], ours[:count]))
    assert 100.0 * errors.mean() < highest_cm


def test_a_take_keeps_what_it_had(model: Model, walk: Motion, tmp_path: Path) -> None:
    path = tmp_path / "take.csv"
    write_take(path, ankle_take(walk))
    before = path.read_bytes()
    solved(model, read_take(path))
    assert path.read_bytes() == before
