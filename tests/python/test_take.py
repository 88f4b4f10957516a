# SPDX-License-Identifier: GPL-3.0-or-later
"""Take files, and takes on a database's time line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from sparse_mocap import (
    FormatError,
    SensorRecord,
    Take,
    TakeError,
    filtered_at,
    read_take,
    write_take,
)
from sparse_mocap.readings import SensorInput, all_readings


def resampled(take: Take, rate_hz: float) -> tuple[np.ndarray, np.ndarray]:
    """Returns the readings' times (T,) and specific forces (T, S, 3)."""
    readings = all_readings(take, [SensorInput(site) for site in take.sites], rate_hz)
    return readings.times_s, readings.specific_force


HEADER = "time_s,sensor,ax,ay,az\n"


def record(times: np.ndarray, seed: int = 0) -> SensorRecord:
    rng = np.random.default_rng(seed)
    turns = rng.normal(size=(len(times), 4))
    return SensorRecord(
        times,
        rng.normal(size=(len(times), 3)),
        rng.normal(size=(len(times), 3)),
        turns / np.linalg.norm(turns, axis=1, keepdims=True),
        rng.normal(size=(len(times), 3)),
    )


def still(times: np.ndarray, value: float = 9.81) -> SensorRecord:
    return SensorRecord(times, np.tile([0.0, 0.0, value], (len(times), 1)))


def test_what_is_written_is_read_again(tmp_path: Path) -> None:
    clocks = {"right_ankle": np.arange(50) / 100, "left_wrist": np.arange(70) / 130 + 0.003}
    take = Take({site: record(times, len(site)) for site, times in clocks.items()}, ("a note",))
    write_take(tmp_path / "take.csv", take)
    again = read_take(tmp_path / "take.csv")
    assert again.sites == take.sites
    assert again.comments == ("a note",)
    for site, old in take.sensors.items():
        new = again.sensors[site]
        for name in ("times_s", "specific_force", "angular_velocity", "orientation", "position"):
            np.testing.assert_allclose(getattr(new, name), getattr(old, name), atol=6e-7)


def test_accelerometers_alone_make_a_take(tmp_path: Path) -> None:
    write_take(tmp_path / "take.csv", Take({"head": still(np.arange(3) / 10)}))
    text = (tmp_path / "take.csv").read_text(encoding="utf-8")
    assert text.startswith(HEADER)
    again = read_take(tmp_path / "take.csv").sensors["head"]
    assert again.angular_velocity is None
    assert again.orientation is None
    assert again.position is None


def test_positions_need_nothing_but_forces_beside_them(tmp_path: Path) -> None:
    path = tmp_path / "take.csv"
    path.write_text("px,pz,py,time_s,sensor,ax,ay,az\n1,3,2,0,head,0,0,9.81\n", encoding="utf-8")
    head = read_take(path).sensors["head"]
    assert head.position is not None
    assert head.position.tolist() == [[1.0, 2.0, 3.0]]
    write_take(path, Take({"head": head, "chest": still(np.zeros(1))}))  # which was not tracked
    assert read_take(path).sensors["head"].position is None


def test_a_take_without_sensors_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="without sensors"):
        write_take(tmp_path / "take.csv", Take({}))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "text",
    [
        "\ufeff" + HEADER + "0,head,1,2,3\n",
        (HEADER + "0,head,1,2,3\n").replace("\n", "\r\n"),
        (HEADER + "0,head,1,2,3\n").replace("\n", "\r"),
        HEADER + "0,head,1,2,3",
        "# a note\n\n" + HEADER + "# another\n\n  \n0,head,1,2,3\n",
        "az, ay,ax,sensor ,time_s\n3,2,1, head ,0\n",
        HEADER + "0,head,+1.0,2e0,3.\n",
    ],
)
def test_harmless_differences_are_accepted(tmp_path: Path, text: str) -> None:
    path = tmp_path / "take.csv"
    path.write_bytes(text.encode())
    take = read_take(path)
    np.testing.assert_array_equal(take.sensors["head"].specific_force, [[1, 2, 3]])


