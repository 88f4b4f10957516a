# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds FAISS' exact flat index to the results of recorded_knn_bench.cpp, on the rows it wrote.

python tests/bench/faiss_bench.py bench.json FOLDER_OF_ROWS
"""

from __future__ import annotations

import json
import re
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

NEIGHBOURS = 4096
QUERIES = 50


def result(rows: Path) -> dict[str, Any]:
    """What a query costs, one thread, as Google Benchmark writes results."""
    import faiss

    size, dimensions = re.fullmatch(r"rows-(\w+)-(\d+)\.f32", rows.name).groups()  # type: ignore[union-attr]
    width = int(dimensions)
    faiss.omp_set_num_threads(1)
    index = faiss.IndexFlatL2(width)
    index.add(np.fromfile(rows, np.float32).reshape(-1, width))
    queries = np.fromfile(rows.with_name(f"queries-{size}-{width}.f32"), np.float32)
    times_ms = []
    for query in queries.reshape(-1, 1, width)[:QUERIES]:
        start = time.thread_time()
        index.search(query, NEIGHBOURS)
        times_ms.append(1e3 * (time.thread_time() - start))
    p50, p99, worst = np.percentile(times_ms, [50, 99, 100])
    mean = float(np.mean(times_ms))
    return {
        "name": f"recorded_knn/faiss_flat/{width}d/{size}/iterations:{len(times_ms)}",
        "run_type": "iteration", "iterations": len(times_ms),
        "real_time": mean, "cpu_time": mean, "time_unit": "ms",
        "p50_ms": float(p50), "p99_ms": float(p99), "worst_ms": float(worst),
    }  # fmt: skip


def main(path: Path, folder: Path) -> None:
    bench = json.loads(path.read_text(encoding="utf-8"))
    rows = sorted(folder.glob("rows-*.f32"))
    if not rows:
        return
    try:
        bench["benchmarks"] += [result(file) for file in rows]
    except ImportError:
        print("FAISS is not installed here: left out")
    path.write_text(json.dumps(bench, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
