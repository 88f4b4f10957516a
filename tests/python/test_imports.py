# SPDX-License-Identifier: GPL-3.0-or-later
"""Recordings of other programs: small files after their documented formats, and real ones."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from sparse_mocap import SensorRecord, Take, read_take, write_take
from sparse_mocap.imports import RecordingError, read_recording
from sparse_mocap.rotations import from_z_up, inverse, product, rotated, rotations_from_matrices

Cli = Callable[..., Result]
Floats = NDArray[np.float64]
UP = [0.0, 9.81, 0.0]

PHYPHOX = '"Time (s)","Acceleration x (m/s^2)","Acceleration y (m/s^2)","Acceleration z (m/s^2)"'
GYROSCOPE = '"Time (s)","Gyroscope x (rad/s)","Gyroscope y (rad/s)","Gyroscope z (rad/s)"'


def in_world(record: SensorRecord) -> Floats:
    """Specific force in the world that the record's orientation refers to."""
    assert record.orientation is not None
    return Rotation.from_quat(record.orientation[:, [1, 2, 3, 0]]).apply(record.specific_force)


def most_still(record: SensorRecord) -> slice:
    """The 0.4 s in which the specific force changes least."""
    width = int(np.searchsorted(record.times_s, record.times_s[0] + 0.4))
    force = record.specific_force
    spreads = [force[at : at + width].std(axis=0).max() for at in range(len(force) - width)]
    at = int(np.argmin(spreads))
    return slice(at, at + width)


def expect_at_rest(take: Take) -> None:
    for name, record in take.sensors.items():
        still = most_still(record)
        norms = np.linalg.norm(record.specific_force[still], axis=1)
        assert norms.mean() == pytest.approx(9.81, rel=0.03), name
        np.testing.assert_allclose(in_world(record)[still].mean(axis=0), UP, atol=0.3, err_msg=name)


@pytest.mark.parametrize(
    ("folder", "num_sensors", "rate_hz"),
    [("opensense_xsens_mtw", 8, 100.0), ("xsens_dot", 5, 60.0), ("ximu3_lower_body", 7, 50.0)],
)
def test_recordings_of_the_world_are_in_si_units_and_upright(
    real_data: Path, folder: str, num_sensors: int, rate_hz: float
) -> None:
    take = read_recording(real_data / "imu" / folder)
    assert len(take.sensors) == num_sensors
    assert take.begin_s == 0.0
    expect_at_rest(take)
    periods = [np.median(np.diff(record.times_s)) for record in take.sensors.values()]
    assert 1 / np.median(periods) == pytest.approx(rate_hz, rel=0.01)
    turns = [record.angular_velocity for record in take.sensors.values()]
    if folder == "ximu3_lower_body":
        assert max(np.abs(turn).max() for turn in turns if turn is not None) < 15.0  # rad/s


def test_the_values_are_those_of_the_file(real_data: Path) -> None:
    file = next((real_data / "imu" / "opensense_xsens_mtw").glob("*421E6.txt"))
    record = read_recording(file).sensors["00B421E6"]
    np.testing.assert_array_equal(record.specific_force[0], [0.102257, 4.888482, -8.503300])
    dot = next((real_data / "imu" / "xsens_dot").glob("LFemur*.csv"))
    record = read_recording(dot).sensors["LFemur"]
    turn = Rotation.from_quat([-0.431467, -0.561427, -0.573619, 0.411830])
    force = turn.inv().apply([0.016456, 0.019243, 9.81 - 0.046306])
    np.testing.assert_allclose(record.specific_force[0], force, atol=1e-5)
    assert any("gravity" in comment for comment in read_recording(dot).comments)


