# SPDX-License-Identifier: GPL-3.0-or-later
"""The faults that ``./dev mutants`` makes still apply to the sources."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest

RUNNER = Path(__file__).resolve().parents[1] / "mutants" / "run.py"


@pytest.fixture(scope="module")
def runner() -> ModuleType:
    spec = importlib.util.spec_from_file_location("mutants_runner", RUNNER)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


def test_every_mutant_changes_one_place_and_names_its_tests(runner: ModuleType) -> None:
    mutants = runner.mutants()
    assert len({mutant.name for mutant in mutants}) == len(mutants) > 10
    assert [mutant.problem() for mutant in mutants if mutant.problem()] == []
    assert [mutant.name for mutant in mutants if mutant.find == mutant.replace] == []
    assert all(mutant.tests for mutant in mutants)


@pytest.mark.parametrize(
    ("changed", "problem"),
    [
        ({"find": "no such text"}, "occurs 0 times in CMakeLists.txt"),
        ({"find": "project"}, "times in CMakeLists.txt instead of once"),
        ({"find": ""}, "times in CMakeLists.txt instead of once"),
        ({"file": "none.cpp"}, "occurs 0 times in none.cpp"),
        ({"tests": ["tests/python/none.py::test"]}, "there is no tests/python/none.py"),
    ],
)
def test_a_mutant_that_no_longer_applies_is_named(
    runner: ModuleType, changed: dict[str, object], problem: str
) -> None:
    entry = {
        "name": "fault",
        "breaks": "it",
        "file": "CMakeLists.txt",
        "find": "enable_testing()",
        "replace": "",
        "tests": ["tests/python"],
    }
    assert runner.Mutant(**entry).problem() == ""
    said = runner.Mutant(**(entry | changed)).problem()
    assert said.startswith("fault: ")
    assert problem in said


def test_only_a_mutant_that_a_test_notices_counts_as_killed(
    runner: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    verdicts = {
        "noticed": runner.Verdict(["test_a.py::test_b", "test_a.py::test_c"]),
        "unnoticed": runner.Verdict(),
        "crashed": runner.Verdict(["test_a.py::test_b"], "pytest ended with code -11"),
        "does not build": runner.Verdict(["test_a.py::test_b"]),
    }
    applied: list[str] = []

    def build() -> None:
        if applied[-1] == "does not build":
            raise runner.Broken("error: expected ';'")

    monkeypatch.setattr(runner.Mutant, "apply", lambda self: applied.append(self.name))
    monkeypatch.setattr(runner.Mutant, "undo", lambda self: None)
    monkeypatch.setattr(runner, "build", build)
    monkeypatch.setattr(runner, "packed", lambda name: name)
    monkeypatch.setattr(runner, "verdict", lambda name, tests: verdicts[name])
    chosen = [runner.Mutant(name, "it", "file", "a", "b", []) for name in verdicts]
    assert runner.judge(chosen) == 3
    said = capsys.readouterr().out.splitlines()[1::2]
    assert [line.strip() for line in said] == [
        "killed by test_a.py::test_b and 1 more",
        "SURVIVED",
        "NO VERDICT: pytest ended with code -11",
        "NO VERDICT: error: expected ';'",
    ]
