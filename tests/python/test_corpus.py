# SPDX-License-Identifier: GPL-3.0-or-later
"""The corpus of the fuzzers is what its script makes, and what they found."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

FUZZ = Path(__file__).resolve().parents[1] / "fuzz"


@pytest.mark.parametrize("kind", ["bvh", "acclaim", "database", "model"])
def test_the_corpus_is_what_its_script_makes(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(FUZZ)
    made = getattr(importlib.import_module(f"corpus_{kind}"), f"{kind}_files")()
    files = {path.stem: path.read_bytes() for path in (FUZZ / "corpus" / kind).iterdir()}
    committed = {name: content for name, content in files.items() if not name.startswith("fuzz_")}
    assert committed.items() <= made.items()
    assert set(committed.values()) == set(made.values())
    assert len(committed) >= 100
    assert max(map(len, files.values())) < 8192
