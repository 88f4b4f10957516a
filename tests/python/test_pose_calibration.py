# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration by held poses: the take, the file, the command, and what it does for liu2011."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from held_poses import SITES, ideal, performer, planted, recorded, spans
from numpy.typing import NDArray
from sparse_mocap import (
    ConfigError,
    MotionDatabase,
    Take,
    body_of_height,
    read_body,
    read_model,
    reconstruct,
    standard_joint_names,
    write_take,
)
from sparse_mocap.calibration import Calibration, CalibrationError
from sparse_mocap.calibration_file import read_calibration, write_calibration
from sparse_mocap.cli.app import run
from sparse_mocap.evaluation import excluded_clips, performed
from sparse_mocap.pose_calibration import PoseCalibration, calibrate_by_poses
from sparse_mocap.readings import SensorInput, all_readings

TIMES = (0.5, 0.5, 0.5)
CLIP = "ada_walk_01"

Floats = NDArray[np.float64]


@pytest.fixture(scope="module")
def take() -> Take:
    return recorded(*TIMES)


@pytest.fixture(scope="module")
def found(take: Take) -> PoseCalibration:
    return calibrate_by_poses(take, spans(*TIMES), performer="made up")


def angle_deg(R: Floats) -> float:
    return float(np.degrees(np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1))))


def length_of(bones: Floats, name: str) -> float:
    return float(np.linalg.norm(bones[list(standard_joint_names()).index(name)]))


def test_mountings_and_offsets_are_found(found: PoseCalibration) -> None:
    trackers = planted()
    for index, site in enumerate(SITES):
        sensor = found.calibration.sensors[site]
        assert angle_deg(sensor.R_site_sensor @ trackers.matrices()[index].T) < 3.0
        assert sensor.is_mounting_determined
        assert sensor.scale == pytest.approx(1.0, abs=1e-3)
    assert np.linalg.norm(found.calibration.sensors["torso"].offset_m - trackers.offset_m[5]) < 0.03


def test_bones_that_the_poses_tell_are_found(found: PoseCalibration) -> None:
    medium = body_of_height(1.75).bones
    for name in ("lfemur", "rfemur", "lhumerus", "rhumerus"):
        assert name not in found.undetermined_bones
        wanted = length_of(performer().bones, name)
        assert length_of(found.body.bones, name) == pytest.approx(wanted, abs=0.015)
        assert abs(length_of(medium, name) - wanted) > 0.015
    assert {"ltibia", "head"} <= set(found.undetermined_bones)
    assert any("length of" in note and "ltibia" in note for note in found.notes)
    assert found.imitation_deg < 2.5
    assert max(missed for _, missed in found.missed_deg) < 3.0


def test_a_performer_who_misses_the_poses_is_noticed() -> None:
    missed = calibrate_by_poses(recorded(*TIMES, missed_deg=5.0), spans(*TIMES))
    assert 2.5 < missed.imitation_deg < 8.0
    for index, site in enumerate(SITES):
        R = missed.calibration.sensors[site].R_site_sensor
        assert angle_deg(R @ planted().matrices()[index].T) < 10.0


def test_positions_are_seen_from_where_trackers_should_sit(take: Take) -> None:
    """Whatever the straps: as trackers would say that sit where they should."""
    trackers = planted()

    def positions(worn: Take, is_known: bool) -> Floats:
        inputs = [
            SensorInput(
                site, ["specific_force", "orientation", "position"],
                R_site_sensor=trackers.matrices()[index] if is_known else None,
                offset_m=trackers.offset_m[index] if is_known else None,
            )
            for index, site in enumerate(SITES)
        ]  # fmt: skip
        return np.asarray(all_readings(worn, inputs, 25.0).position)

    wanted = positions(ideal(*TIMES), False)
    np.testing.assert_allclose(positions(take, True), wanted, atol=1e-3)
    assert np.nanmean(np.abs(positions(take, False) - wanted)) > 0.01


def test_alike_poses_are_said(take: Take) -> None:
    same = [spans(*TIMES)[0]] * 4
    alike = calibrate_by_poses(take, same)
    assert any("too alike" in note for note in alike.notes)
    assert any("left_hand: where it sits" in note for note in alike.notes)


