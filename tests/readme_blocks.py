# SPDX-License-Identifier: GPL-3.0-or-later
"""The fenced blocks of the README, for the tests that run them."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

README = Path(__file__).resolve().parents[1] / "README.md"
FENCED = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Block:
    """A fenced block: what stands behind the fence, and its text."""

    language: str
    text: str

    @property
    def commands(self) -> list[list[str]]:
        """The words of each line that is a command, without comments."""
        lines = [shlex.split(line, comments=True) for line in self.text.splitlines() if line]
        return [words for words in lines if words[:1] == ["./dev"]]


def blocks() -> list[Block]:
    """All of them, in the README's order."""
    return [Block(*found) for found in FENCED.findall(README.read_text(encoding="utf-8"))]
