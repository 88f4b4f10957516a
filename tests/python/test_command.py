# SPDX-License-Identifier: GPL-3.0-or-later
"""The command as a process: exit codes, one line on standard error, nothing left behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import click
import pytest
from sparse_mocap.cli import app

Command = Callable[..., subprocess.CompletedProcess[str]]
posix = pytest.mark.skipif(sys.platform == "win32", reason="needs a shell or signals of POSIX")

USAGE = {
    "no command": (),
    "unknown command": ("recontruct",),
    "unknown option": ("database", "info", "x", "--jsn"),
    "no output": ("convert", "x.bvh"),
    "no source": ("database", "build", "-o", "x.smdb"),
    "unknown ending": ("convert", "x.bvh", "-o", "x.fbx"),
    "unknown frame": ("convert", "x.bvh", "-o", "x.csv", "--frame", "hip"),
    "unknown site": ("simulate", "x.bvh", "-o", "x.csv", "--sites", "left_wrist,nose"),
    "site twice": ("simulate", "x.bvh", "-o", "x.csv", "--sites", "head,head"),
    "unknown noise": ("simulate", "x.bvh", "-o", "x.csv", "--noise", "loud"),
    "position off the bone": (
        "simulate",
        "x.bvh",
        "-o",
        "x.csv",
        "--position-along-bone",
        "left_wrist=1.5",
    ),
    "rate zero": ("simulate", "x.bvh", "-o", "x.csv", "--rate", "0"),
    "unknown method": ("reconstruct", "--database", "x", "x", "-o", "x.bvh", "--method", "magic"),
    "unknown preset": ("reconstruct", "--database", "x", "x", "-o", "x.bvh", "--preset", "magic"),
    "scenario four": ("evaluate", "--database-source", "x", "--scenario", "4"),
}


@pytest.mark.parametrize("name", USAGE)
def test_wrong_usage_is_code_2(command: Command, name: str) -> None:
    done = command(*USAGE[name])
    assert done.returncode == 2, done.stderr
    assert "Traceback" not in done.stderr
    assert done.stderr != ""


def files(tmp_path: Path) -> dict[str, Path]:
    texts = {
        "broken.bvh": "HIERARCHY\nROOT Hips\n{\n  OFFSET 1 two 3\n",
        "chair.bvh": "HIERARCHY\nROOT leg\n{\nOFFSET 0 0 0\nCHANNELS 3 Xrotation Yrotation"
        " Zrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 3\nFrame Time: 0.01\n"
        "0 0 0\n0 0 0\n0 0 0\n",
        "broken.smdb": "PK\x03\x04 no database",
        "bad.csv": "time_s,sensor,ax,ay,az\n0,left_wrist,1,2,3\n0.1,left_wrist,1,x,3\n",
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    return {name: tmp_path / name for name in texts}


FAULTS = {
    "missing motion": (("convert", "{}/no.bvh", "-o", "{}/o.bvh"), "no.bvh"),
    "broken motion": (("convert", "{}/broken.bvh", "-o", "{}/o.bvh"), "broken.bvh:4:"),
    "no person": (("simulate", "{}/chair.bvh", "-o", "{}/o.csv"), ""),
    "no motion file": (("convert", "{}/bad.csv", "-o", "{}/o.bvh"), "bad.csv"),
    "missing source": (("database", "build", "{}/no", "-o", "{}/o.smdb"), "no"),
    "nothing excluded away": (
        ("database", "build", "{}", "-o", "{}/o.smdb", "--exclude", "*"),
        "excluded",
    ),
    "fps of a database": (("database", "build", "{}", "-o", "{}/o.smdb", "--fps", "-1"), "-1"),
    "missing database": (("database", "info", "{}/no.smdb"), "no.smdb"),
    "broken database": (("database", "info", "{}/broken.smdb"), "broken.smdb"),
    "folder as database": (("database", "info", "{}"), ""),
    "skeleton of no database": (
        ("convert", "{good}", "-o", "{}/o.csv", "--skeleton", "{}/broken.smdb"),
        "broken.smdb",
    ),
    "unwritable": (("convert", "{good}", "-o", "{}/no/o.bvh"), "o.bvh: No such"),
    "unwritable table": (("simulate", "{good}", "-o", "{}/no/o.csv"), "o.csv: No such"),
    "bad take": (
        ("reconstruct", "--database", "{db}", "{}/bad.csv", "-o", "{}/o.bvh"),
        "bad.csv:3: ay is 'x'",
    ),
    "missing take": (
        ("reconstruct", "--database", "{db}", "{}/no.csv", "-o", "{}/o.bvh"),
        "no.csv",
    ),
    "place of no sensor": (
        ("evaluate", "--database-source", "{}/no", "--scenario", "1"),
        "no",
    ),
    "no such test": (
        ("evaluate", "--database-source", "{lib}", "--scenario", "1", "--tests", "nothing*"),
        "nothing",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_what_is_wrong_with_the_input_is_one_line_and_code_1(
    command: Command,
    name: str,
    tmp_path: Path,
    performance: Path,
    database_path: Path,
    library: Path,
) -> None:
    before = set(files(tmp_path).values())
    arguments, problem = FAULTS[name]
    done = command(
        *(
            word.format(tmp_path, good=performance, db=database_path, lib=library)
            for word in arguments
        )
    )
    assert done.returncode == 1, done.stderr
    assert len(done.stderr.splitlines()) == 1, done.stderr
    assert done.stderr.startswith("sparse-mocap: ")
    assert problem in done.stderr
    assert done.stdout == ""
    assert set(tmp_path.iterdir()) == before


def test_success_is_code_0_and_quiet_on_standard_error(
    command: Command, performance: Path, tmp_path: Path
) -> None:
    done = command("simulate", performance, "-o", tmp_path / "take.csv")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_a_database_is_never_half_replaced(
    command: Command, database_path: Path, tmp_path: Path
) -> None:
    target = tmp_path / "db.smdb"
    target.write_bytes(database_path.read_bytes())
    broken = files(tmp_path)["broken.bvh"]
    assert command("database", "build", broken, "-o", target).returncode == 1
    assert target.read_bytes() == database_path.read_bytes()


@posix
def test_a_closed_pipe_is_no_traceback(database_path: Path) -> None:
    code = f"{sys.executable} -m sparse_mocap database info {database_path} --json | head -c 1"
    done = subprocess.run(["sh", "-c", code], capture_output=True, text=True, check=False)
    assert "Traceback" not in done.stderr


STOPPED_BUILD = """
import os, signal, sys
from sparse_mocap.cli import console, main

