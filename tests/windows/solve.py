# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves the same takes wherever it runs: python solve.py LIBRARY PERFORMANCE.bvh OUTPUT.npz."""

import json
import sys
import tempfile
from pathlib import Path

import numpy as np
import sparse_mocap

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from loaded_module import loaded_module

SITES = ["left_wrist", "right_wrist", "left_ankle", "right_ankle"]
RUNS = (("path_regression", False), ("path_regression", True), ("tautges2011", False))


def main(library: Path, performance: Path, output: Path) -> None:
    motion, _ = sparse_mocap.standard_motion(sparse_mocap.read_motion(performance)[0])
    found: dict[str, np.ndarray] = {}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "library.smdb"
        sparse_mocap.build_database([library], path, mirror=True)
        database = sparse_mocap.MotionDatabase(path)
        found["clips"] = np.array(
            json.dumps([(clip.name, clip.begin, clip.end) for clip in database.clips])
        )
        for name in ("angles", "positions", "specific_force_end"):
            found[f"database {name}"] = np.array(database.array(name))
        take_path = Path(folder) / "take.csv"
        sparse_mocap.write_take(take_path, sparse_mocap.simulated(motion, SITES, 100.0))
        found["take"] = np.frombuffer(take_path.read_bytes(), np.uint8)
        take = sparse_mocap.read_take(take_path)
        for method, best in RUNS:
            solved = sparse_mocap.reconstruct(take, database, method=method, best_quality=best)
            name = f"{method}, {'best' if best else 'live'} quality"
            found[name] = solved.motion.joint_positions("world")
        del database
    np.savez(output, **found)
    print(loaded_module())


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