def test_rotations_are_those_of_scipy() -> None:
    turns = Rotation.random(200, random_state=3)
    scalar_first = turns.as_quat()[:, [3, 0, 1, 2]]
    found = rotations_from_matrices(turns.as_matrix())
    np.testing.assert_allclose(np.abs(np.sum(found * scalar_first, axis=1)), 1.0, atol=1e-9)
    vectors = np.random.default_rng(3).normal(size=(200, 3))
    np.testing.assert_allclose(rotated(inverse(scalar_first), vectors), turns.inv().apply(vectors))
    both = (turns * turns[7]).as_quat()[:, [3, 0, 1, 2]]
    found = product(scalar_first, scalar_first[7])
    np.testing.assert_allclose(np.abs(np.sum(found * both, axis=1)), 1.0, atol=1e-12)
    z_up = from_z_up(scalar_first)
    np.testing.assert_allclose(
        Rotation.from_quat(z_up[:, [1, 2, 3, 0]]).apply(vectors),
        turns.apply(vectors)[:, [1, 2, 0]],
        atol=1e-12,
    )


@pytest.mark.parametrize(
    ("separator", "has_decimal_comma"),
    [(",", False), (";", False), (";", True), ("\t", False), ("\t", True)],
)
def test_phyphox_in_each_of_its_spellings(
    tmp_path: Path, separator: str, has_decimal_comma: bool
) -> None:
    rows = [f"{t:.3E},0.1,-0.2,9.81E0" for t in (0.0, 0.01, 0.02)]
    text = "\n".join([PHYPHOX, *rows]).replace(",", separator)
    if has_decimal_comma:
        text = text.replace(".", ",")
    path = tmp_path / "Raw Data.csv"
    path.write_text(text + "\n")
    record = read_recording(path).sensors["phone"]
    np.testing.assert_allclose(record.specific_force, np.tile([0.1, -0.2, 9.81], (3, 1)))
    np.testing.assert_allclose(record.times_s, [0.0, 0.01, 0.02])


def test_phyphox_zip_with_gyroscope(tmp_path: Path) -> None:
    path = tmp_path / "phyphox.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("Accelerometer.csv", PHYPHOX + "\n0,0,0,9.8\n0.01,0,0,9.8\n")
        archive.writestr("Gyroscope.csv", GYROSCOPE + "\n-0.005,1,0,0\n0.005,3,0,0\n")
        archive.writestr("meta/device.csv", '"property","value"\n"version","1.1.16"\n')
        archive.writestr("meta/time.csv", '"event","experiment time"\n"START",0\n')
    record = read_recording(path).sensors["phone"]
    assert record.angular_velocity is not None
    np.testing.assert_allclose(record.angular_velocity[:, 0], [2.0, 3.0])


def test_phyphox_without_gravity_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "linear.csv"
    path.write_text(PHYPHOX.replace("Acceleration", "Linear Acceleration") + "\n0,0,0,0\n")
    with pytest.raises(RecordingError, match="with gravity"):
        read_recording(path)


def sensor_logger(path: Path, files: dict[str, str]) -> Path:
    with zipfile.ZipFile(path, "w") as archive:
        for name, text in files.items():
            archive.writestr(name, text)
    return path


def xyz(*rows: str) -> str:
    return "\n".join(["time,seconds_elapsed,z,y,x", *rows]) + "\n"


def test_sensor_logger_of_an_android_phone(tmp_path: Path) -> None:
    quaternion = "time,seconds_elapsed,qz,qy,qx,qw,roll,pitch,yaw\n1,-0.01,0,0,0,1,0,0,0\n"
    path = sensor_logger(tmp_path / "log.zip", {
        "Accelerometer.csv": xyz("1,-0.01,0,0,0"),
        "TotalAcceleration.csv": xyz("1,-0.01,9.81,0.2,0.1", "2,0.01,9.81,0.2,0.1"),
        "Gyroscope.csv": xyz("1,-0.01,3,2,1"),
        "Orientation.csv": quaternion,
        "Metadata.csv": "version,device name,platform\n3,Pixel 7,android\n",
    })  # fmt: skip
    record = read_recording(path).sensors["phone"]
    np.testing.assert_allclose(record.specific_force[0], [0.1, 0.2, 9.81])
    assert record.angular_velocity is not None
    np.testing.assert_allclose(record.angular_velocity[1], [1.0, 2.0, 3.0])
    np.testing.assert_allclose(in_world(record)[0], [0.2, 9.81, 0.1], atol=1e-9)
    np.testing.assert_allclose(record.times_s, [0.0, 0.02])


