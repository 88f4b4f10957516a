# SPDX-License-Identifier: GPL-3.0-or-later
"""What the README tells to type works."""

from __future__ import annotations

import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def blocks(language: str) -> list[str]:
    readme = ROOT / "README.md"
    if not readme.exists():
        pytest.skip("no README here")
    text = readme.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def commands() -> list[list[str]]:
    """The commands of this package in the README's order, without the ./dev before them."""
    lines = [
        shlex.split(line, comments=True) for block in blocks("sh") for line in block.split("\n")
    ]
    words = {"cli": 2, "evaluate": 1}
    return [line[words[line[1]] :] for line in lines if line[:1] == ["./dev"] and line[1] in words]


def test_the_commands_work_in_their_order(library: Path, performance: Path, tmp_path: Path) -> None:
    for folder in ("mocap", "hdm05"):
        shutil.copytree(library, tmp_path / folder)
    shutil.copy(performance, tmp_path / "clip.bvh")
    told = commands()
    assert {line[0] for line in told} >= {"database", "simulate", "reconstruct", "evaluate"}
    for line in told:
        if line[0] == "emulate":
            check_emulator(line, tmp_path)
            continue
        done = subprocess.run(
            [sys.executable, "-m", "sparse_mocap", *line],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        # Without the sensors it is the input that is at fault, never the usage.
        codes = (0, 1) if line[0] in ("record", "live") else (0,)
        assert done.returncode in codes, f"{line}: {done.stderr}"


def check_emulator(line: list[str], folder: Path) -> None:
    """It goes on until somebody opens its port."""
    command = [sys.executable, "-m", "sparse_mocap", *line]
    with subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, text=True) as emulator:
        assert emulator.stdout is not None
        assert emulator.stdout.readline().startswith("/dev/")
        emulator.terminate()


def test_every_verb_of_dev_that_it_names_exists() -> None:
    verbs = set(re.findall(r"\./dev ([a-z]+)", (ROOT / "README.md").read_text(encoding="utf-8")))
    told = subprocess.run([ROOT / "dev", "help"], capture_output=True, text=True, check=True)
    assert verbs
    assert verbs <= {line.split()[0] for line in told.stdout.splitlines() if line.strip()}


def test_its_python_is_python() -> None:
    for block in blocks("python"):
        compile(block, "README.md", "exec")
