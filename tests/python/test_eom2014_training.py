# SPDX-License-Identifier: GPL-3.0-or-later
"""What models of eom2014 are trained from, types of motion, phases, and a phone that streams."""

from __future__ import annotations

import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest
import sparse_mocap
from click.testing import Result
from numpy.typing import NDArray
from sparse_mocap import (
    ConfigError,
    FormatError,
    Model,
    Motion,
    MotionDatabase,
    TrainingClip,
    clip_segments,
    read_model,
    read_motion,
    simulated,
    to_standard,
    train,
    write_take,
)
from sparse_mocap.capture.session import FOLDER_VARIABLE
from sparse_mocap.evaluation import frame_errors, joint_errors
from sparse_mocap.evaluation.movement import headings_rad
from sparse_mocap.latent_space import PHASES, latent_maps
from sparse_mocap.positions import read_positions
from sparse_mocap.reconstruction import reconstruct
from sparse_mocap.rotations import product
from sparse_mocap.take import SensorRecord, Take
from sparse_mocap.training import (
    database_clips,
    read_phases,
    trainable_classes,
    write_phases,
)

Cli = Callable[..., Result]
Floats = NDArray[np.float64]

SITE = "left_ankle"
FEW = {"iterations": "40"}


def standard(path: Path) -> Motion:
    return to_standard(read_motion(path)[0])[0]


@pytest.fixture(scope="module")
def walk(library: Path) -> Motion:
    return standard(library / "ada_walk_01.bvh")


@pytest.fixture(scope="module")
def model(walk: Motion) -> Model:
    return train("eom2014", [TrainingClip("walk", walk)], options=FEW)


