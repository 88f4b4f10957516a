# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sketches print is read with the options that they name; they run on this machine."""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from sparse_mocap import StreamParser, driver_names, driver_options
from sparse_mocap.capture.driver_guide import GUIDES, sketch, sketch_names

ARDUINO = Path(__file__).resolve().parents[1] / "arduino"
COUNT = 300


def registers(values: dict[int, list[int]], *, is_low_first: bool) -> list[str]:
    """Arguments that put 16-bit numbers into a sensor's registers."""
    pairs = []
    for first, numbers in values.items():
        for index, number in enumerate(numbers):
            low, high = number & 0xFF, number >> 8 & 0xFF
            order = (low, high) if is_low_first else (high, low)
            pairs += [f"{first + 2 * index + i}={byte}" for i, byte in enumerate(order)]
    return pairs


MEASURED = {
    "mpu6050": registers({0x3B: [0, -2048, 4096, 500, 1640, 0, -328]}, is_low_first=False),
    "bno055": registers(
        {0x08: [0, -490, 981], 0x14: [1600, 0, -320], 0x20: [16384, 0, 0, 0]}, is_low_first=True
    ),
}
EXPECTED = {
    "mpu6050": ([0.0, -0.5 * 9.80665, 9.80665], [100.0, 0.0, -20.0]),
    "bno055": ([0.0, -4.9, 9.81], [100.0, 0.0, -20.0]),
}


def printed(name: str, folder: Path) -> bytes:
    compiler = shutil.which("g++") or shutil.which("clang++")
    if compiler is None:
        pytest.skip("no C++ compiler is installed")
    source = folder / f"{name}.cpp"
    source.write_text(sketch(name))
    program = folder / name
    subprocess.run(
        [compiler, "-std=c++17", "-Wall", "-Wextra", "-Werror", f"-I{ARDUINO}", "-include",
         "Arduino.h", str(source), str(ARDUINO / "main.cpp"), "-o", str(program)],
        check=True,
    )  # fmt: skip
    return subprocess.run(
        [program, str(COUNT), *MEASURED[name]], check=True, capture_output=True
    ).stdout


@pytest.mark.parametrize("name", sketch_names())
def test_the_lines_of_a_sketch_are_read_with_its_options(name: str, tmp_path: Path) -> None:
    options = dict(re.findall(r"--option (\w+)=(\S+)", sketch(name)))
    assert "columns" in options
    parser = StreamParser("text_line", **options)
    got = parser.feed(printed(name, tmp_path))
    assert len(got["sensor"]) >= COUNT - 1
    assert parser.counters["malformed"] == 0
    force, turn = EXPECTED[name]
    np.testing.assert_allclose(
        got["specific_force"], np.tile(force, (len(got["sensor"]), 1)), atol=0.02
    )
    np.testing.assert_allclose(np.degrees(got["angular_velocity"][0]), turn, atol=0.1)
    assert np.diff(got["time_s"]) == pytest.approx(0.01, abs=2e-4)
    if name == "bno055":
        assert parser.sensor_ids == ["24:6F:28:AA:BB:CC"]
        assert np.isfinite(got["orientation"]).all()


def test_every_driver_is_explained_with_all_its_options(cli: Callable[..., Result]) -> None:
    assert list(GUIDES) == driver_names()
    overview = cli("drivers").output
    for name in driver_names():
        assert name in overview
        shown = cli("drivers", name).output
        assert GUIDES[name].example.split()[0] in shown
        assert all(option in shown for option in driver_options(name))
        words = GUIDES[name].example.split()
        options = dict(
            words[at + 1].split("=", 1) for at, word in enumerate(words) if word == "--option"
        )
        StreamParser(name, **options)
    assert cli("drivers", "--sketch", "mpu6050").output == sketch("mpu6050")
    assert cli("drivers", "abacus").exit_code == 2
