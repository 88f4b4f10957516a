# SPDX-License-Identifier: GPL-3.0-or-later
"""Breaks a copy of the sources in each way that mutants.toml names; its tests must fail then.

Ends with code 0 when every mutant makes at least one of them fail.
"""

from __future__ import annotations

import argparse
import filecmp
import os
import re
import shutil
import subprocess
import sys
import time
import tomllib
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "build" / "mutants"
SOURCE = WORK / "source"
BUILD = SOURCE / "build" / "release"  # placed as the sources' own build is, for ccache
PACKED = WORK / "packed"
COPIED = ("CMakeLists.txt", "CMakePresets.json", "bindings", "core")
COPIED += ("tests/python", *(f"tests/{path.name}" for path in sorted(ROOT.glob("tests/*.py"))))
TEST_TIMEOUT_S = 600.0


class Broken(Exception):
    """Something that leaves nothing to judge."""


@dataclass(frozen=True)
class Mutant:
    """One edit of one file, and the tests that must notice it."""

    name: str
    breaks: str
    file: str
    find: str
    replace: str
    tests: list[str]

    def problem(self) -> str:
        """Why it does not apply to the sources; empty if it does."""
        path = ROOT / self.file
        count = path.read_text(encoding="utf-8").count(self.find) if path.is_file() else 0
        if not self.find or count != 1:
            return f"{self.name}: its text occurs {count} times in {self.file} instead of once"
        lost = [test for test in self.tests if not (ROOT / test.partition("::")[0]).exists()]
        return f"{self.name}: there is no {lost[0]}" if lost else ""

    def apply(self) -> None:
        path = SOURCE / self.file
        text = path.read_text(encoding="utf-8").replace(self.find, self.replace.lstrip("\n"))
        path.write_text(text, encoding="utf-8")

    def undo(self) -> None:
        shutil.copyfile(ROOT / self.file, SOURCE / self.file)


@dataclass
class Verdict:
    """What came of a mutant."""

    failed: list[str] = field(default_factory=list)
    """The tests that noticed it."""
    fault: str = ""
    """Why there is no verdict."""
    test_s: float = 0.0


def mutants() -> list[Mutant]:
    """All of mutants.toml."""
    table = tomllib.loads(Path(__file__).with_name("mutants.toml").read_text(encoding="utf-8"))
    return [Mutant(**entry) for entry in table["mutant"]]


# --- The copy ------------------------------------------------------------------------------------


def update_copy() -> None:
    """Makes SOURCE like the sources; what is alike keeps its time, so that little is rebuilt."""
    for name in COPIED:
        top = ROOT / name
        wanted = {path for path in (top, *top.rglob("*")) if _is_copied(path)}
        for path in wanted:
            copy = SOURCE / path.relative_to(ROOT)
            if not copy.exists() or not filecmp.cmp(path, copy, shallow=False):
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(path, copy)
        for copy in (SOURCE / name).rglob("*"):
            if _is_copied(copy) and ROOT / copy.relative_to(SOURCE) not in wanted:
                copy.unlink()


def _is_copied(path: Path) -> bool:
    return path.is_file() and path.suffix not in (".so", ".pyc")


def configure(options: list[str]) -> None:
    """Configures the build of the copy: the module alone."""
    alone = ["-DSPARSE_MOCAP_TESTS=OFF", "-DSPARSE_MOCAP_BENCHMARKS=OFF"]
    _call(["cmake", "--preset", "release", *alone, *options])


def build() -> None:
    """Builds the module of the copy as it is now. Raises Broken."""
    _call(["cmake", "--build", str(BUILD), "--target", "_core"])


