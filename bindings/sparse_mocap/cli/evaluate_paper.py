# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap evaluate --paper``: the evaluation of Tautges et al. 2011 as a whole."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

import click

from ..evaluation.paper import PARTS, Runs, run_part, write_document
from ..workers import processors
from .console import progress_bar
from .options import FilePath

__all__ = ["PaperChoice", "paper_options", "run_paper"]


@dataclass(frozen=True)
class PaperChoice:
    """What can be chosen of the whole evaluation."""

    more: Path | None
    output: Path
    parts: tuple[str, ...]
    every: int


def paper_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Options that only count for the whole evaluation; the command gets ``whole_paper``."""

    @functools.wraps(command)
    def with_choice(
        *args: Any,
        more_motion: Path | None,
        output: Path,
        parts: tuple[str, ...],
        every: int,
        **options: Any,
    ) -> Any:
        choice = PaperChoice(more_motion, output, parts, every)
        return command(*args, whole_paper=choice, **options)

    decorated: Callable[..., Any] = with_choice
    for option in (
        click.option(
            "--every", type=click.IntRange(1), default=1, show_default=True,
            help="With --paper alone: test every Nth clip, for a quick first look.",
        ),
        click.option(
            "--part", "parts", type=click.Choice(list(PARTS)), multiple=True,
            help="With --paper alone: run this part only. Can be repeated.",
        ),
        click.option(
            "-o", "--output", type=FilePath, default=Path("."), show_default="this folder",
            help="With --paper alone: the folder of PAPER.md.",
        ),
        click.option(
            "--more-motion", metavar="DIR", type=FilePath,
            help="With --paper alone: further motion capture for the largest databases.",
        ),
    ):  # fmt: skip
        decorated = option(decorated)
    return decorated


def run_paper(source: Path, cache: Path | None, choice: PaperChoice) -> None:
    """Runs the parts that are not done, and writes what they found."""
    kept = choice.output / "evaluations" if cache is None else cache
    with progress_bar("Evaluating") as progress, processors() as executor:
        runs = Runs(
            source,
            kept,
            more=choice.more,
            every=choice.every,
            progress=progress,
            executor=executor,
        )
        sections = {}
        for name in choice.parts or PARTS:
            click.echo(f"{name} ...", err=True)
            sections[name] = run_part(runs, name)
        written = write_document(sections, runs, choice.output, date.today().isoformat())
    click.echo(f"{written[0]}: {len(sections)} parts, {len(written) - 1} plots")
