# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole evaluation of the paper: run in parts, kept, ended and taken up, written and drawn."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result
from sparse_mocap import Cancelled
from sparse_mocap.evaluation import Contender, Content, Settings, evaluate
from sparse_mocap.evaluation.paper import PARTS, Lines, Runs, run_part, runs
from sparse_mocap.evaluation.paper.common import PAPER, difference, plain

Cli = Callable[..., Result]


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("kept")


def test_every_part_is_written_and_drawn(
    library: Path, kept: Path, tmp_path: Path, cli: Cli
) -> None:
    result = cli(
        "evaluate", "--paper", "--database-source", library, "--every", 8, "--cache", kept,
        "-o", tmp_path,
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    text = (tmp_path / "PAPER.md").read_text(encoding="utf-8")
    assert text.count("\n## ") == 1 + len(PARTS)
    assert "**One clip in 8 alone is tested, where a part does not say more.**" in text
    assert "(1 clip tested.)" in text
    assert "nan" not in text
    pictures = set(re.findall(r"!\[.*\]\((.*)\)", text))
    assert len(pictures) > 8
    for picture in pictures:
        assert (tmp_path / picture).read_bytes().startswith(b"\x89PNG")
    for line in text.splitlines():
        if line.startswith("| `tautges2011`, as published |"):
            assert re.search(r"\d+\.\d", line)


def test_what_is_done_is_not_done_again(
    library: Path, kept: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings = plain(1, PAPER, tests="bruno_walk_01.bvh")
    first = Runs(library, kept).evaluation(settings)

    def fail(*words: object) -> None:
        raise AssertionError("evaluated again")

    monkeypatch.setattr(runs, "evaluate", fail)
    assert Runs(library, kept).evaluation(settings) == first
    with pytest.raises(AssertionError, match="again"):
        Runs(library, kept).evaluation(plain(3, PAPER, tests="bruno_walk_01.bvh"))


def test_an_evaluation_of_all_clips_takes_the_place_of_one_of_some(
    library: Path, kept: Path
) -> None:
    settings = plain(1, PAPER, tests="ada_*_01.bvh")
    assert len(Runs(library, kept, every=2).evaluation(settings)["tests"]) == 2
    everything = Runs(library, kept).evaluation(settings)
    assert len(everything["tests"]) == 4
    assert Runs(library, kept, every=2).evaluation(settings) == everything


def test_a_run_that_is_ended_keeps_what_it_has(library: Path, kept: Path) -> None:
    asked: list[str] = []

    def progress(done: int, total: int, what: str) -> bool:
        asked.append(what)
        return False

    before = set((kept / "runs").iterdir())
    ended = Runs(library, kept, progress=progress)
    with pytest.raises(Cancelled):
        ended.evaluation(plain(2, PAPER, tests="bruno_squat_0*.bvh"))
    assert set((kept / "runs").iterdir()) == before
    assert asked


def test_figures_are_those_of_the_evaluation(library: Path, kept: Path) -> None:
    own = Runs(library, kept)
    settings = Settings(1, (PAPER,), tests="*_walk_01.bvh", with_baselines=False)
    found, direct = own.evaluation(settings), evaluate(own.database(), library, settings)
    told = [test.results[PAPER.label].root_frame_errors_cm.mean() for test in direct.tests]
    assert found["methods"][PAPER.label]["root_frame"]["mean_cm"] == pytest.approx(np.mean(told))
    by_frame = found["tests"][0]["root_frame_by_frame_cm"][PAPER.label]
    assert np.mean(by_frame) == pytest.approx(told[0], abs=0.01)


def test_differences_are_paired_over_the_clips() -> None:
    tests = [{"root_frame_cm": {"a": a, "b": b}} for a, b in ((3, 1), (5, 2), (8, 4))]
    off, half = difference({"tests": tests}, "a", "b")
    assert off == pytest.approx(3.0)
    assert half == pytest.approx(1.96 * np.std([2, 3, 4], ddof=1) / np.sqrt(3))


def test_a_histogram_shares_out_all_frames(library: Path, kept: Path) -> None:
    section = run_part(Runs(library, kept, every=8), "histogram")
    drawn = section.plots["fig09a_published"]
    assert isinstance(drawn, Lines)
    for edges, shares in drawn.curves.values():
        assert sum(shares) == pytest.approx(100.0)
        np.testing.assert_allclose(np.diff(edges), 0.5)


def test_a_database_can_be_of_some_clips(library: Path, kept: Path) -> None:
    own = Runs(library, kept)
    known = Content(actors=("ada",), classes=("walk*",), with_mirrored=False)
    settings = plain(1, Contender("m", "tautges2011"), tests="bruno_walk_01.bvh", known=known)
    (test,) = own.evaluation(settings)["tests"]
    shown = len(own.database().clips) - test["excluded_clips"]
    assert shown == 2 * 3  # two walks, each at three tempos
    rows = own.database().array("angles")
    walks = [c for c in own.database().clips if c.source.startswith("ada_walk")]
    counted = sum(c.end - c.begin for c in walks if c.tempo == 1.0 and not c.is_mirrored)
    assert own.count(known) == counted < len(rows)


def test_the_whole_evaluation_needs_no_scenario_and_others_do(library: Path, cli: Cli) -> None:
    result = cli("evaluate", "--database-source", library)
    assert result.exit_code == 2
    assert "--scenario" in result.output


def test_kept_figures_are_json_without_gaps(library: Path, kept: Path) -> None:
    def fail(constant: str) -> None:
        raise AssertionError(f"{constant} is not JSON")

    Runs(library, kept).evaluation(plain(1, PAPER, tests="bruno_walk_01.bvh"))
    told = [
        json.loads(path.read_text(encoding="utf-8"), parse_constant=fail)
        for path in (kept / "runs").iterdir()
    ]
    evaluations = [found for found in told if isinstance(found, dict) and "tests" in found]
    assert evaluations
    for found in evaluations:
        assert set(found) == {"frames", "rate_hz", "methods", "tests", "left_out"}
