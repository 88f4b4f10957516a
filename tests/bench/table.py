# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the results of the benchmarks: times, each beside its baseline, and what got slower.

python tests/bench/table.py [--store] [--plot GROWTH.png] RESULTS.json...

`--store` makes the results the ones that later runs are compared with (tests/bench/baseline.json);
`--plot` draws how the times grow with the database.
"""

from __future__ import annotations

import argparse
import json
import re
import statistics
from pathlib import Path
from typing import Any

STORED = Path(__file__).with_name("baseline.json")
SLOWER = 1.25  # times as slow as stored, beside the median of all

PAPER_MS = {
    "paper_frame/index_build": 1390.0,
    "paper_frame/search": 51.0,
    "paper_frame/graph": 12.0,
    "paper_frame/minimisation": 380.0,
}
"""Table III of Tautges et al. 2011: 600,000 frames, K = 4096, I = 256, one core."""

BASELINES = (
    (r"recorded_knn/(?:plain_scan|nanoflann|faiss_flat)/(.*)", r"recorded_knn/sparse_mocap/\1"),
    (r"paper_frame/graph_made_anew/\d+", "paper_frame/graph"),
    (r"paper_frame/minimisation_by_.*", "paper_frame/minimisation"),
    (r"knn_search_by_nanoflann/(\d+)", r"knn_search/\1"),
    (r"minimize_by_ceres.*", "minimize_by_majorising"),
)
"""Whose time is to be seen beside whose."""

TO_MS = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}


def time_ms(result: dict[str, Any]) -> float:
    """Processor time of a call: the median where calls were timed one by one, else the mean."""
    return float(result.get("p50_ms", result["cpu_time"] * TO_MS[result["time_unit"]]))


def named(bench: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """The results by name, without what Google Benchmark adds to it."""
    ends = r"/(iterations:\d+|process_time|real_time)"
    return {re.sub(ends, "", r["name"]): r for r in bench["benchmarks"] if "cpu_time" in r}


def print_times(results: dict[str, dict[str, Any]]) -> None:
    print(f"{'ms':44}{'p50':>10}{'p99':>10}{'worst':>10}{'processor':>11}{'clock':>10}")
    for name, result in results.items():
        unit = TO_MS[result["time_unit"]]
        shares = [result.get(key) for key in ("p50_ms", "p99_ms", "worst_ms")]
        cells = "".join(f"{'-' if ms is None else format(ms, '.3f'):>10}" for ms in shares)
        print(
            f"{name:44}{cells}{result['cpu_time'] * unit:11.3f}{result['real_time'] * unit:10.3f}"
        )


def print_ratios(results: dict[str, dict[str, Any]]) -> None:
    print("\nTimes as fast as the baseline (medians of processor time)")
    for name, result in results.items():
        for pattern, replacement in BASELINES:
            ours = re.sub(pattern, replacement, name)
            if re.fullmatch(pattern, name) and ours in results:
                print(f"{ours:44}{name:44}{time_ms(result) / time_ms(results[ours]):8.2f}")
    for name, paper in PAPER_MS.items():
        if name in results:
            print(f"{name:44}{'Table III of the paper':44}{paper / time_ms(results[name]):8.1f}")


def slower(now: dict[str, float], stored: dict[str, float]) -> dict[str, float]:
    """How many times as slow, for those that stand out: beside the median, so that a slower or a
    busier machine is not taken for slower code."""
    ratios = {name: now[name] / ms for name, ms in stored.items() if name in now}
    if not ratios:
        return {}
    usual = statistics.median(ratios.values())
    return {name: ratio / usual for name, ratio in ratios.items() if ratio > SLOWER * usual}


ROWS = {"30k": 3.0e4, "100k": 1.0e5, "300k": 3.0e5, "680k": 6.6e5, "5m": 5.1e6}


SEARCHES = {
    "sparse_mocap": "Sparse Mocap",
    "plain_scan": "plain scan",
    "faiss_flat": "FAISS, flat",
    "nanoflann": "nanoflann",
}


def growth(now: dict[str, float]) -> dict[str, list[tuple[float, float]]]:
    """Rows and times (ms) of whatever was measured on several sizes, the smallest first."""
    curves: dict[str, list[tuple[float, float]]] = {}
    for name, ms in now.items():
        kind, _, size = name.rpartition("/")
        if size in ROWS and kind.startswith(("recorded_knn", "recorded_frame")):
            curves.setdefault(kind, []).append((ROWS[size], ms))
    return {kind: sorted(curve) for kind, curve in curves.items() if len(curve) > 1}


PANELS = {
    "a frame of live quality": {
        "recorded_frame/path_regression": "path_regression",
        "recorded_frame/tautges2011": "tautges2011",
    },
    "the 4096 nearest frames, 12 dimensions": {
        f"recorded_knn/{name}/12d": label for name, label in SEARCHES.items()
    },
    "the 4096 nearest frames, 24 dimensions": {
        f"recorded_knn/{name}/24d": label for name, label in SEARCHES.items()
    },
}
"""What the plot of the growth shows: the curves of each panel, and what they are called there."""


def plot_growth(now: dict[str, float], path: Path) -> None:
    from matplotlib.figure import Figure
    from matplotlib.ticker import LogLocator, NullLocator

    curves = growth(now)
    figure = Figure(figsize=(11, 4.6), layout="constrained")
    for axes, (title, kinds) in zip(figure.subplots(1, 3), PANELS.items(), strict=True):
        for kind, label in kinds.items():
            if kind in curves:
                axes.loglog(*zip(*curves[kind], strict=True), marker="o", label=label)
        known = [curves[kind] for kind in kinds if kind in curves]
        if known:
            first_rows, first_ms = known[0][0]
            ends = (first_rows, max(rows for curve in known for rows, _ in curve))
            times_ms = [first_ms * rows / first_rows for rows in ends]
            axes.loglog(ends, times_ms, color="0.6", linestyle=":", label="proportional")
        axes.set_title(title, fontsize="medium")
        axes.set_xlabel("frames of the database")
        axes.set_ylabel("ms, median of processor time")
        axes.set_xticks(list(ROWS.values()), ["30k", "100k", "300k", "660k", "5.1M"])
        axes.xaxis.set_minor_locator(NullLocator())
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_minor_locator(NullLocator())
        axes.yaxis.set_major_formatter("{x:g}")
        axes.grid(alpha=0.3)
        axes.legend(fontsize="small", loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=2)
    figure.savefig(path, dpi=110)


def main(paths: list[Path], store: bool, plot: Path | None = None) -> None:
    results: dict[str, dict[str, Any]] = {}
    for path in paths:
        text = path.read_text(encoding="utf-8")
        results |= named(json.loads(text)) if text else {}  # empty: a filter left all out
    print_times(results)
    print_ratios(results)
    now = {name: round(time_ms(result), 6) for name, result in results.items()}
    if plot is not None and growth(now):
        plot_growth(now, plot)
    stored = json.loads(STORED.read_text(encoding="utf-8")) if STORED.exists() else {}
    found = slower(now, stored)
    if store:
        STORED.write_text(json.dumps(now, indent=2) + "\n", encoding="utf-8")
    print("\nSlower than stored:" if found else "\nNothing is slower than stored.")
    for name, ratio in sorted(found.items(), key=lambda pair: -pair[1]):
        print(f"{name:44}{ratio:8.2f} times")
    if not any(name.startswith("recorded_") for name in results):
        print("Recorded motion was left out: set SPARSE_MOCAP_DATA (see .github/CONTRIBUTING.md)")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("results", nargs="+", type=Path)
    parser.add_argument("--store", action="store_true")
    parser.add_argument("--plot", type=Path)
    given = parser.parse_args()
    main(given.results, given.store, given.plot)
