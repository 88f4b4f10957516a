# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests share: a small generated library, its database, and ways to run commands."""

from __future__ import annotations

import contextlib
import importlib
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
import sparse_mocap
from click.testing import CliRunner, Result
from loaded_module import loaded_module
from real_data import NOT_SET, real_data_folder
from sparse_mocap.cli.app import app
from sparse_mocap.demo_motions import generate_library, generate_performance

FOR_DEVELOPERS = [
    "accuracy", "demo", "test_accuracy_table.py", "test_corpus.py", "test_fourth_method.py",
    "test_house_rules.py", "test_layers.py", "test_macos_modules.py", "test_mutants.py",
    "test_packaged_modules.py", "test_packaging.py", "test_phone_table.py", "test_public_names.py",
    "test_readme.py",
    "test_tested_modules.py", "test_words.py",
]  # fmt: skip
"""What tests the sources and the tools for them, which need Linux."""

collect_ignore = [] if sys.platform == "linux" else FOR_DEVELOPERS

ACTORS = ("ada", "bruno")
CLIPS = ("walk_01", "walk_02", "squat_01", "squat_02", "kickleft_01", "kickright_01")


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Name the module that the tests had; their own processes found it as this one does."""
    with contextlib.suppress(ImportError):
        importlib.import_module("sparse_mocap._core")
    terminalreporter.write_line(loaded_module())


@pytest.fixture(autouse=True)
def no_remembered_mappings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What the user of this machine told of their rigs is not the tests' business."""
    monkeypatch.setenv("SPARSE_MOCAP_MAPPINGS", str(tmp_path / "mappings"))


@pytest.fixture(scope="session")
def library(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Twelve generated clips: two actors, four classes, two of which have one clip an actor."""
    everything = tmp_path_factory.mktemp("everything")
    generate_library(everything)
    folder = tmp_path_factory.mktemp("library")
    for actor in ACTORS:
        for clip in CLIPS:
            shutil.copy(everything / f"{actor}_{clip}.bvh", folder)
    return folder


@pytest.fixture(scope="session")
def performance(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return generate_performance(tmp_path_factory.mktemp("performance") / "performance.bvh")


@pytest.fixture(scope="session")
def database_path(library: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("database") / "library.smdb"
    sparse_mocap.build_database([library], path, mirror=True)
    return path


@pytest.fixture(scope="session")
def database(database_path: Path) -> sparse_mocap.MotionDatabase:
    return sparse_mocap.MotionDatabase(database_path)


@pytest.fixture(scope="session")
def take_path(performance: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    motion, _ = sparse_mocap.standard_motion(sparse_mocap.read_motion(performance)[0])
    sites = ["left_wrist", "right_wrist", "left_ankle", "right_ankle"]
    path = tmp_path_factory.mktemp("take") / "take.csv"
    sparse_mocap.write_take(path, sparse_mocap.simulated(motion, sites, 100.0))
    return path


@pytest.fixture(scope="session")
def real_data() -> Path:
    """The folder of recorded motions and sensors, which are no part of the repository."""
    folder = real_data_folder()
    if folder is None:
        pytest.skip(NOT_SET)
    return folder


@pytest.fixture
def cli() -> Callable[..., Result]:
    """Runs a command in this process."""

    def call(*arguments: object) -> Result:
        return CliRunner().invoke(app, [str(argument) for argument in arguments])

    return call


@pytest.fixture
def command() -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs a command as a process of its own."""

    def call(*arguments: object) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "sparse_mocap", *map(str, arguments)],
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
            stdin=subprocess.DEVNULL,
        )

    return call