real = console.import_bar

def interrupting(label):
    class Bar:
        def __enter__(self):
            self.bar = real(label)
            self.callback, details = self.bar.__enter__()
            return self.call, details
        def call(self, done, total, what):
            if done == 3:
                os.kill(os.getpid(), signal.SIGINT)
            return self.callback(done, total, what)
        def __exit__(self, *error):
            return self.bar.__exit__(*error)
    return Bar()

console.import_bar = interrupting
sys.exit(main(sys.argv[1:]))
"""


@posix
def test_ctrl_c_in_a_build_leaves_no_file(library: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", STOPPED_BUILD, "database", "build", str(library),
         "-o", str(tmp_path / "db.smdb")],
        capture_output=True, text=True, timeout=60, check=False,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    assert done.returncode == 128 + signal.SIGINT
    assert done.stderr.splitlines() == ["sparse-mocap: cancelled"]
    assert list(tmp_path.iterdir()) == []


def test_patterns_are_not_replaced_by_names_of_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """On Windows, click replaces * by the names of what is in the folder unless told otherwise."""
    windows = SimpleNamespace(**{**vars(os), "name": "nt"})
    monkeypatch.setattr(click.core, "os", windows)
    for name in ("a.txt", "b.txt"):
        (tmp_path / name).write_bytes(b"")
    monkeypatch.chdir(tmp_path)
    words = ["database", "build", ".", "-o", "x.smdb", "--exclude", "*.txt"]
    monkeypatch.setattr(sys, "argv", ["sparse-mocap", *words])
    assert app.run() == 1
    assert "holds no motion file" in capsys.readouterr().err