def test_what_does_not_calibrate_is_refused(take: Take) -> None:
    first = spans(*TIMES)[0]
    with pytest.raises(CalibrationError, match=r"left_hand: arms_out from 900 .* holds 0 samples"):
        calibrate_by_poses(take, [("arms_out", (900.0, 901.0))])
    with pytest.raises(CalibrationError, match=r"(cm|degrees) during arms_forward; hold"):
        calibrate_by_poses(take, [("arms_forward", (first[1][1], first[1][1] + 0.5))])
    with pytest.raises(ConfigError, match=r"unknown calibration pose 'handstand'.*arms_out"):
        calibrate_by_poses(take, [("handstand", first[1])])
    with pytest.raises(CalibrationError, match="no pose was held"):
        calibrate_by_poses(take, [])
    blind = {
        name: replace(record, orientation=None, position=None)
        for name, record in take.sensors.items()
    }
    with pytest.raises(CalibrationError, match="gives neither orientation nor position"):
        calibrate_by_poses(Take(blind), [first])


def test_the_file_keeps_where_trackers_sit(found: PoseCalibration, tmp_path: Path) -> None:
    write_calibration(tmp_path / "trackers.json", found.calibration)
    again = read_calibration(tmp_path / "trackers.json")
    for site in SITES:
        np.testing.assert_array_equal(
            again.sensors[site].offset_m, found.calibration.sensors[site].offset_m
        )
    assert again.body is not None
    np.testing.assert_array_equal(again.body.bones, found.body.bones)
    older = (
        (tmp_path / "trackers.json")
        .read_text()
        .replace('"format_version": 3', '"format_version": 2')
    )
    (tmp_path / "older.json").write_text(older)
    assert read_calibration(tmp_path / "older.json").sensors.keys() == again.sensors.keys()


def test_the_command_writes_calibration_and_body(take: Take, library: Path, tmp_path: Path) -> None:
    write_take(tmp_path / "poses.csv", take)
    poses = [f"--pose={name}={begin}:{end}" for name, (begin, end) in spans(*TIMES)]
    command = ["calibrate-poses", str(tmp_path / "poses.csv"), *poses]
    files = ["-o", str(tmp_path / "trackers.json"), "--body", str(tmp_path / "body.json")]
    assert run([*command, *files]) == 0
    assert set(read_calibration(tmp_path / "trackers.json").sensors) == set(SITES)
    wanted = length_of(performer().bones, "lfemur")
    assert length_of(read_body(tmp_path / "body.json").bones, "lfemur") == pytest.approx(
        wanted, abs=0.015
    )
    assert run([*command[:-8], "--pose=handstand=1:2", *files]) == 2


def test_bone_lengths_are_trained(
    library: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["train", str(library), "--method=liu2011", "-o", str(tmp_path / "b.smmodel")]) == 1
    assert "three people or more" in capsys.readouterr().err
    few = {"bone_lengths.mean": np.ones(20), "bone_lengths.modes": np.zeros((20, 2))}
    from sparse_mocap import Model, write_model

    write_model(tmp_path / "few.smmodel", Model("liu2011", few))
    with pytest.raises(ValueError, match=r"bone_lengths\.deviation"):
        calibrate_by_poses(
            recorded(*TIMES), spans(*TIMES), model=read_model(tmp_path / "few.smmodel")
        )


def test_calibrated_trackers_tell_the_movement(
    database: MotionDatabase, library: Path, found: PoseCalibration
) -> None:
    performance = performed(library / f"{CLIP}.bvh", sites=SITES)
    clips = [clip.name for clip in database.clips]

    def errors_cm(take: Take, calibration: Calibration | None) -> float:
        solved = reconstruct(
            take,
            database,
            method="liu2011",
            calibration=calibration,
            body=performance.motion.skeleton,
            excluded_clips=excluded_clips(database.clips, clips.index(CLIP), 1),
        )
        truth = np.asarray(performance.motion.resampled(solved.rate_hz).joint_positions("heading"))
        ours = np.asarray(solved.motion.without_extremities().joint_positions("heading"))
        count = min(len(truth), len(ours))
        return float(100 * np.linalg.norm(ours[:count] - truth[:count], axis=-1).mean())

    worn = planted().worn(performance.seen(dict.fromkeys(SITES, (
        "specific_force", "angular_velocity", "orientation", "position",
    ))))  # fmt: skip
    calibrated_cm = errors_cm(worn, found.calibration)
    assert calibrated_cm < 1.5
    assert calibrated_cm < 0.5 * errors_cm(worn, None)
