# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs programs on Windows with the packed module, as `./dev windows VERSION` does, under Wine."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

Windows = Callable[..., str]
ROOT = Path(__file__).resolve().parents[2]


def on_windows(path: Path) -> str:
    """The name of a file of this machine there."""
    return f"Z:{path}"


@pytest.fixture(params=["3.11", "3.13"])
def windows(request: pytest.FixtureRequest) -> Windows:
    """Runs a Python program there and returns what it printed."""

    def run(*arguments: object) -> str:
        words = [on_windows(word) if isinstance(word, Path) else str(word) for word in arguments]
        done = subprocess.run(
            [ROOT / "dev", "windows", request.param, *words],
            stdout=subprocess.PIPE,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stdout
        return done.stdout

    return run