@pytest.fixture(scope="module")
def gaits(library: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A database of walks and squats of one performer, with mirrored copies."""
    path = tmp_path_factory.mktemp("gaits") / "gaits.smdb"
    files = [library / f"ada_{name}.bvh" for name in ("walk_01", "walk_02", "squat_01")]
    sparse_mocap.build_database(files, path, mirror=True)
    return path


def error_cm(positions: Floats, truth: Motion) -> float:
    wanted = np.asarray(truth.resampled(30.0).joint_positions("heading"))
    count = min(len(wanted), len(positions))
    return 100.0 * float(frame_errors(joint_errors(wanted[:count], positions[:count, :21])).mean())


def test_clips_of_a_database_are_chosen_by_class_and_name(gaits: Path) -> None:
    database = MotionDatabase(gaits)
    assert trainable_classes(database) == ["squat", "walk"]
    walks = database_clips(database, classes=["walk"])
    assert sorted(clip.name for clip in walks) == ["ada_walk_01", "ada_walk_02"]
    assert {clip.motion_class for clip in walks} == {"walk"}
    [one] = database_clips(database, names=["*walk_02*"])
    assert one.name == "ada_walk_02"
    with pytest.raises(ConfigError, match="no clip of the class 'swim'; its classes are squat, w"):
        database_clips(database, classes=["swim"])
    with pytest.raises(ConfigError, match="no clip named 'run"):
        database_clips(database, names=["run*"])


def test_a_model_from_a_database_is_nearly_that_from_the_file(
    gaits: Path, walk: Motion, model: Model
) -> None:
    """Its poses and readings were sampled at 25 Hz and are stored in two bytes."""
    clips = database_clips(MotionDatabase(gaits), names=["ada_walk_01"])
    learnt = train("eom2014", clips, options=FEW)
    take = simulated(walk, [SITE], 100.0)
    errors = [
        error_cm(np.asarray(found.motion.joint_positions("heading")), walk)
        for found in (
            reconstruct(take, best_quality=True, method="eom2014", model=one)
            for one in (learnt, model)
        )
    ]
    assert errors[0] < errors[1] + 1.0


def test_readings_of_a_database_are_those_of_the_sensor(gaits: Path, walk: Motion) -> None:
    [clip] = database_clips(MotionDatabase(gaits), names=["ada_walk_01"])
    learnt = train("eom2014", [clip], options={"iterations": "1"})
    direct = train("eom2014", [TrainingClip("walk", walk)], options={"iterations": "1"})
    ours, wanted = (np.asarray(one.tensor(f"type0.{SITE}.readings")) for one in (learnt, direct))
    inner = slice(5, min(len(ours), len(wanted)) - 5)
    spread = wanted.std(axis=0)
    assert (np.abs(ours[inner] - wanted[inner]).mean(axis=0) < 0.12 * spread).all()


def test_types_of_motion_are_learnt_apart_and_recognised(
    library: Path, walk: Motion, tmp_path: Path, cli: Cli
) -> None:
    path = tmp_path / "two.smmodel"
    turned = tmp_path / "fast_walk.bvh"
    fast = Motion(walk.skeleton, walk.frame_time_s / 2.0, walk.root_positions, walk.rotations)
    sparse_mocap.write_bvh(turned, fast)
    done = cli("train", library / "ada_walk_01.bvh", turned, "--method", "eom2014", "-o", path,
               "--type", "walk=ada*", "--type", "run=fast*", "--set", "iterations=20")  # fmt: skip
    assert "of 2 types of motion" in done.output
    learnt = read_model(path)
    assert {learnt.metadata[f"type{i}.name"] for i in (0, 1)} == {"walk", "run"}
    numbers = {learnt.metadata[f"type{i}.name"]: i for i in (0, 1)}
    for name, motion in (("walk", walk), ("run", fast)):
        take = simulated(motion, [SITE], 100.0)
        found = reconstruct(take, best_quality=True, method="eom2014", model=learnt)
        types = found.diagnostics["motion_type"][:, 0]
        assert (types == numbers[name]).mean() > 0.8
        assert error_cm(np.asarray(found.motion.joint_positions("heading")), motion) < 3.0


def test_phases_are_listed_written_changed_and_trained_from(
    library: Path, tmp_path: Path, cli: Cli
) -> None:
    clip, table = library / "ada_walk_01.bvh", tmp_path / "phases.csv"
    listed = cli("phases", clip).output
    assert "left step" not in listed
    for name in ("standing", "start", "left_step", "right_step", "stop"):
        assert name in listed
    assert cli("phases", clip, "-o", table).exit_code == 0
    written = read_phases(table)["ada_walk_01"]
    assert written[0] == (0.0, "standing")
    assert [begin for begin, _ in written] == sorted(begin for begin, _ in written)
    path = tmp_path / "m.smmodel"
    write_phases(table, {"ada_walk_01": [(0.0, "standing"), (1.0, "jump")]})
    cli("train", clip, "--method", "eom2014", "-o", path, "--phases", table, "--set",
        "iterations=2")  # fmt: skip
    phases = np.asarray(read_model(path).tensor("type0.phases"))
    assert (phases[:30] == PHASES.index("standing")).all()
    assert (phases[30:] == PHASES.index("jump")).all()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("clip,time,phase\n", ":1: the first line must be clip,begin_s,phase"),
        ("clip,begin_s,phase\nwalk,0\n", ":2: expected clip,begin_s,phase, got 2 fields"),
        ("clip,begin_s,phase\nwalk,x,jump\n", ":2: 'x' is no time in s"),
        ("clip,begin_s,phase\nwalk,-1,jump\n", ":2: '-1' is no time in s"),
    ],
)
def test_a_wrong_table_of_phases_names_its_line(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "phases.csv"
    path.write_text(text)
    with pytest.raises(FormatError) as error:
        read_phases(path)
    assert said in str(error.value)


def test_phases_of_other_clips_or_names_are_refused(
    library: Path, walk: Motion, tmp_path: Path, cli: Cli
) -> None:
    table, path = tmp_path / "phases.csv", tmp_path / "m.smmodel"
    write_phases(table, {"run": [(0.0, "standing")]})
    done = cli("train", library / "ada_walk_01.bvh", "--method", "eom2014", "-o", path, "--phases",
               table)  # fmt: skip
    assert "no clip has the name run" in str(done.output)
    clip = TrainingClip("walk", walk, segments=[(0.0, "hop")])
    assert clip.segments == [(0.0, "hop")]
    with pytest.raises(ConfigError, match="one named 'hop'; choose from standing, left_step"):
        train("eom2014", [clip], options=FEW)
    with pytest.raises(ConfigError, match="path_regression does not divide clips into phases"):
        clip_segments("path_regression", clip)


def test_the_latent_space_is_laid_out_with_its_phases(
    model: Model, walk: Motion, tmp_path: Path, cli: Cli
) -> None:
    [shown] = latent_maps(model)
    X = np.asarray(model.tensor("type0.latent"))
    assert shown.points.shape == (len(X), 2)
    # No other plane keeps more of the points' spread.
    values = np.sort(np.linalg.eigvalsh(np.cov(X.T)))[::-1]
    assert np.trace(np.cov(shown.points.T)) == pytest.approx(values[:2].sum(), rel=1e-6)
    np.testing.assert_allclose(shown.placed(X), shown.points, atol=1e-9)
    take, picture, path = tmp_path / "take.csv", tmp_path / "latent.png", tmp_path / "m.smmodel"
    write_take(take, simulated(walk, [SITE], 100.0))
    sparse_mocap.write_model(path, model)
    assert cli("latent", path, "-o", picture, "--take", take).exit_code == 0
    assert picture.read_bytes().startswith(b"\x89PNG")
    with pytest.raises(ConfigError, match="a model of 'held_pose' has no latent space"):
        latent_maps(Model("held_pose"))


@contextmanager
def sending(port: int, record: SensorRecord) -> Iterator[None]:
    """An app that sends a line for each sample by UDP, at uneven times."""
    over, random = threading.Event(), np.random.default_rng(2)
    assert record.angular_velocity is not None
    turning = record.angular_velocity

    def send() -> None:
        begin = time.perf_counter()
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            while not over.is_set():
                now = time.perf_counter() - begin
                row = int(100.0 * now) % len(record.times_s)
                values = (now, *record.specific_force[row], *turning[row])
                line = ",".join(f"{value:.6g}" for value in values) + "\n"
                sender.sendto(line.encode(), ("127.0.0.1", port))
                time.sleep(random.uniform(0.005, 0.02))

    thread = threading.Thread(target=send)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


@pytest.mark.skipif(sys.platform == "win32", reason="a capture ends otherwise there")
def test_a_phone_streams_by_udp(
    model: Model, walk: Motion, tmp_path: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch
) -> None:
    runtime = tmp_path / "runtime"
    runtime.mkdir(mode=0o700)
    monkeypatch.setenv(FOLDER_VARIABLE, str(runtime))
    path, positions = tmp_path / "m.smmodel", tmp_path / "live.csv"
    sparse_mocap.write_model(path, model)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        port = int(probe.getsockname()[1])
    with sending(port, simulated(walk, [SITE], 100.0).sensors[SITE]):
        done = cli("live", "--port", f"udp://127.0.0.1:{port}", "--driver", "text_line", "--option",
                   "columns=time,ax,ay,az,gx,gy,gz", "--option", "time_unit=s", "--option",
                   "angular_velocity_unit=rad/s", "--sites", SITE, "--method", "eom2014", "--model",
                   path, "--positions", positions, "--seconds", "3")  # fmt: skip
    assert done.exit_code == 0, done.output
    assert "poses; sensors match" in done.output
    assert len(read_positions(positions)[0]) > 20


def test_live_readings_without_gravity_end_in_a_line(model: Model, walk: Motion) -> None:
    record = simulated(walk, [SITE], 100.0).sensors[SITE]
    free = record.specific_force - record.specific_force.mean(axis=0)
    take = Take({SITE: SensorRecord(record.times_s, free, record.angular_velocity)})
    with pytest.raises(ConfigError, match="no gravity in them"):
        reconstruct(take, method="eom2014", model=model)


def test_live_poses_follow_after_the_lag(model: Model, walk: Motion) -> None:
    take = simulated(walk, [SITE], 100.0)
    found = reconstruct(take, method="eom2014", model=model, options={"lag_ms": 200})
    assert found.latency_s == pytest.approx(0.2 + 0.0345, abs=0.002)
    assert error_cm(np.asarray(found.motion.joint_positions("heading")), walk) < 3.0
    assert any("misfit of the readings" in note for note in found.notes)


def test_a_phone_that_tells_g_is_understood_live(model: Model, walk: Motion) -> None:
    """The first second passes until it is noticed."""
    record = simulated(walk, [SITE], 100.0).sensors[SITE]
    told = Take({SITE: SensorRecord(record.times_s, -record.specific_force / 9.80665,
                                    record.angular_velocity)})  # fmt: skip
    found = reconstruct(told, method="eom2014", model=model)
    assert any("the sign of an iPhone" in note for note in found.notes)
    positions = np.asarray(found.motion.joint_positions("heading"))
    late = walk.trimmed(round(2.0 / walk.frame_time_s), walk.num_frames)
    assert error_cm(positions[60:], late) < 4.0


def test_the_body_turns_as_the_performer_does(model: Model, walk: Motion) -> None:
    """The model's clip goes straight on; the performer walks a curve."""
    yaw = 0.5 * walk.frame_time_s * np.arange(walk.num_frames)
    zero = np.zeros_like(yaw)
    turn = np.stack([np.cos(yaw / 2), zero, np.sin(yaw / 2), zero], axis=1)
    rotations, places = np.array(walk.rotations), np.array(walk.root_positions)
    rotations[:, 0] = product(turn, rotations[:, 0])
    x, z = places[:, 0].copy(), places[:, 2].copy()
    places[:, 0] = np.cos(yaw) * x + np.sin(yaw) * z
    places[:, 2] = -np.sin(yaw) * x + np.cos(yaw) * z
    curved = Motion(walk.skeleton, walk.frame_time_s, places, rotations)
    wanted = heading_change_rad(curved)
    assert wanted > 1.0
    for best_quality in (True, False):
        take = simulated(curved, [SITE], 100.0)
        found = reconstruct(take, method="eom2014", model=model, best_quality=best_quality)
        assert heading_change_rad(found.motion) == pytest.approx(wanted, abs=0.2 * wanted)


def heading_change_rad(motion: Motion) -> float:
    names = list(motion.skeleton.names)
    ends = np.asarray(motion.joint_positions("world"))
    left, right = (ends[:, names.index(name)] for name in ("lhipjoint", "rhipjoint"))
    yaw = np.unwrap(headings_rad(left, right))
    return float(yaw[-1] - yaw[0])