@pytest.mark.parametrize(("is_standardised", "unit", "sign"), [("true", 9.81, 1), ("false", 1, -1)])
def test_sensor_logger_of_an_iphone(
    tmp_path: Path, is_standardised: str, unit: float, sign: int
) -> None:
    path = sensor_logger(tmp_path / "log.zip", {
        "Accelerometer.csv": xyz("1,0,0,0,0", "2,0.01,0,0,0"),
        "Gravity.csv": xyz(f"1,0,{sign * unit},0,0", f"2,0.01,{sign * unit},0,0"),
        "Metadata.csv": f"version,platform,standardisation\n3,ios,{is_standardised}\n",
    })  # fmt: skip
    record = read_recording(path).sensors["phone"]
    np.testing.assert_allclose(record.specific_force[0], [0.0, 0.0, 9.81], atol=0.01)


def test_a_take_comes_back_as_it_was(tmp_path: Path) -> None:
    times = np.arange(5) / 100
    force = np.tile([0.0, 0.0, 9.81], (5, 1))
    write_take(tmp_path / "take.csv", Take({"head": SensorRecord(times, force)}))
    again = read_recording(tmp_path / "take.csv", {"head": "pelvis"})
    np.testing.assert_allclose(again.sensors["pelvis"].specific_force, force)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a,b,c\n1,2,3\n", "starts with 'a,b,c'"),
        ("", "supported are"),
        (PHYPHOX + "\n0,0,0\n", ":2: expected 4 cells"),
        (PHYPHOX + "\n0,0,x,0\n", ":2: Acceleration y .* is 'x'"),
        (PHYPHOX + "\n0,0,,0\n", ":2: a value of"),
        (PHYPHOX + "\n", "no samples"),
        ("// nothing\nPacketCounter\tAcc_X\tAcc_Y\tAcc_Z\n1\t0\t0\t9\n", "Update Rate"),
    ],
)
def test_what_cannot_be_read_is_told_in_a_line(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "x.csv"
    path.write_text(text)
    with pytest.raises(RecordingError, match=message) as error:
        read_recording(path)
    assert "\n" not in str(error.value)


def test_the_command_names_sites(cli: Cli, tmp_path: Path) -> None:
    path = tmp_path / "Raw Data.csv"
    path.write_text(PHYPHOX + "\n0,0,0,9.81\n0.01,0,0,9.81\n")
    out = tmp_path / "take.csv"
    assert "no location given" in cli("import", path, "-o", out).output
    assert cli("import", path, "-o", out, "--site", "phone=left_ankle").exit_code == 0
    assert read_take(out).sites == ["left_ankle"]
    assert cli("import", path, "-o", out, "--site", "phone=nowhere").exit_code == 2
    wrong = cli("import", path, "-o", out, "--site", "foot=left_ankle")
    assert wrong.exit_code == 1
    assert "it has 'phone'" in wrong.output
    assert cli("import", tmp_path / "none.csv", "-o", out).exit_code == 1


def zip_of(path: Path, name: str, text: bytes) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, text)
    return path


def peak_mb(recording: Path) -> float:
    """The memory that refusing a recording takes, in a process of its own."""
    pytest.importorskip("resource", reason="Windows does not tell how much memory was used")
    script = (
        "import resource, sys\nfrom sparse_mocap.imports import RecordingError, read_recording\n"
        "before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss\n"
        "try:\n    read_recording(sys.argv[1])\nexcept RecordingError as error:\n"
        "    assert len(str(error)) < 400, 'long'\nelse:\n    sys.exit(3)\n"
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, str(recording)], capture_output=True, text=True, check=True
    )
    return int(done.stdout) / 1024


@pytest.mark.parametrize(
    "text",
    [b"0" * 900_000_000, b"1\n" * 30_000_000, b'"' * 50_000_000],
    ids=["a line", "lines", "quotes"],
)
def test_a_zip_that_unpacks_to_very_much_is_refused_in_little_memory(
    tmp_path: Path, text: bytes
) -> None:
    assert peak_mb(zip_of(tmp_path / "a.zip", "Raw Data.csv", text)) < 300


