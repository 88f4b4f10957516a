# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration against sensors whose mounting, scale and place are known.

The wearer is made of hinges in closed form, so that nothing here shares code with what it checks.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from scipy.spatial.transform import Rotation
from sparse_mocap import SensorRecord, Take, write_take
from sparse_mocap.calibration import (
    CalibrationError,
    Steps,
    apply,
    assign_by_shaking,
    calibrate,
    guided_movements,
    positions_along_bone,
)
from sparse_mocap.calibration_file import (
    CalibrationFileError,
    read_calibration,
    write_calibration,
)

UP = np.array([0.0, 1.0, 0.0])
BONES = {"wrist": 0.188, "ankle": 0.4214}  # m, of a wearer of 1.75 m
# Columns: the sites' axes in the world while the arms hang (x left, y up, z forward).
HANGING = {
    "left_wrist": ([0, -1, 0], [0, 0, -1], [1, 0, 0]),
    "right_wrist": ([0, -1, 0], [0, 0, 1], [-1, 0, 0]),
    "left_ankle": ([0, -1, 0], [1, 0, 0], [0, 0, 1]),
    "right_ankle": ([0, -1, 0], [1, 0, 0], [0, 0, 1]),
}
# In the world: elbows lift the forearm forward, squats take the knee forward over the ankle.
TURNS = {"wrist": np.array([-1.0, 0, 0]), "ankle": np.array([1.0, 0, 0])}
STILL = {"wrist": 0.0, "ankle": 1.0}
SPANS = {"wrist": (4.0, 12.0), "ankle": (13.0, 21.0)}
STEPS = Steps((0.0, 3.0), (("bend_elbows", SPANS["wrist"]), ("squat", SPANS["ankle"])))


def bend(times: np.ndarray, span: tuple[float, float], size_rad: float) -> np.ndarray:
    inside = (times >= span[0]) & (times < span[1])
    return np.where(inside, size_rad * 0.5 * (1 - np.cos(2 * np.pi * 0.5 * (times - span[0]))), 0)


def hinge(site: str, place: float, size_rad: float, rate_hz: float = 100.0) -> SensorRecord:
    """What an ideal sensor at the site reads."""
    part = site.split("_")[1]
    fine = np.arange(-1, 22.0 * 1000 + 2) / 1000
    angles = bend(fine, SPANS[part], size_rad)
    turn = Rotation.from_rotvec(angles[:, None] * TURNS[part])
    axes = turn * Rotation.from_matrix(np.array(HANGING[site]).T)
    lever = (place - STILL[part]) * BONES[part]
    position = axes.apply([lever, 0.02, 0.03])
    acceleration = (position[2:] - 2 * position[1:-1] + position[:-2]) * 1000**2
    force = axes[1:-1].inv().apply(acceleration + 9.81 * UP)
    rate = (axes[:-1].inv() * axes[1:]).as_rotvec()[1:] * 1000
    keep = slice(0, None, round(1000 / rate_hz))
    orientation = axes[1:-1].as_quat()[:, [3, 0, 1, 2]]
    return SensorRecord(fine[1:-1][keep], force[keep], rate[keep], orientation[keep])


def worn(
    record: SensorRecord, R_site_sensor: Rotation, scale: float, noise: float, seed: int
) -> SensorRecord:
    rng = np.random.default_rng(seed)
    back = R_site_sensor.inv()
    force = back.apply(record.specific_force)
    force += noise * rng.normal(size=force.shape)
    assert record.angular_velocity is not None
    turn = back.apply(record.angular_velocity) + 0.02 * noise * rng.normal(size=force.shape)
    turn += np.array([0.02, -0.01, 0.015]) * (noise > 0)
    assert record.orientation is not None
    q = Rotation.from_quat(record.orientation[:, [1, 2, 3, 0]]) * R_site_sensor
    return SensorRecord(record.times_s, force / scale, turn, q.as_quat()[:, [3, 0, 1, 2]])


