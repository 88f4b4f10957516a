# SPDX-License-Identifier: GPL-3.0-or-later
"""The generated motion, judged from the written files alone by a reader of its own."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pytest
from sparse_mocap.demo_motions import generate_library, generate_performance

RATE = 60.0
ELBOW = np.array([0.0, -np.sqrt(0.75), 0.5])
SIDES = ("Left", "Right")
PEAKS = {  # m/s^2: ankles, wrists
    "walk": (40.0, 25.0),
    "jog": (60.0, 45.0),
    "turn": (20.0, 15.0),
    "kick": (60.0, 20.0),
    "jack": (45.0, 80.0),
    "reach": (5.0, 25.0),
    "squat": (0.5, 15.0),
    "armcircle": (0.5, 30.0),
    "armswing": (0.5, 45.0),
    "idle": (0.5, 10.0),
    "performance": (60.0, 60.0),
}


@dataclass(frozen=True)
class Bvh:
    """One file: joints in order (the ends of open bones after their joint, as ``<joint>End``)."""

    name: str
    joints: list[str]
    parents: list[int]
    offsets: np.ndarray
    channels: list[list[str]]
    frame_time: float
    values: np.ndarray

    def at(self, joint: str) -> int:
        return self.joints.index(joint)

    @cached_property
    def columns(self) -> dict[str, slice]:
        ends = np.cumsum([len(c) for c in self.channels])
        return {
            j: slice(e - len(c), e)
            for j, c, e in zip(self.joints, self.channels, ends, strict=True)
        }

    @cached_property
    def local(self) -> np.ndarray:
        result = np.tile(np.eye(3), (len(self.values), len(self.joints), 1, 1))
        for i, (joint, names) in enumerate(zip(self.joints, self.channels, strict=True)):
            for name, angle in zip(names, self.values[:, self.columns[joint]].T, strict=True):
                if name.endswith("rotation"):
                    result[:, i] = result[:, i] @ axis_rotation(name[0], np.radians(angle))
        return result

    @cached_property
    def world(self) -> tuple[np.ndarray, np.ndarray]:
        rotations, places = self.local.copy(), np.tile(self.offsets, (len(self.values), 1, 1))
        places[:, 0] += self.values[:, :3]
        for i, parent in enumerate(self.parents):
            if parent >= 0:
                rotations[:, i] = rotations[:, parent] @ self.local[:, i]
                step = rotations[:, parent] @ self.offsets[i]
                places[:, i] = places[:, parent] + step
        return places, rotations

    def place(self, joint: str) -> np.ndarray:
        return self.world[0][:, self.at(joint)]

    def acceleration(self, joint: str) -> np.ndarray:
        """Magnitude in m/s^2, by differences."""
        return np.linalg.norm(np.diff(self.place(joint), 2, axis=0), axis=1) * RATE**2 / 100.0

    def angle(self, joint: str, axis: np.ndarray) -> tuple[np.ndarray, float]:
        """Signed angle (degrees) about ``axis``, and how far the joint turns off that axis."""
        local = self.local[:, self.at(joint)]
        skew = local - np.swapaxes(local, 1, 2)
        sine = 0.5 * np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1) @ axis
        cosine = 0.5 * (np.trace(local, axis1=1, axis2=2) - 1.0)
        return np.degrees(np.arctan2(sine, cosine)), float(np.abs(local @ axis - axis).max())


def axis_rotation(axis: str, angle: np.ndarray) -> np.ndarray:
    i, j = {"X": (1, 2), "Y": (2, 0), "Z": (0, 1)}[axis]
    result = np.tile(np.eye(3), (len(angle), 1, 1))
    result[:, i, i] = result[:, j, j] = np.cos(angle)
    result[:, j, i] = np.sin(angle)
    result[:, i, j] = -np.sin(angle)
    return result


def read(path: Path) -> Bvh:
    joints: list[str] = []
    parents: list[int] = []
    offsets: list[list[float]] = []
    channels: list[list[str]] = []
    stack: list[int] = []
    lines = iter(path.read_text(encoding="ascii").splitlines())
    for word, *rest in map(str.split, lines):
        if word in ("ROOT", "JOINT", "End"):
            joints.append(rest[0] if word != "End" else joints[stack[-1]] + "End")
            parents.append(stack[-1] if stack else -1)
            channels.append([])
        elif word == "{":
            stack.append(len(joints) - 1)
        elif word == "}":
            stack.pop()
        elif word == "OFFSET":
            offsets.append([float(x) for x in rest])
        elif word == "CHANNELS":
            channels[-1] = rest[1:]
        elif word == "MOTION":
            break
    count, frame_time = int(next(lines).split()[1]), float(next(lines).split()[2])
    values = np.array([[float(x) for x in line.split()] for line in lines])
    assert len(values) == count
    return Bvh(path.stem, joints, parents, np.array(offsets), channels, frame_time, values)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    return generate_library(tmp_path_factory.mktemp("library"))


@pytest.fixture(scope="module")
def library(files: list[Path]) -> dict[str, Bvh]:
    return {path.stem: read(path) for path in files}


@pytest.fixture(scope="module")
def performance(tmp_path_factory: pytest.TempPathFactory) -> Bvh:
    return read(generate_performance(tmp_path_factory.mktemp("stage") / "performance.bvh"))


@pytest.fixture(scope="module")
def motions(library: dict[str, Bvh], performance: Bvh) -> list[Bvh]:
    return [*library.values(), performance]


def kind(motion: Bvh) -> str:
    if "_" not in motion.name:
        return "performance"
    return motion.name.split("_")[1].removesuffix("left").removesuffix("right")


def soles(motion: Bvh) -> Iterator[np.ndarray]:
    """World paths of the tips of the toes and the ends of the heels."""
    for side in SIDES:
        toe = motion.offsets[motion.at(f"{side}FootEnd")]
        heel = np.array([0.0, toe[1], -toe[2] * 0.040 / 0.105])
        foot = motion.world[1][:, motion.at(f"{side}Foot")]
        for point in (toe, heel):
            yield motion.place(f"{side}Foot") + foot @ point


def contacts(path: np.ndarray, height: float = 0.1) -> Iterator[np.ndarray]:
    """The stretches of ``path`` nearer than ``height`` cm to the floor for at least 4 frames."""
    edges = np.flatnonzero(np.diff(np.r_[False, path[:, 1] < height, False].astype(int)))
    for start, end in edges.reshape(-1, 2):
        if end - start >= 4:
            yield path[start:end]


def test_library_has_the_promised_extent(library: dict[str, Bvh]) -> None:
    durations = np.array([len(clip.values) / RATE for clip in library.values()])
    assert 110 <= len(library) <= 140
    assert durations.min() >= 2.0
    assert durations.max() <= 6.0
    assert 300.0 <= durations.sum() <= 540.0
    assert {kind(clip) for clip in library.values()} == set(PEAKS) - {"performance"}
    assert len({name.split("_")[0] for name in library}) >= 5


def test_performance_is_long_enough_and_by_somebody_else(
    library: dict[str, Bvh], performance: Bvh
) -> None:
    assert 15.0 <= len(performance.values) / RATE <= 20.0
    bodies = [clip.offsets for clip in library.values()]
    assert all(np.abs(body - performance.offsets).max() > 0.5 for body in bodies)


def test_same_seed_same_bytes(files: list[Path], tmp_path: Path) -> None:
    again = generate_library(tmp_path / "again")
    assert [path.name for path in again] == [path.name for path in files]
    assert all(a.read_bytes() == b.read_bytes() for a, b in zip(again, files, strict=True))
    one, two, other = (
        generate_performance(tmp_path / name, seed=seed).read_bytes()
        for name, seed in (("1.bvh", 1), ("2.bvh", 1), ("3.bvh", 2))
    )
    assert one == two
    assert one != other


def test_progress_is_told_of_every_file(tmp_path: Path) -> None:
    told: list[tuple[int, int, str]] = []
    paths = generate_library(tmp_path, seed=3, progress=lambda *args: told.append(args))
    assert told == [(i + 1, len(paths), path.name) for i, path in enumerate(paths)]


def test_rest_pose_is_a_t_pose_facing_ahead(library: dict[str, Bvh]) -> None:
    clip = library["ada_walk_01"]
    rest = Bvh(
        "rest",
        clip.joints,
        clip.parents,
        clip.offsets,
        clip.channels,
        clip.frame_time,
        np.zeros((1, clip.values.shape[1])),
    )
    for side, sign in (("Left", 1.0), ("Right", -1.0)):
        arm = rest.place(f"{side}HandEnd")[0] - rest.place(f"{side}Arm")[0]
        leg = rest.place(f"{side}Foot")[0] - rest.place(f"{side}UpLeg")[0]
        foot = rest.place(f"{side}FootEnd")[0] - rest.place(f"{side}Foot")[0]
        assert arm[0] * sign > 50.0
        np.testing.assert_allclose(arm[1:], 0.0, atol=1e-9)
        np.testing.assert_allclose(leg[[0, 2]], 0.0, atol=1e-9)
        assert leg[1] < -70.0
        assert foot[2] > 10.0
    lengths = np.linalg.norm(clip.offsets, axis=1)
    at_root = {"Hips", "LHipJoint", "RHipJoint", "LowerBack"}
    assert {j for j, x in zip(clip.joints, lengths, strict=True) if x < 1.0} == at_root


def test_files_are_sixty_frames_a_second_with_root_position(motions: list[Bvh]) -> None:
    for motion in motions:
        assert motion.frame_time == pytest.approx(1.0 / RATE, abs=1e-6)
        rotation = ["Zrotation", "Yrotation", "Xrotation"]
        assert motion.channels[0] == ["Xposition", "Yposition", "Zposition", *rotation]
        assert all(c == rotation for c in motion.channels[1:] if c)


def test_everybody_starts_at_the_origin_facing_ahead(motions: list[Bvh]) -> None:
    for motion in motions:
        hips = motion.place("Hips")[0]
        ahead = motion.world[1][0, 0, :, 2]
        assert np.hypot(hips[0], hips[2]) < 5.0, motion.name
        assert ahead[2] > np.cos(np.radians(15.0)), motion.name


def test_hinges_turn_about_their_axes_alone(motions: list[Bvh]) -> None:
    x = np.array([1.0, 0.0, 0.0])
    for motion in motions:
        for side, sign in (("Left", 1.0), ("Right", -1.0)):
            knee, off_knee = motion.angle(f"{side}Leg", x)
            elbow, off_elbow = motion.angle(f"{side}ForeArm", sign * ELBOW)
            twist, off_twist = motion.angle(f"{side}Hand", x)
            assert max(off_knee, off_elbow, off_twist) < 1e-4, motion.name
            assert knee.min() > 5.0, motion.name
            assert knee.max() < 135.0, motion.name
            assert elbow.min() > 0.0, motion.name
            assert elbow.max() < 140.0, motion.name
            assert np.abs(twist).max() < 80.0, motion.name


def test_restricted_joints_keep_their_channels_at_zero(motions: list[Bvh]) -> None:
    for motion in motions:
        for side in SIDES:
            assert not motion.values[:, motion.columns[f"{side}Shoulder"]][:, 2].any()
            assert not motion.values[:, motion.columns[f"{side[0]}HipJoint"]].any()
            assert not motion.values[:, motion.columns[f"{side}Leg"]][:, :2].any()


def test_ankles_and_hips_stay_within_reach_of_a_person(motions: list[Bvh]) -> None:
    for motion in motions:
        for side in SIDES:
            down = motion.local[:, motion.at(f"{side}UpLeg")] @ np.array([0.0, -1.0, 0.0])
            sole = motion.local[:, motion.at(f"{side}Foot")]
            bend = np.degrees(np.arccos(0.5 * (np.trace(sole, axis1=1, axis2=2) - 1.0)))
            assert bend.max() < 60.0, motion.name
            assert np.degrees(np.arctan2(-down[:, 2], -down[:, 1])).max() < 35.0, motion.name
            assert np.degrees(np.arcsin(np.abs(down[:, 0]))).max() < 45.0, motion.name


def test_soles_neither_sink_nor_slide(motions: list[Bvh]) -> None:
    for motion in motions:
        for path in soles(motion):
            assert path[:, 1].min() > -0.02, motion.name
            for contact in contacts(path):
                extent = np.ptp(contact[:, [0, 2]], axis=0)
                assert np.hypot(*extent) < 1.0, motion.name


def test_somebody_is_on_the_floor_unless_jumping(motions: list[Bvh]) -> None:
    for motion in motions:
        if kind(motion) not in ("jog", "jack", "performance"):
            lowest = np.min([path[:, 1] for path in soles(motion)], axis=0)
            assert lowest.max() < 0.1, motion.name


def test_joggers_fly(library: dict[str, Bvh]) -> None:
    for name in ("ada_jog_01", "bruno_jog_01", "chen_jogleft_01"):
        lowest = np.min([path[:, 1] for path in soles(library[name])], axis=0)
        assert np.mean(lowest > 0.3) > 0.1, name


def test_accelerations_are_those_of_people(motions: list[Bvh]) -> None:
    for motion in motions:
        ankles, wrists = PEAKS[kind(motion)]
        for side in SIDES:
            assert motion.acceleration(f"{side}Foot").max() < ankles, motion.name
            assert motion.acceleration(f"{side}Hand").max() < wrists, motion.name
            assert motion.acceleration(f"{side}Leg").max() < 80.0, motion.name
        assert motion.acceleration("Hips").max() < 15.0, motion.name
        assert motion.acceleration("HeadEnd").max() < 20.0, motion.name


def test_accelerations_have_no_kinks(motions: list[Bvh]) -> None:
    for motion in motions:
        for joint in ("Hips", "LeftHand", "RightHand", "HeadEnd"):
            jump = np.diff(motion.place(joint), 3, axis=0) * RATE**2 / 100.0
            assert np.linalg.norm(jump, axis=1).max() < 30.0, (motion.name, joint)


def test_left_and_right_takes_mirror_each_other(library: dict[str, Bvh]) -> None:
    pairs = [name for name in library if name.split("_")[1].endswith("left")]
    assert len(pairs) >= 25
    for name in pairs:
        left, right = library[name], library[name.replace("left_", "right_")]
        order = [left.at(opposite(joint)) for joint in right.joints]
        seen = left.world[0][:, order] * np.array([-1.0, 1.0, 1.0])
        np.testing.assert_allclose(right.world[0], seen, atol=0.01, err_msg=name)


def opposite(joint: str) -> str:
    if joint.startswith("Left"):
        return "Right" + joint[4:]
    if joint.startswith("Right"):
        return "Left" + joint[5:]
    return {"LHipJoint": "RHipJoint", "RHipJoint": "LHipJoint"}.get(joint, joint)


def test_arms_swing_against_the_legs(library: dict[str, Bvh]) -> None:
    for name in ("ada_walk_02", "bruno_walk_03", "dalia_jog_01"):
        clip = library[name]
        for side in SIDES:
            hand, foot = (
                (clip.place(side + j) - clip.place("Hips"))[:, 2] for j in ("Hand", "Foot")
            )
            assert np.corrcoef(hand, foot)[0, 1] < -0.6, name


def test_arms_stay_outside_the_trunk(motions: list[Bvh]) -> None:
    for motion in motions:
        low, high = motion.place("Hips"), motion.place("Neck")
        spine = high - low
        for joint in ("LeftHand", "RightHand", "LeftForeArm", "RightForeArm"):
            away = motion.place(joint) - low
            along = np.einsum("ni,ni->n", away, spine) / np.einsum("ni,ni->n", spine, spine)
            nearest = away - np.clip(along, 0.0, 1.0)[:, None] * spine
            assert np.linalg.norm(nearest, axis=1).min() > 12.0, (motion.name, joint)


def test_turns_and_curves_go_the_way_they_are_called(library: dict[str, Bvh]) -> None:
    for name, clip in library.items():
        ahead = clip.world[1][:, 0, :, 2]
        course = np.degrees(np.unwrap(np.arctan2(ahead[:, 0], ahead[:, 2])))
        if name.split("_")[1] in ("walkleft", "jogleft", "turnleft"):
            assert course[-1] - course[0] > 35.0, name
        elif not name.split("_")[1].endswith("right"):
            assert abs(course[-1] - course[0]) < 15.0, name
