# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds a public Python reader to the results of parsing_bench.cpp, and the ratios between all.

python tests/bench/parsing_bench.py bench.json
"""

from __future__ import annotations

import json
import sys
import time
import warnings
from pathlib import Path
from typing import Any

import pybvh

OURS = "sparse_mocap"


def pybvh_result(path: Path) -> dict[str, Any]:
    """The fastest of three readings (time of the processor), as Google Benchmark writes results."""
    seconds = []
    for _ in range(3):
        start = time.process_time()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            pybvh.read_bvh_file(path)
        seconds.append(time.process_time() - start)
    return {
        "name": "parse_bvh/pybvh",
        "run_type": "iteration",
        "iterations": len(seconds),
        "real_time": 1e3 * min(seconds),
        "cpu_time": 1e3 * min(seconds),
        "time_unit": "ms",
        "bytes_per_second": path.stat().st_size / min(seconds),
        "label": str(path),
    }


def ratios(results: list[dict[str, Any]]) -> dict[str, float]:
    """How many times faster ours is than each of the others."""
    speeds = {r["name"]: r["bytes_per_second"] for r in results if r["name"].startswith("parse_")}
    found = {}
    for name, speed in speeds.items():
        task, reader = name.split("/")
        if reader != OURS:
            found[f"{task}: {OURS} / {reader}"] = speeds[f"{task}/{OURS}"] / speed
    return found


def main(path: Path) -> None:
    bench = json.loads(path.read_text(encoding="utf-8"))
    ours = [result for result in bench["benchmarks"] if result["name"] == f"parse_bvh/{OURS}"]
    if not ours:  # a filter left it out
        return
    bench["benchmarks"].append(pybvh_result(Path(ours[0]["label"])))
    bench["ratios"] = ratios(bench["benchmarks"])
    path.write_text(json.dumps(bench, indent=2) + "\n", encoding="utf-8")
    for result in bench["benchmarks"]:
        if result["name"].startswith("parse_"):
            print(f"{result['name']:24} {result['bytes_per_second'] / 1e6:8.1f} MB/s")
    for name, ratio in bench["ratios"].items():
        print(f"{name:40} {ratio:6.2f}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