class Wearer:
    """A take of four sensors and the truth about them."""

    def __init__(self, turned_deg: float, noise: float, seed: int, size_rad: float = 1.2) -> None:
        rng = np.random.default_rng(seed)
        self.turns, self.scales, self.places, sensors = {}, {}, {}, {}
        self.ideal = {}
        for index, site in enumerate(HANGING):
            axis = rng.normal(size=3)
            axis /= np.linalg.norm(axis)
            self.turns[site] = Rotation.from_rotvec(np.radians(turned_deg) * axis)
            self.scales[site] = 1.0 + rng.uniform(-0.05, 0.05)
            self.places[site] = rng.uniform(0.3, 1.0) if "wrist" in site else rng.uniform(0.2, 0.8)
            size = size_rad * (1.0 if "wrist" in site else 0.6)
            self.ideal[site] = hinge(site, self.places[site], size)
            sensors[site] = worn(
                self.ideal[site], self.turns[site], self.scales[site], noise, seed + index
            )
        self.take = Take(sensors)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("turned_deg", "noise"), [(0.0, 0.0), (30.0, 0.0), (30.0, 0.15)])
def test_mounting_scale_and_place_are_recovered(turned_deg: float, noise: float, seed: int) -> None:
    wearer = Wearer(turned_deg, noise, seed)
    found = calibrate(wearer.take, STEPS)
    for site, sensor in found.sensors.items():
        off = wearer.turns[site].inv() * Rotation.from_matrix(sensor.R_site_sensor)
        assert np.degrees(off.magnitude()) < 3.0
        assert sensor.scale == pytest.approx(wearer.scales[site], rel=0.01)
        assert sensor.is_mounting_determined
        assert sensor.is_position_determined, sensor.notes
        assert sensor.position_along_bone == pytest.approx(wearer.places[site], abs=0.1)
        assert sensor.quality > 0.6
    assert found.notes == []


def test_places_refer_to_the_wearer_s_own_bones() -> None:
    """A body whose bones are a fifth longer brings every place nearer to the still point."""
    wearer = Wearer(10.0, 0.0, 2)
    tall = calibrate(wearer.take, STEPS, height_m=1.2 * 1.75)
    for site in ("left_wrist", "right_wrist"):
        assert tall.sensors[site].position_along_bone == pytest.approx(
            wearer.places[site] / 1.2, abs=0.05
        )
    for site in ("left_ankle", "right_ankle"):
        expected = 1 - (1 - wearer.places[site]) / 1.2
        assert tall.sensors[site].position_along_bone == pytest.approx(expected, abs=0.05)


