# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the databases of recorded motion that the benchmarks run on, once.

python tests/bench/databases.py FOLDER COPIED_DATABASE

Needs the recorded data (SPARSE_MOCAP_DATA, see .github/CONTRIBUTING.md). FOLDER gets 30k.smdb,
100k.smdb, 300k.smdb and 680k.smdb, named by about how many frames they have; 5m.smdb, which holds
time-warped and perturbed copies of the last one's clips (made by the program COPIED_DATABASE, 3
GB); and queries.smdb: the clips that performances are simulated from, of which no other database
has one.
"""

from __future__ import annotations

import fnmatch
import os
import random
import shutil
import subprocess
import sys
from pathlib import Path

import sparse_mocap

SIZES = {"30k": 30_000, "100k": 100_000, "300k": 300_000}
ALL = "680k"
COPIES = "5m"
QUERY_SHARE = 23  # every so many files
FOLDERS = ("hdm05", "cmu/asf_amc", "cmu/bvh")
ARCHIVE = "bandai_namco/bandai_namco_subset.tar.xz"


def motion_files(data: Path, folder: Path) -> list[Path]:
    """Every clip, in an order that mixes the sources and is always the same."""
    unpacked = folder / "bandai_namco"
    if not unpacked.is_dir():
        partly = folder / "bandai_namco.partly"
        shutil.unpack_archive(data / ARCHIVE, partly)
        partly.rename(unpacked)
    sources = [data / name for name in FOLDERS] + [unpacked]
    files = [
        path
        for source in sources
        for path in sorted(source.rglob("*"))
        if any(fnmatch.fnmatch(path.name.lower(), ending) for ending in ("*.bvh", "*.amc"))
    ]
    random.Random(1).shuffle(files)
    return files


def build(path: Path, files: list[Path], *, copies: bool) -> sparse_mocap.MotionDatabase:
    """The database of the files, built if it is not there."""
    if not path.exists():
        report = sparse_mocap.build_database(
            files, path, mirror=copies, reverse=copies, tempo_copies=(), keep_duplicates=True
        )
        print(f"{path}: {report.num_frames} frames in {report.elapsed_s:.0f} s", flush=True)
    return sparse_mocap.MotionDatabase(path)


def first_files(files: list[Path], frames: dict[str, int], wanted: int) -> list[Path]:
    """As many of the files, from the first on, as have the wanted number of frames."""
    chosen, total = [], 0
    for path in files:
        if total >= wanted:
            break
        chosen.append(path)
        total += frames.get(path.name, 0)
    return chosen


def main(folder: Path, copied_database: Path) -> None:
    if "SPARSE_MOCAP_DATA" not in os.environ:
        sys.exit("SPARSE_MOCAP_DATA is not set: see .github/CONTRIBUTING.md")
    folder.mkdir(parents=True, exist_ok=True)
    files = motion_files(Path(os.environ["SPARSE_MOCAP_DATA"]), folder)
    searched = [path for i, path in enumerate(files) if i % QUERY_SHARE]
    build(folder / "queries.smdb", files[::QUERY_SHARE], copies=False)
    whole = build(folder / f"{ALL}.smdb", searched, copies=True)
    frames: dict[str, int] = {}
    for clip in whole.clips:
        name = Path(clip.source).name
        frames[name] = frames.get(name, 0) + clip.end - clip.begin
    for name, wanted in SIZES.items():
        build(folder / f"{name}.smdb", first_files(searched, frames, wanted), copies=True)
    copies = folder / f"{COPIES}.smdb"
    if not copies.exists():
        subprocess.run([copied_database, folder / f"{ALL}.smdb", copies], check=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