def _call(command: list[str]) -> None:
    done = subprocess.run(command, cwd=SOURCE, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Broken("does not build:\n" + (done.stdout + done.stderr)[-3000:])


def packed(name: str) -> Path:
    """Returns a folder with the package and the tests as they are now, safe from later edits."""
    folder = PACKED / name
    for part in ("bindings", "tests"):
        shutil.copytree(SOURCE / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
    return folder


# --- The tests -----------------------------------------------------------------------------------


def verdict(folder: Path, tests: list[str]) -> Verdict:
    """Runs tests in a packed folder; what pytest said stays there in pytest.log."""
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-c",
               "bindings/pyproject.toml", "--rootdir", ".", *tests]  # fmt: skip
    environment = os.environ | {"PYTHONPATH": f"{folder}/bindings", "PYTHONDONTWRITEBYTECODE": "1"}
    log = folder / "pytest.log"
    begin = time.perf_counter()
    try:
        with log.open("w", encoding="utf-8") as output:
            code = subprocess.run(
                command,
                cwd=folder,
                env=environment,
                stdout=output,
                stderr=subprocess.STDOUT,
                timeout=TEST_TIMEOUT_S,
                check=False,
            ).returncode
    except subprocess.TimeoutExpired:
        return Verdict(fault=f"did not end within {TEST_TIMEOUT_S:.0f} s, see {log}")
    seconds = time.perf_counter() - begin
    failed = re.findall(r"^FAILED \S*?(\w+\.py::\S+)", log.read_text("utf-8"), re.MULTILINE)
    # Only a test that fails kills: neither an error of a fixture nor a crash is one.
    is_sound = code == (1 if failed else 0)
    return Verdict(failed, "" if is_sound else f"pytest ended with code {code}, see {log}", seconds)


def check_unbroken(chosen: list[Mutant], options: list[str]) -> None:
    """Raises Broken unless all the guarding tests pass on the sources as they are."""
    begin = time.perf_counter()
    shutil.rmtree(PACKED, ignore_errors=True)
    update_copy()
    configure(options)
    build()
    built = time.perf_counter() - begin
    found = verdict(packed("none"), sorted({test for mutant in chosen for test in mutant.tests}))
    if found.failed or found.fault:
        raise Broken(f"the tests fail without a mutant: {found.fault or ', '.join(found.failed)}")
    print(f"without a mutant all tests pass, {built:.0f} s + {found.test_s:.0f} s", flush=True)


def judge(chosen: list[Mutant]) -> int:
    """Builds a mutant while the ones before are tested; returns how many were not killed."""
    width = max(len(mutant.name) for mutant in chosen)
    waiting: deque[tuple[Mutant, float, Future[Verdict]]] = deque()
    survivors = 0

    def tell() -> None:
        nonlocal survivors
        mutant, build_s, result = waiting.popleft()
        found = result.result()
        survivors += bool(found.fault) or not found.failed
        print(line(mutant, width, build_s, found), flush=True)

    with ThreadPoolExecutor(1) as tester:
        for mutant in chosen:
            begin = time.perf_counter()
            mutant.apply()
            try:
                build()
                job = tester.submit(verdict, packed(mutant.name), mutant.tests)
            except Broken as fault:
                job = tester.submit(Verdict, fault=str(fault))
            finally:
                mutant.undo()
            waiting.append((mutant, time.perf_counter() - begin, job))
            while waiting and waiting[0][2].done():
                tell()
        while waiting:
            tell()
    return survivors


def line(mutant: Mutant, width: int, build_s: float, found: Verdict) -> str:
    """A mutant's line of the table: name, seconds to build and to test, what it breaks, verdict."""
    if found.fault:
        what = f"NO VERDICT: {found.fault}"
    elif found.failed:
        more = f" and {len(found.failed) - 1} more" if len(found.failed) > 1 else ""
        what = f"killed by {found.failed[0]}{more}"
    else:
        what = "SURVIVED"
    start = f"{mutant.name:<{width}}  {build_s:3.0f} s + {found.test_s:3.0f} s"
    return f"{start}  {mutant.breaks}\n{'':<{width}}    {what}"


def main() -> int:
    parser = argparse.ArgumentParser(prog="./dev mutants", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="only these mutants")
    parser.add_argument("--cmake", action="append", default=[], help=argparse.SUPPRESS)
    options = parser.parse_args()
    begin = time.perf_counter()
    known = {mutant.name: mutant for mutant in mutants()}
    unknown = [name for name in options.names if name not in known]
    problems = [f"no mutant is called {name}" for name in unknown]
    problems += [problem for mutant in known.values() if (problem := mutant.problem())]
    if problems:
        print("\n".join(problems), file=sys.stderr)
        return 1
    chosen = [known[name] for name in options.names] or list(known.values())
    try:
        check_unbroken(chosen, options.cmake)
    except Broken as fault:
        print(fault, file=sys.stderr)
        return 1
    survivors = judge(chosen)
    minutes = (time.perf_counter() - begin) / 60.0
    print(f"{len(chosen) - survivors} of {len(chosen)} killed in {minutes:.1f} minutes")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
