# SPDX-License-Identifier: GPL-3.0-or-later
"""Bodies and movements of every kind on the standard skeleton, and what databases take of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from made_bvh import PERSON, bvh, changed, walking
from sparse_mocap import (
    FormatError,
    MotionDatabase,
    add_to_database,
    build_database,
    read_motion,
)
from sparse_mocap.inspection import Inspection, inspect_motion
from test_read_options import AMC, ASF

Cli = Callable[..., Result]


def inspected(folder: Path, text: str, name: str = "walk.bvh") -> Inspection:
    path = folder / name
    path.write_text(text)
    inspection = inspect_motion(path)
    assert inspection.refusal is None, inspection.refusal
    return inspection


def limb_cm(inspection: Inspection, limb: str) -> float:
    """The length of a standard bone, cm."""
    assert inspection.standard is not None
    skeleton = inspection.standard.skeleton
    return 100.0 * float(np.linalg.norm(skeleton.bones[skeleton.names.index(limb)]))


# --- Bodies --------------------------------------------------------------------------------------

ANKLE_AND_FOOT = {
    "smpl": ("left_knee", "left_ankle", "left_foot", "right_knee", "right_ankle", "right_foot"),
    "kinect": ("KneeLeft", "AnkleLeft", "FootLeft", "KneeRight", "AnkleRight", "FootRight"),
    "second life": ("mKneeLeft", "mAnkleLeft", "mFootLeft", "mKneeRight", "mAnkleRight",
                    "mFootRight"),
}  # fmt: skip


@pytest.mark.parametrize("kind", ANKLE_AND_FOOT)
def test_a_shank_ends_at_the_ankle(tmp_path: Path, kind: str) -> None:
    left_knee, left_ankle, left_foot, right_knee, right_ankle, right_foot = ANKLE_AND_FOOT[kind]
    names = {"LeftKnee": left_knee, "LeftAnkle": left_ankle, "RightKnee": right_knee,
             "RightAnkle": right_ankle}  # fmt: skip
    joints = (*changed(names=names), (left_foot, left_ankle, (0.0, -6.0, 13.0)),
              (right_foot, right_ankle, (0.0, -6.0, 13.0)))  # fmt: skip
    inspection = inspected(tmp_path, bvh(joints))
    assert inspection.mapping is not None
    assert inspection.mapping.joints["lfoot"] == left_ankle
    assert inspection.mapping.joints["rfoot"] == right_ankle
    assert limb_cm(inspection, "ltibia") == pytest.approx(40.0, abs=0.1)
    assert inspection.worst_error_deg < 0.5


def test_a_wrong_ankle_is_seen_in_the_error_and_mapped_by_hand(tmp_path: Path) -> None:
    joints = (*PERSON, ("LeftToes", "LeftAnkle", (0.0, -6.0, 13.0)),
              ("RightToes", "RightAnkle", (0.0, -6.0, 13.0)))  # fmt: skip
    path = tmp_path / "a.bvh"
    path.write_text(bvh(joints))
    wrong = inspect_motion(path, {"lfoot": "LeftToes", "rfoot": "RightToes"})
    assert wrong.limb_errors_deg["ltibia"][0] > 10.0
    right = inspect_motion(path, {"lfoot": "LeftAnkle", "rfoot": "RightAnkle"})
    assert right.limb_errors_deg["ltibia"][0] < 0.5


def test_a_neck_below_the_shoulders(tmp_path: Path) -> None:
    low = {"Neck": (0.0, 3.0, 0.0), "Chest": (0.0, 10.0, 0.0), "Spine": (0.0, 4.0, 0.0),
           "Head": (0.0, 30.0, 0.0)}  # fmt: skip
    joints = [(name, parent, low.get(name, offset)) for name, parent, offset in PERSON]
    inspection = inspected(tmp_path, bvh(joints))
    assert inspection.mean_error_deg < 0.5


@pytest.mark.parametrize(
    ("scale", "unit"), [(0.0328, "feet"), (0.01, " m"), (0.1, "dm"), (10, "mm")]
)
def test_units_are_told_by_the_legs(tmp_path: Path, scale: float, unit: str) -> None:
    inspection = inspected(tmp_path, bvh(changed(scale=scale)))
    assert 0.6 < (limb_cm(inspection, "lfemur") + limb_cm(inspection, "ltibia")) / 100.0 < 1.1
    guesses = [w for w in inspection.warnings if "unit is taken as" in w]
    assert len(guesses) == 1
    assert unit in guesses[0]


def test_a_figure_of_no_unit_is_scaled_to_usual_legs(tmp_path: Path) -> None:
    inspection = inspected(tmp_path, bvh(changed(scale=0.0007)))
    assert limb_cm(inspection, "lfemur") + limb_cm(inspection, "ltibia") == pytest.approx(85.0)
    assert sum("scaled to legs of" in warning for warning in inspection.warnings) == 1


# --- Elbows and knees ----------------------------------------------------------------------------


@pytest.mark.parametrize("direction_deg", range(-180, 180, 30))
@pytest.mark.parametrize(
    ("joint", "along", "limb"),
    [("LeftElbow", "x", "lradius"), ("RightElbow", "x", "rradius"), ("LeftKnee", "y", "ltibia"),
     ("RightKnee", "y", "rtibia")],
)  # fmt: skip
def test_limbs_that_bend_across_the_hinge_keep_their_direction(
    tmp_path: Path, joint: str, along: str, limb: str, direction_deg: float
) -> None:
    """The limb bends by up to 80 degrees towards every side, and back."""
    frames = []
    for t in range(41):
        bend = 80.0 * np.sin(np.pi * t / 40)
        a = bend * np.cos(np.radians(direction_deg))
        b = bend * np.sin(np.radians(direction_deg))
        angles = (a, 0.0, b) if along == "x" else (a, b, 0.0)
        frames.append(((0.0, 94.0, 0.0), {joint: angles}))
    inspection = inspected(tmp_path, bvh(frames=frames))
    mean, worst = inspection.limb_errors_deg[limb]
    assert mean < 1.0
    assert worst < 4.5


def test_a_limb_that_bends_all_around_turns_steadily(tmp_path: Path) -> None:
    frames = [
        ((0.0, 94.0, 0.0),
         {"LeftElbow": (50 * np.cos(a), 0.0, 50 * np.sin(a))})
        for a in np.linspace(0.0, 4.0 * np.pi, 200)
    ]  # fmt: skip
    inspection = inspected(tmp_path, bvh(frames=frames))
    assert inspection.limb_errors_deg["lradius"][1] < 1.5
    assert inspection.standard is not None
    upper = inspection.standard.skeleton.names.index("lhumerus")
    turns = inspection.standard.rotations[:, upper]
    steps = np.abs((turns[1:] * turns[:-1]).sum(1)).clip(0.0, 1.0)
    assert np.degrees(2.0 * np.arccos(steps)).max() < 12.0


def test_a_thigh_that_a_file_turns_half_round_where_the_knee_bends_far_is_turned_back(
    tmp_path: Path,
) -> None:
    frames = []
    for knee in 150.0 * np.sin(np.pi * np.arange(60) / 59):
        way = -1.0 if knee > 110.0 else 1.0  # the same pose, the knee bent the other way
        thigh = (0.0, -0.5 * knee, 180.0 if way < 0.0 else 0.0)
        frames.append(((0.0, 94.0, 0.0), {"LeftHip": thigh, "LeftKnee": (0.0, way * knee, 0.0)}))
    inspection = inspected(tmp_path, bvh(frames=frames))
    assert inspection.limb_errors_deg["ltibia"][1] < 1.5
    assert inspection.standard is not None
    upper = inspection.standard.skeleton.names.index("lfemur")
    turns = inspection.standard.rotations[:, upper]
    steps = np.abs((turns[1:] * turns[:-1]).sum(1)).clip(0.0, 1.0)
    assert np.degrees(2.0 * np.arccos(steps)).max() < 12.0


def test_a_straight_knee_that_trembles_does_not_twist(tmp_path: Path) -> None:
    random = np.random.default_rng(4)
    frames = [
        ((0.0, 94.0, 0.0), {"LeftKnee": tuple(random.normal(0.0, 1.0, 3))}) for _ in range(100)
    ]
    inspection = inspected(tmp_path, bvh(frames=frames))
    assert inspection.standard is not None
    upper = inspection.standard.skeleton.names.index("lfemur")
    turns = inspection.standard.rotations[:, upper]
    straight = turns[0]  # which the first frame nearly is
    assert np.degrees(2.0 * np.arccos(np.abs(turns @ straight).clip(0.0, 1.0))).max() < 8.0


# --- The world -----------------------------------------------------------------------------------


def _up(inspection: Inspection) -> float:
    """The least height of the head above the hips, m."""
    assert inspection.standard is not None
    points = inspection.standard.joint_positions("world")
    names = inspection.standard.skeleton.names
    return float((points[:, names.index("head"), 1] - points[:, names.index("root"), 1]).min())


def test_a_root_that_carries_the_turn_of_the_axes_is_stood_up(tmp_path: Path) -> None:
    z_up = walking(lambda ahead, up: ((0.0, -ahead, up), {"Hips": (0.0, 90.0, 0.0)}))
    upside_down = walking(lambda ahead, up: ((0.0, -up, -ahead), {"Hips": (0.0, 180.0, 0.0)}))
    for text, axis in ((z_up, "+z"), (upside_down, "-y")):
        inspection = inspected(tmp_path, text)
        assert _up(inspection) > 0.4
        assert any(f"stands along {axis}" in warning for warning in inspection.warnings)


def test_who_lies_on_the_floor_stays_there(tmp_path: Path) -> None:
    lying = walking(lambda ahead, up: ((0.0, 14.0, 0.1 * ahead), {"Hips": (0.0, -90.0, 0.0)}))
    inspection = inspected(tmp_path, lying)
    assert _up(inspection) < 0.3
    assert any("lies in every frame" in warning for warning in inspection.warnings)


# --- What does not get into a database unseen ----------------------------------------------------


def crossed() -> str:
    """A person whose arms are named after the other side."""
    other = {"LeftShoulder": "RightShoulder", "RightShoulder": "LeftShoulder",
             "LeftElbow": "RightElbow", "RightElbow": "LeftElbow", "LeftWrist": "RightWrist",
             "RightWrist": "LeftWrist"}  # fmt: skip
    return bvh(changed(names=other), [((0.0, 94.0, float(t)), {}) for t in range(40)])


def test_a_build_says_what_is_doubtful_the_worst_first(cli: Cli, tmp_path: Path) -> None:
    folder = tmp_path / "in"
    folder.mkdir()
    (folder / "a_walk.bvh").write_text(walking())
    lying = walking(lambda ahead, up: ((0.0, 14.0, 0.1 * ahead), {"Hips": (0.0, -90.0, 0.0)}))
    (folder / "b_lie.bvh").write_text(lying)
    jumping = bvh(
        frames=[((0.0, 94.0 + 60.0 * abs(np.sin(0.2 * t)), 0.0), {}) for t in range(60)],
        frame_time="0.0083333",
    )
    (folder / "c_jump.bvh").write_text(jumping)
    (folder / "d_crossed.bvh").write_text(crossed())
    report = build_database([folder], tmp_path / "db.smdb")
    assert [Path(path).name for path, _ in report.doubtful] == ["c_jump.bvh", "b_lie.bvh"]
    assert "times gravity" in report.doubtful[0][1]
    assert "lies in every frame" in report.doubtful[1][1]
    ((path, reason),) = report.skipped
    assert Path(path).name == "d_crossed.bvh"
    assert "left arm is on the side of the right leg" in reason
    assert len({clip.source for clip in MotionDatabase(tmp_path / "db.smdb").clips}) == 3
    result = cli("database", "build", folder, "-o", tmp_path / "strict.smdb", "--strict")
    assert result.exit_code == 1
    assert "lies in every frame" in result.stderr
    assert not (tmp_path / "strict.smdb").exists()


# --- Rates and units that files do not say -------------------------------------------------------


def test_rate_unit_axis_and_skeleton_by_command(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "a.asf").write_text(ASF)
    (tmp_path / "b_1.amc").write_text(AMC + "2\nroot 0 0 0 0 0 0\nup 80\n")
    (tmp_path / "a2.asf").write_text(ASF)
    result = cli("convert", tmp_path / "b_1.amc", "-o", tmp_path / "b.bvh",
                 "--asf", tmp_path / "a.asf", "--rate", "60", "--unit", "dm")  # fmt: skip
    assert result.exit_code == 0, result.output
    motion, _ = read_motion(tmp_path / "b.bvh")
    assert motion.frame_time_s == pytest.approx(1 / 60)
    assert motion.root_positions[0] == pytest.approx([0.1, 0.2, 0.3])
    assert (
        cli("convert", tmp_path / "b.bvh", "-o", tmp_path / "c.bvh", "--unit", "x").exit_code == 2
    )


def test_the_rate_of_each_file_in_the_table(cli: Cli, tmp_path: Path) -> None:
    folder = tmp_path / "in"
    folder.mkdir()
    for name in ("01_01.bvh", "01_02.bvh"):
        (folder / name).write_text(walking(num_frames=60 if name == "01_01.bvh" else 90))
    (folder / "metadata.csv").write_text("file,rate_hz\n01_01,60\n")
    build_database([folder], tmp_path / "db.smdb", tempo_copies=())
    rates = {
        clip.source: clip.source_rate_hz for clip in MotionDatabase(tmp_path / "db.smdb").clips
    }
    assert rates == {"01_01.bvh": pytest.approx(60), "01_02.bvh": pytest.approx(30, abs=0.01)}
    index = tmp_path / "index.csv"
    index.write_text(
        '"Subject","Trial #","Motion Description","framerate","Frames 60fps","Status"\n'
        '1,1,"walk, slowly",60,30,"Centered"\n1,2,"stroll",120,45,""\n77,1,"elsewhere",60,1,""\n'
    )
    result = cli("database", "build", folder, "-o", tmp_path / "cmu.smdb", "--metadata", index,
                 "--no-tempo-copies")  # fmt: skip
    assert result.exit_code == 0, result.output
    assert "77_01" not in result.stderr
    by_source = {clip.source: clip for clip in MotionDatabase(tmp_path / "cmu.smdb").clips}
    assert by_source["01_01.bvh"].motion_class == "walk, slowly"
    assert by_source["01_02.bvh"].source_rate_hz == pytest.approx(120)
    (folder / "metadata.csv").write_text("file,rate_hz\n01_01,fast\n")
    with pytest.raises(FormatError, match="rate_hz is"):
        add_to_database(tmp_path / "db.smdb", [folder])