def test_the_point_that_stayed_still_is_found_whatever_was_asked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Knees bent backwards instead of a squat, straight arms raised instead of elbows bent."""
    monkeypatch.setitem(STILL, "ankle", 0.0)
    monkeypatch.setitem(STILL, "wrist", -0.28 / BONES["wrist"])
    wearer = Wearer(20.0, 0.0, 7)
    for site, sensor in calibrate(wearer.take, STEPS).sensors.items():
        assert sensor.is_position_determined
        assert sensor.position_along_bone == pytest.approx(wearer.places[site], abs=0.1)


@pytest.mark.parametrize("seed", range(4))
def test_accelerations_alone_give_the_mounting_and_say_so_of_the_place(seed: int) -> None:
    wearer = Wearer(25.0, 0.15, seed)
    deaf = {site: replace(s, angular_velocity=None) for site, s in wearer.take.sensors.items()}
    found = calibrate(Take(deaf), STEPS)
    for site, sensor in found.sensors.items():
        off = wearer.turns[site].inv() * Rotation.from_matrix(sensor.R_site_sensor)
        assert np.degrees(off.magnitude()) < 5.0
        assert sensor.scale == pytest.approx(wearer.scales[site], rel=0.01)
        assert not sensor.is_position_determined
        assert any("takes a gyroscope" in note for note in sensor.notes)


def test_applied_a_calibration_gives_what_ideal_sensors_read() -> None:
    wearer = Wearer(30.0, 0.0, 3)
    found = calibrate(wearer.take, STEPS)
    told = apply(found, wearer.take)
    assert positions_along_bone(found, wearer.take) == [
        s.position_along_bone for s in found.sensors.values()
    ]
    for site, ideal in wearer.ideal.items():
        record = told.sensors[site]
        assert record.angular_velocity is not None
        assert record.orientation is not None
        assert ideal.angular_velocity is not None
        assert ideal.orientation is not None
        difference = np.linalg.norm(record.specific_force - ideal.specific_force, axis=1)
        assert np.percentile(difference, 95) < 0.6
        rate = np.linalg.norm(record.angular_velocity - ideal.angular_velocity, axis=1)
        assert np.percentile(rate, 95) < 0.2
        apart = Rotation.from_quat(record.orientation[:, [1, 2, 3, 0]]).inv() * Rotation.from_quat(
            ideal.orientation[:, [1, 2, 3, 0]]
        )
        assert np.degrees(apart.magnitude()).max() < 3.0


def test_a_movement_that_shows_no_axis_is_said_to_show_none() -> None:
    wearer = Wearer(20.0, 0.05, 1, size_rad=0.02)
    found = calibrate(wearer.take, STEPS)
    for sensor in found.sensors.values():
        assert not sensor.is_mounting_determined
        assert not sensor.is_position_determined
        assert any("do not determine how it is turned" in note for note in sensor.notes)
        assert sensor.quality < 0.3


def test_without_movements_gravity_is_still_put_right() -> None:
    wearer = Wearer(20.0, 0.0, 2)
    told = apply(calibrate(wearer.take, Steps((0.0, 3.0))), wearer.take)
    for record in told.sensors.values():
        np.testing.assert_allclose(
            record.specific_force[:200].mean(axis=0), [-9.81, 0, 0], atol=0.01
        )


def test_readings_in_g_are_recognised() -> None:
    wearer = Wearer(10.0, 0.0, 4)
    in_g = {
        site: replace(record, specific_force=record.specific_force / 9.81)
        for site, record in wearer.take.sensors.items()
    }
    told = apply(calibrate(Take(in_g), STEPS), Take(in_g))
    for record in told.sensors.values():
        assert np.linalg.norm(record.specific_force[:200].mean(axis=0)) == pytest.approx(9.81)


@pytest.mark.parametrize("factor", [0.8, 1.25, 0.12, 0.001])
def test_what_cannot_be_gravity_is_refused_with_its_number(factor: float) -> None:
    wearer = Wearer(10.0, 0.0, 5)
    site, record = next(iter(wearer.take.sensors.items()))
    wrong = {site: replace(record, specific_force=factor * record.specific_force)}
    reads = factor * 9.81 / wearer.scales[site]
    with pytest.raises(CalibrationError, match=f"{site}: at rest it reads {reads:.4g}"[:-1]):
        calibrate(Take(wrong), STEPS)


def test_a_wearer_who_moves_while_standing_is_told() -> None:
    wearer = Wearer(0.0, 0.0, 6)
    with pytest.raises(CalibrationError, match="left_wrist: it is not still"):
        calibrate(wearer.take, Steps((6.0, 7.0)))


def test_a_t_pose_and_spread_arms_calibrate_wrists() -> None:
    ideal = hinge("left_wrist", 0.6, 0.0)
    times = ideal.times_s
    angle = np.radians(90.0) - bend(times, (4.0, 12.0), np.radians(90.0))  # lowered and raised
    axes = Rotation.from_rotvec(angle[:, None] * np.array([0.0, 0, 1])) * Rotation.from_matrix(
        np.array(HANGING["left_wrist"]).T
    )
    rate = np.gradient(angle, times)[:, None] * axes.inv().apply([0.0, 0, 1])
    record = SensorRecord(times, axes.inv().apply(9.81 * UP), rate, axes.as_quat()[:, [3, 0, 1, 2]])
    turned = Rotation.from_rotvec([0.3, -0.2, 0.35])
    take = Take({"left_wrist": worn(record, turned, 1.03, 0.0, 1)})
    steps = Steps((0.0, 3.0), (("spread_arms", (4.0, 12.0)),), "t_pose")
    found = calibrate(take, steps).sensors["left_wrist"]
    off = turned.inv() * Rotation.from_matrix(found.R_site_sensor)
    assert np.degrees(off.magnitude()) < 1.0


def test_every_guided_movement_says_what_to_do_and_moves_known_sites() -> None:
    for instruction, sites in guided_movements().values():
        assert len(instruction) > 10
        assert sites


def test_the_shaken_sensor_is_found() -> None:
    rng = np.random.default_rng(0)
    times = np.arange(300) / 100
    still = SensorRecord(times, np.tile([0, 0, 9.81], (300, 1)) + 0.1 * rng.normal(size=(300, 3)))
    shaken = replace(still, specific_force=still.specific_force + 8 * np.sin(40 * times)[:, None])
    take = Take({"left_wrist": still, "head": shaken})
    assert assign_by_shaking(take, (0.5, 2.5)) == "head"
    with pytest.raises(CalibrationError, match="no sensor was shaken"):
        assign_by_shaking(Take({"head": still}), (0.5, 2.5))
    with pytest.raises(CalibrationError, match="both"):
        assign_by_shaking(Take({"head": shaken, "chest": shaken}), (0.5, 2.5))


def test_sensors_may_be_worn_elsewhere_than_their_names_say() -> None:
    wearer = Wearer(15.0, 0.0, 8)
    swapped = {
        "head": wearer.take.sensors["left_wrist"],
        "chest": wearer.take.sensors["left_ankle"],
    }
    found = calibrate(Take(swapped), STEPS, sites={"head": "left_wrist", "chest": "left_ankle"})
    assert apply(found, Take(swapped)).sites == ["left_wrist", "left_ankle"]
    with pytest.raises(CalibrationError, match="both worn at chest"):
        calibrate(Take(swapped), STEPS, sites={"head": "chest"})
    with pytest.raises(CalibrationError, match="no sensor 'pelvis'"):
        calibrate(Take(swapped), STEPS, sites={"pelvis": "chest"})


def test_what_is_written_is_read_again(tmp_path: Path) -> None:
    found = calibrate(Wearer(30.0, 0.1, 9).take, STEPS)
    write_calibration(tmp_path / "c.json", found)
    again = read_calibration(tmp_path / "c.json")
    assert list(again.sensors) == list(found.sensors)
    for name, sensor in found.sensors.items():
        np.testing.assert_allclose(again.sensors[name].R_site_sensor, sensor.R_site_sensor)
        np.testing.assert_allclose(again.sensors[name].gyroscope_bias, sensor.gyroscope_bias)
        assert again.sensors[name].position_along_bone == sensor.position_along_bone
        assert again.sensors[name].notes == sensor.notes


def test_a_file_of_the_first_format_is_read(tmp_path: Path) -> None:
    sensor = {"site": "head", "scale": 9.8, "R_site_sensor": np.eye(3).tolist(), "place": 0.25,
              "is_place_determined": False, "place_deviation": 0.5}  # fmt: skip
    path = tmp_path / "c.json"
    path.write_text(
        json.dumps({"format": "sparse_mocap_calibration", "sensors": {"a": sensor}}),
        encoding="utf-8",
    )
    read = read_calibration(path).sensors["a"]
    assert (read.position_along_bone, read.is_position_determined) == (0.25, False)
    assert read.position_deviation == 0.5
    write_calibration(path, read_calibration(path))
    again = json.loads(path.read_text(encoding="utf-8"))
    assert again["format_version"] == 3
    assert again["sensors"]["a"]["position_along_bone"] == 0.25
    assert "place" not in again["sensors"]["a"]


SENSOR = {
    "site": "head",
    "scale": 1.0,
    "R_site_sensor": np.eye(3).tolist(),
    "position_along_bone": 1.0,
}


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"scael": 1.0}, "sensors.a.scael is unknown; the nearest is scale"),
        ({"site": "nose"}, "sensors.a.site is the unknown sensor location 'nose'"),
        ({"scale": "1"}, "sensors.a.scale must be a number"),
        ({"scale": 0}, "sensors.a.scale is 0; it must be from 0.01"),
        ({"position_along_bone": 1.5}, "sensors.a.position_along_bone is 1.5; it must be from 0"),
        ({"place": 0.5}, "sensors.a.place is unknown; the nearest is"),
        ({"R_site_sensor": [[1, 0], [0, 1]]}, "numbers in the shape"),
        ({"R_site_sensor": np.diag([1, 1, -1]).tolist()}, "is not a rotation .determinant -1"),
        ({"notes": "x"}, "notes must be a list"),
        ({"is_position_determined": 1}, "must be true or false"),
    ],
)
def test_a_broken_file_is_refused_by_key(tmp_path: Path, change: dict, told: str) -> None:
    path = tmp_path / "c.json"
    whole: dict = {"format": "sparse_mocap_calibration", "format_version": 2}
    whole["sensors"] = {"a": SENSOR | change}
    path.write_text(json.dumps(whole), encoding="utf-8")
    with pytest.raises(CalibrationFileError, match=told):
        read_calibration(path)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", ":1: is not JSON"),
        ('{\n"a": 1,,\n}', ":2: is not JSON"),
        ("[]", "is not a calibration"),
        ('{"format": "sparse_mocap_calibration"}', "sensors is missing"),
        ('{"format": "sparse_mocap_calibration", "sensors": {}}', "a sensor or more"),
        (
            '{"format": "sparse_mocap_calibration", "format_version": 4, "sensors": {}}',
            "format_version is 4; this version of Sparse Mocap reads 1 to 3",
        ),
        ('{"format": 1, "format": 2}', "repeats the key 'format'"),
    ],
)
def test_what_is_no_calibration_is_refused(tmp_path: Path, text: str, told: str) -> None:
    path = tmp_path / "c.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(CalibrationFileError, match=told):
        read_calibration(path)


def test_the_command_line_calibrates_and_reconstructs(
    cli: Callable[..., Result], database_path: Path, tmp_path: Path
) -> None:
    wearer = Wearer(20.0, 0.05, 10)
    take, out = tmp_path / "take.csv", tmp_path / "c.json"
    write_take(take, wearer.take)
    result = cli("calibrate", take, "-o", out, "--stand", "0:3", "--arms", "4:12",
                 "--legs", "13:21", "--position-along-bone", "left_ankle=0.4")  # fmt: skip
    assert result.exit_code == 0, result.output
    assert "left_wrist" in result.output
    assert read_calibration(out).sensors["left_ankle"].position_along_bone == 0.4
    report = tmp_path / "r.json"
    result = cli("reconstruct", "--database", database_path, take, "-o", tmp_path / "m.bvh",
                 "--calibration", out, "--json", report)  # fmt: skip
    assert result.exit_code == 0, result.output
    places = json.loads(report.read_text(encoding="utf-8"))["options"]["positions_along_bone"]
    assert places[2] == 0.4
    assert places[0] == pytest.approx(wearer.places["left_wrist"], abs=0.1)


@pytest.mark.parametrize("span", ["3", "3:1", "a:b", "nan:2"])
def test_a_span_that_is_none_is_a_usage_error(
    cli: Callable[..., Result], tmp_path: Path, span: str
) -> None:
    result = cli("calibrate", tmp_path / "t.csv", "-o", tmp_path / "c.json", "--stand", span)
    assert result.exit_code == 2
    assert "FROM:TO" in result.output
