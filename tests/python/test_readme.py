# SPDX-License-Identifier: GPL-3.0-or-later
"""What the README tells to type works; its Python for Blender runs in tests/blender."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import click
import guided_body
import held_poses
import pytest
import sparse_mocap
from readme_blocks import README, Block, blocks
from sparse_mocap.capture.session import FOLDER_VARIABLE
from sparse_mocap.cli.app import app

ROOT = README.parent
HERE = {"PYTHONPATH": str(Path(sparse_mocap.__file__).parents[1])}
"""The commands run in another folder."""
WORDS_BEFORE = {"cli": 2, "evaluate": 1}
"""What stands before the command's own words, by the verb of ./dev."""

NOT_RUN = {
    "./dev demo": "renders for minutes; its steps have tests of their own",
    "./dev test": "is what runs this",
    "./dev evaluate --paper": "runs for many minutes; test_paper_evaluation.py runs it",
    "./dev accuracy hdm05/": "writes a file of the repository; test_accuracy_table.py runs it",
}
NOT_COMMANDS = {
    "core/sparse_mocap/": "the map of the folders",
}
"""The beginnings of blocks that are nothing to type."""

NO_SENSORS = {
    "--port": "/dev/ttyUSB0",
    "--attach": "capture",
    "--recover": "take.capture",
}
"""Options that need sensors, and what the one line says where there are none."""


def test_every_block_is_run_or_has_its_reason() -> None:
    told = blocks()
    assert len(told) >= 6
    for block in told:
        lines = [line for line in block.text.splitlines() if line.strip()]
        is_known = block.text.startswith(tuple(NOT_COMMANDS)) and not block.commands
        assert (
            block.language == "python"
            or is_known
            or (block.language in ("sh", "text") and len(block.commands) == len(lines))
        ), block.text


def test_what_is_not_run_is_there() -> None:
    told = [" ".join(words) for block in blocks() for words in block.commands]
    assert set(NOT_RUN) <= set(told)
    for beginning in NOT_COMMANDS:
        assert any(block.text.startswith(beginning) for block in blocks())


def test_the_commands_work_in_their_order(
    library: Path, performance: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "runtime"))
    shutil.copytree(library, tmp_path / "mocap")
    shutil.copy(performance, tmp_path / "clip.bvh")
    shutil.copy(library / "ada_walk_01.bvh", tmp_path / "walk.bvh")
    run = []
    for block in blocks():
        if any("calibrate" in words for words in block.commands):
            record_guided_movements(block, tmp_path)
        if any("calibrate-poses" in words for words in block.commands):
            record_held_poses(tmp_path)
        if block.language == "python" and "import bpy" not in block.text:
            run_python(block.text, tmp_path)
        for words in block.commands:
            if " ".join(words) not in NOT_RUN:
                check(words[WORDS_BEFORE[words[1]] :], tmp_path)
                run.append(words[1:])
    assert len(run) >= 12


def record_guided_movements(block: Block, folder: Path) -> None:
    """The take of somebody who did at each time what the block says."""
    words = next(words for words in block.commands if "calibrate" in words)
    arms, legs = (words[words.index(option) + 1].split(":") for option in ("--arms", "--legs"))
    guided_body.main(folder / "take.csv", folder / "planted.npy", arms[0], legs[0], legs[1])


def record_held_poses(folder: Path) -> None:
    """The take of somebody who held each pose when the block says, and another one."""
    for name in ("poses.csv", "trackers.csv"):
        sparse_mocap.write_take(folder / name, held_poses.recorded(3.0, 2.0, 5.0))


def run_python(text: str, folder: Path) -> None:
    subprocess.run([sys.executable, "-c", text], cwd=folder, env=os.environ | HERE, check=True)


def check(line: list[str], folder: Path) -> None:
    """The command does what it is for, or says in one line which sensors are not there."""
    if line[0] == "emulate":
        check_emulator(line, folder)
        return
    done = subprocess.run(
        [sys.executable, "-m", "sparse_mocap", *line],
        cwd=folder,
        env=os.environ | HERE,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    needed = [NO_SENSORS[word] for word in line if word in NO_SENSORS]
    if not needed:
        assert done.returncode == 0, f"{line}: {done.stderr}"
        return
    assert done.returncode == 1, f"{line}: {done.stderr}"
    assert needed[0] in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1, done.stderr


def check_emulator(line: list[str], folder: Path) -> None:
    """It goes on until somebody opens its port."""
    command = [sys.executable, "-m", "sparse_mocap", *line]
    with subprocess.Popen(
        command, cwd=folder, env=os.environ | HERE, stdout=subprocess.PIPE, text=True
    ) as emulator:
        assert emulator.stdout is not None
        assert emulator.stdout.readline().startswith("/dev/")
        emulator.terminate()


def inline_commands() -> list[list[str]]:
    """What the running text tells to type, in backquotes, without ./dev cli."""
    text = re.sub(r"^```.*?^```$", "", README.read_text(encoding="utf-8"), flags=re.M | re.S)
    found = re.findall(r"`\./dev cli ([^`]+)`", text)
    return [shlex.split(" ".join(words.split())) for words in found]


def options_of(words: list[str]) -> tuple[click.Command, list[str]]:
    """The command that the words name, and the options that they give it."""
    command: click.Command | None = app
    rest = list(words)
    while isinstance(command, click.Group):
        command = command.get_command(click.Context(command), rest.pop(0))
    assert command is not None, words
    return command, [word for word in rest if word.startswith("--")]


def test_commands_in_the_text_exist_with_their_options() -> None:
    told = inline_commands()
    assert told
    for words in told:
        command, given = options_of(words)
        known = {name for option in command.params for name in option.opts}
        assert set(given) <= known, words


def test_every_verb_of_dev_that_it_names_exists() -> None:
    verbs = set(re.findall(r"\./dev ([a-z]+)", README.read_text(encoding="utf-8")))
    told = subprocess.run([ROOT / "dev", "help"], capture_output=True, text=True, check=True)
    assert verbs
    assert verbs <= {line.split()[0] for line in told.stdout.splitlines() if line.strip()}
