# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes of one performance that were recorded apart, put onto one clock by a clap."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from sparse_mocap import SensorRecord, Take, read_take, write_take
from sparse_mocap.alignment import AlignmentError, merged
from sparse_mocap.take_file import device_comment

Cli = Callable[..., Result]


def phone(begin_s: float, clap_s: float, seed: int, length_s: float = 12.0) -> Take:
    """Begins at begin_s of the performance; its own times start at 0."""
    times = begin_s + np.arange(round(length_s * 100)) / 100.0
    source = np.random.default_rng(seed)
    force = np.tile([0.0, 0.0, 9.81], (len(times), 1)) + source.normal(0.0, 0.2, (len(times), 3))
    force[:, 0] += 40.0 * np.exp(-(((times - clap_s) / 0.03) ** 2))
    record = SensorRecord(times - begin_s, force)
    return Take({"phone": record}, (device_comment("phone", "phone"),))


@pytest.mark.parametrize("has_spans", [True, False])
@pytest.mark.parametrize("later_s", [0.2, 3.7, -2.5])
def test_takes_are_put_on_one_clock(has_spans: bool, later_s: float) -> None:
    first, second = phone(100.0, 106.0, 1), phone(100.0 + later_s, 106.0, 2)
    spans = [(5.0, 7.0), (5.0 - later_s, 7.0 - later_s)] if has_spans else None
    take, (lag_s,) = merged(
        [("left", first), ("right", second)], spans, sites={"left": "left_wrist"}
    )
    assert lag_s == pytest.approx(-later_s, abs=0.01)
    assert take.sites == ["left_wrist", "right"]
    claps = [r.times_s[np.argmax(r.specific_force[:, 0])] for r in take.sensors.values()]
    assert claps[0] == pytest.approx(claps[1], abs=0.015)
    assert take.begin_s == 0.0


def test_takes_without_a_common_event_are_refused() -> None:
    first, second = phone(0.0, -50.0, 1), phone(0.0, -50.0, 2)
    with pytest.raises(AlignmentError, match="clap or jump once"):
        merged([("left", first), ("right", second)])


def test_the_command_merges_and_names(tmp_path: Path, cli: Cli) -> None:
    for name, begin_s in (("a", 10.0), ("b", 11.5)):
        write_take(tmp_path / f"{name}.csv", phone(begin_s, 16.0, ord(name)))
    done = cli(
        "merge", tmp_path / "a.csv", tmp_path / "b.csv", "-o", tmp_path / "both.csv",
        "--clap", "5:7", "--clap", "3.5:5.5", "--site", "a=left_wrist", "--site", "b=right_wrist",
    )  # fmt: skip
    assert done.exit_code == 0, done.output
    assert "b: begins +1.5" in done.output
    assert read_take(tmp_path / "both.csv").sites == ["left_wrist", "right_wrist"]
    assert cli("merge", tmp_path / "a.csv", "-o", tmp_path / "x.csv").exit_code == 2
