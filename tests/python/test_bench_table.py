# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of the benchmarks says what got slower, and only that."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path

import pytest

SCRIPT = Path(__file__).resolve().parents[1] / "bench" / "table.py"
spec = importlib.util.spec_from_file_location("bench_table", SCRIPT)
assert spec is not None
assert spec.loader is not None
table = importlib.util.module_from_spec(spec)
spec.loader.exec_module(table)

STORED = {"search": 1.0, "graph": 2.0, "frame": 4.0, "opening": 8.0}


@pytest.mark.parametrize("machine", [1.0, 3.0])
def test_names_what_got_slower_on_any_machine(machine: float) -> None:
    now = {name: ms * machine for name, ms in STORED.items()}
    assert table.slower(now, STORED) == {}
    now["graph"] *= 1.5
    assert table.slower(now, STORED) == {"graph": pytest.approx(1.5)}


def test_compares_what_both_have_measured() -> None:
    assert table.slower({"new": 9.0}, STORED) == {}
    assert table.slower({"new": 9.0, "graph": 2.0}, STORED) == {}


def test_gathers_how_times_grow() -> None:
    now = {"recorded_frame/paper/680k": 3.0, "recorded_frame/paper/30k": 1.0, "energy": 9.0}
    assert table.growth(now) == {"recorded_frame/paper": [(3.0e4, 1.0), (6.6e5, 3.0)]}


def test_shows_times_beside_baselines(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def result(name: str, ms: float) -> dict[str, object]:
        return {"name": name, "cpu_time": ms, "real_time": ms, "time_unit": "ms"}

    search = result("recorded_knn/sparse_mocap/12d/30k/iterations:5", 3.0) | {
        "p50_ms": 2.0, "p99_ms": 5.0, "worst_ms": 6.0,
    }  # fmt: skip
    baseline = result("recorded_knn/nanoflann/12d/30k/iterations:5", 8.0)
    path = tmp_path / "bench.json"
    path.write_text(json.dumps({"benchmarks": [search, baseline]}), encoding="utf-8")
    empty = tmp_path / "filtered.json"
    empty.write_text("", encoding="utf-8")
    table.main([path, empty], store=False)
    lines = capsys.readouterr().out.splitlines()
    assert lines[1].split() == [
        "recorded_knn/sparse_mocap/12d/30k", "2.000", "5.000", "6.000", "3.000", "3.000",
    ]  # fmt: skip
    ratio = next(line for line in lines if "nanoflann" in line and "sparse_mocap" in line)
    assert ratio.split()[-1] == "4.00"


def test_storing_tells_what_got_slower_than_before(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    stored = tmp_path / "baseline.json"
    stored.write_text(json.dumps(STORED), encoding="utf-8")
    monkeypatch.setattr(table, "STORED", stored)
    now = STORED | {"graph": 4.0}
    results = [
        {"name": name, "cpu_time": ms, "real_time": ms, "time_unit": "ms"}
        for name, ms in now.items()
    ]
    path = tmp_path / "bench.json"
    path.write_text(json.dumps({"benchmarks": results}), encoding="utf-8")
    table.main([path], store=True)
    assert "graph" in capsys.readouterr().out.partition("Slower than stored:")[2]
    assert json.loads(stored.read_text(encoding="utf-8")) == now