@pytest.mark.parametrize(
    "row",
    [b"0,0,0,9.8\n", b"0" * 140_000 + b"\n", b"," * 5000 + b"\n"],
    ids=["many", "long", "wide"],
)
def test_a_file_beyond_the_limits_is_refused(tmp_path: Path, row: bytes) -> None:
    path = tmp_path / "Raw Data.csv"
    head = b"" if row.startswith(b",") else b"\n"
    path.write_bytes(PHYPHOX.encode() + head + row * (4_100_000 if len(row) < 50 else 1))
    with pytest.raises(RecordingError, match=r"lines|columns|not a table") as caught:
        read_recording(path)
    assert str(path) in str(caught.value)


def test_a_damaged_or_locked_zip_is_refused(tmp_path: Path) -> None:
    path = zip_of(tmp_path / "a.zip", "Raw Data.csv", b"1,2\n" * 1000)
    whole = path.read_bytes()
    path.write_bytes(whole[:40] + b"\xff" * 20 + whole[60:])
    with pytest.raises(RecordingError, match="cannot be unpacked"):
        read_recording(path)
    locked = bytearray(whole)
    for at in (6, whole.index(b"PK\x01\x02") + 8):
        locked[at] |= 1  # encrypted
    path.write_bytes(locked)
    with pytest.raises(RecordingError, match="cannot be unpacked"):
        read_recording(path)


def test_what_is_not_a_file_is_not_read_for_ever() -> None:
    with pytest.raises(RecordingError, match="not a file"):
        read_recording("/dev/zero")


def test_empty_lines_in_a_table_are_told_unless_they_end_it(tmp_path: Path) -> None:
    path = tmp_path / "Raw Data.csv"
    path.write_text(PHYPHOX + "\n0,0,0,9.8\n0.01,0,0,9.8\n\n,,\n")
    assert len(read_recording(path).sensors["phone"].times_s) == 2
    path.write_text(PHYPHOX + "\n0,0,0,9.8\n\n0.01,0,0,9.8\n")
    with pytest.raises(RecordingError, match=r":3: expected 4 cells"):
        read_recording(path)


def phone_export(folder: Path, size: float) -> None:
    (folder / "meta").mkdir(parents=True)
    rows = [f"{0.01 * i},0.1,{size},9.81" for i in range(50)]
    (folder / "Raw Data.csv").write_text("\n".join([PHYPHOX, *rows]) + "\n")
    (folder / "meta" / "device.csv").write_text('"property","value"\n')


def test_every_phone_in_a_folder_is_imported(tmp_path: Path, cli: Cli) -> None:
    phone_export(tmp_path / "left", 1.0)
    phone_export(tmp_path / "right", 2.0)
    inner = tmp_path / "third.zip"
    zip_of(inner, "Raw Data.csv", f"{PHYPHOX}\n0,0,3,9.8\n0.01,0,3,9.8\n".encode())
    take = read_recording(tmp_path, {"left": "left_wrist"})
    assert take.sites == ["left_wrist", "right", "third"]
    for record, size in zip(take.sensors.values(), (1.0, 2.0, 3.0), strict=True):
        assert record.specific_force[:, 1] == pytest.approx(size)
    assert any("synchronize" in comment for comment in take.comments)


def test_every_sensor_logger_recording_in_a_folder_is_imported(tmp_path: Path) -> None:
    for name, size in (("a", 1.0), ("b", 2.0)):
        (tmp_path / name).mkdir()
        text = f"time,seconds_elapsed,z,y,x\n1,0.0,9.8,{size},0\n2,0.01,9.8,{size},0\n"
        (tmp_path / name / "TotalAcceleration.csv").write_text(text)
    take = read_recording(tmp_path)
    assert take.sites == ["a", "b"]
    assert take.sensors["b"].specific_force[:, 1] == pytest.approx(2.0)
