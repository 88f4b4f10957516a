# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the made part of the corpus beside this file: one small file for every rule of a format.

python tests/fuzz/make_corpus.py    (files called fuzz_NNNN were found by the fuzzers; they stay)
"""

from __future__ import annotations

from pathlib import Path

from corpus_acclaim import acclaim_files
from corpus_bvh import bvh_files
from corpus_database import database_files
from corpus_model import model_files

HERE = Path(__file__).resolve().parent / "corpus"
ENDINGS = {"bvh": ".bvh", "acclaim": ".acclaim", "database": ".smdb", "model": ".smmodel"}


def write(kind: str, files: dict[str, bytes]) -> None:
    folder = HERE / kind
    folder.mkdir(parents=True, exist_ok=True)
    for path in folder.iterdir():
        if not path.name.startswith("fuzz_"):
            path.unlink()
    written: set[bytes] = set()
    for name, content in files.items():
        if content not in written:  # some changes come to the same file
            (folder / f"{name}{ENDINGS[kind]}").write_bytes(content)
        written.add(content)
    sizes = [len(content) for content in written]
    print(f"{kind}: {len(sizes)} files, {sum(sizes)} bytes, the largest {max(sizes)}")


def main() -> None:
    write("bvh", bvh_files())
    write("acclaim", acclaim_files())
    write("database", database_files())
    write("model", model_files())


if __name__ == "__main__":
    main()