BAD = {
    "empty": (b"", 0, "is empty"),
    "comments only": (b"# hello\n\n", 0, "is empty"),
    "no header": (b"0,head,1,2,3\n", 1, "column time_s, sensor, ax, ay, az is missing"),
    "missing column": (b"# x\ntime_s,sensor,ax,ay\n0,head,1,2\n", 2, "column az is missing"),
    "half a gyroscope": (b"time_s,sensor,ax,ay,az,gx,gy\n", 1, "column gz is missing"),
    "unknown column": (b"time_s,sensor,ax,ay,az,temp\n", 1, "'temp' is unknown"),
    "column twice": (b"time_s,sensor,ax,ay,az,az\n", 1, "occurs twice"),
    "no samples": (HEADER.encode(), 1, "no samples"),
    "unknown sensor": (HEADER.encode() + b"0,nose,1,2,3\n", 2, "known are left_wrist"),
    "no sensor": (HEADER.encode() + b"0,,1,2,3\n", 2, "sensor '' is unknown"),
    "short row": (HEADER.encode() + b"0,head,1,2,3\n1,head,1,2\n", 3, "expected 5 values"),
    "long row": (HEADER.encode() + b"0,head,1,2,3,4\n", 2, "got 6"),
    "decimal comma": (HEADER.encode() + b"0,5,head,1,2,3\n", 2, "decimal point"),
    "text": (HEADER.encode() + b"0,head,1,two,3\n", 2, "ay is 'two'"),
    "nothing": (HEADER.encode() + b"0,head,1,,3\n", 2, "ay is ''"),
    "underscore": (HEADER.encode() + b"0,head,1,1_0,3\n", 2, "not a number"),
    "nan": (HEADER.encode() + b"0,head,1,2,3\n1,head,nan,2,3\n", 3, "not finite"),
    "inf time": (HEADER.encode() + b"inf,head,1,2,3\n", 2, "not finite"),
    "absurd": (HEADER.encode() + b"0,head,1e30,2,3\n", 2, "above 10000"),
    "milliseconds": (HEADER.encode() + b"0,head,1,2,3\n9e7,head,1,2,3\n", 3, "in seconds"),
    "back in time": (
        HEADER.encode() + b"0,head,1,2,3\n# x\n1,head,1,2,3\n0,pelvis,1,2,3\n0.5,head,1,2,3\n",
        6,
        "must ascend",
    ),
    "same time": (HEADER.encode() + b"1,head,1,2,3\n1,head,1,2,3\n", 3, "must ascend"),
    "not a rotation": (
        b"time_s,sensor,ax,ay,az,qw,qx,qy,qz\n0,head,1,2,3,1,1,0,0\n",
        2,
        "not a rotation",
    ),
    "half a position": (b"time_s,sensor,ax,ay,az,px,pz\n", 1, "column py is missing"),
    "position in millimetres": (
        b"time_s,sensor,ax,ay,az,px,py,pz\n0,head,1,2,3,0,12000,0\n",
        2,
        "positions are in metres",
    ),
    "utf-16": (HEADER.encode("utf-16"), 0, "UTF-16"),
    "latin-1": (HEADER.encode() + b"# caf\xe9\n0,head,1,2,3\n", 2, "not UTF-8"),
    "nul": (HEADER.encode() + b"0,head,1,2,\x003\n", 2, "NUL"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_input_is_refused_in_one_line_that_says_where(tmp_path: Path, name: str) -> None:
    data, line, problem = BAD[name]
    path = tmp_path / "take.csv"
    path.write_bytes(data)
    with pytest.raises(TakeError) as caught:
        read_take(path)
    text = str(caught.value)
    assert problem in text
    assert text.startswith(f"{path}:{line}: " if line else f"{path}: ")
    assert "\n" not in text
    assert isinstance(caught.value, FormatError)
    assert isinstance(caught.value, ValueError)
    assert (caught.value.path, caught.value.line) == (str(path), line)


def test_every_truncation_is_read_or_refused(tmp_path: Path) -> None:
    path, whole = tmp_path / "take.csv", (HEADER + "0,head,1,2,3\n0.5,head,4,5,6\n").encode()
    for length in range(len(whole)):
        path.write_bytes(whole[:length])
        try:
            take = read_take(path)
        except TakeError:
            continue
        assert take.sites == ["head"]


def test_what_cannot_be_opened_is_an_os_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        read_take(tmp_path / "nothing.csv")
    with pytest.raises((IsADirectoryError, PermissionError)):  # the latter on Windows
        read_take(tmp_path)


def test_a_still_sensor_stays_still_when_resampled() -> None:
    take = Take({"head": still(np.arange(101) / 100), "pelvis": still(np.arange(101) / 100, 1.0)})
    times, readings = resampled(take, 25.0)
    np.testing.assert_allclose(times, np.arange(26) / 25)
    assert readings.shape == (26, 2, 3)
    np.testing.assert_allclose(readings[:, 0], np.tile([0, 0, 9.81], (26, 1)))
    np.testing.assert_allclose(readings[:, 1], np.tile([0, 0, 1.0], (26, 1)))


def test_resampling_is_the_filter_of_the_database() -> None:
    take = Take({"head": record(np.arange(200) / 100 + 7.0)})
    times, readings = resampled(take, 30.0)
    assert times[0] == 7.0
    sensor = take.sensors["head"]
    expected = filtered_at(sensor.times_s, sensor.specific_force, times)
    np.testing.assert_array_equal(readings[:, 0], expected)


def test_a_gap_is_silence_only_when_it_is_long() -> None:
    clock = np.arange(201) / 100
    short = np.delete(clock, slice(51, 60))  # 0.50 s to 0.60 s
    long = np.delete(clock, slice(51, 71))  # 0.50 s to 0.71 s
    take = Take({"head": still(short), "pelvis": still(long)})
    times, readings = resampled(take, 100.0)
    assert not np.isnan(readings[:, 0]).any()
    silent = times[np.isnan(readings[:, 1]).any(axis=1)]
    np.testing.assert_allclose([silent[0], silent[-1], len(silent)], [0.51, 0.70, 20])


def test_a_sensor_that_starts_late_or_ends_early_is_silent_then() -> None:
    take = Take({"head": still(np.arange(201) / 100), "pelvis": still(np.arange(50, 101) / 100)})
    times, readings = resampled(take, 50.0)
    silent = np.isnan(readings[:, 1]).any(axis=1)
    np.testing.assert_array_equal(silent, (times < 0.4 - 1e-6) | (times > 1.1 + 1e-6))
    assert not np.isnan(readings[:, 0]).any()


def test_one_sample_is_a_take() -> None:
    times, readings = resampled(Take({"head": still(np.array([3.0]))}), 25.0)
    assert times.tolist() == [3.0]
    np.testing.assert_allclose(readings, [[[0, 0, 9.81]]])
