# SPDX-License-Identifier: GPL-3.0-or-later
"""Output of commands: results on standard output, progress and warnings on standard error."""

from __future__ import annotations

import json
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.measure import Measurement
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeRemainingColumn,
)
from rich.table import Table

from .. import ProgressReport
from ..files import write_text

__all__ = [
    "figures_of",
    "import_bar",
    "interrupted",
    "print_table",
    "progress_bar",
    "status_line",
    "warn",
    "write_json",
]

ProgressCallback = Callable[[int, int, str], bool]
DetailsCallback = Callable[[ProgressReport], None]

_MOST_WARNINGS = 10


@contextmanager
def progress_bar(label: str) -> Iterator[ProgressCallback]:
    """Yields a callback that updates a bar, on a terminal, and returns False after Ctrl-C."""
    console = Console(stderr=True)
    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        TextColumn("{task.fields[what]}", table_column=None),
        console=console,
        disable=not console.is_terminal,
        transient=True,
    )
    with interrupted() as stop, bar:
        task = bar.add_task(label, total=None, what="")

        def callback(done: int, total: int, what: str) -> bool:
            bar.update(task, completed=done, total=total, what=what[:40])
            return not stop.is_set()

        yield callback


@contextmanager
def import_bar(label: str) -> Iterator[tuple[ProgressCallback, DetailsCallback]]:
    """Like progress_bar, for imports: shows files, frames, MB/s and the time left.

    Yields the callbacks ``progress`` and ``details``.
    """
    console = Console(stderr=True)
    bar = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.fields[figures]}"),
        TimeRemainingColumn(),
        TextColumn("{task.fields[what]}"),
        console=console,
        disable=not console.is_terminal,
        transient=True,
    )
    with interrupted() as stop, bar:
        task = bar.add_task(label, total=None, what="", figures="")
        start = time.perf_counter()

        def details(report: ProgressReport) -> None:
            bar.update(
                task,
                completed=report.bytes,
                total=report.num_bytes or None,
                figures=figures_of(report, time.perf_counter() - start),
                what=report.what[:40],
            )

        yield lambda done, total, what: not stop.is_set(), details


def figures_of(report: ProgressReport, elapsed_s: float) -> str:
    """Returns the text beside an import's bar: files, frames, MB/s."""
    speed = report.bytes / 1e6 / elapsed_s if elapsed_s > 0 else 0.0
    return f"{report.files}/{report.num_files} files, {report.frames} frames, {speed:.1f} MB/s"


@contextmanager
def interrupted() -> Iterator[threading.Event]:
    """Yields an event that Ctrl-C sets; a second Ctrl-C interrupts as usual."""
    event = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield event
        return
    before = signal.getsignal(signal.SIGINT)

    def stop(number: int, frame: Any) -> None:
        event.set()
        signal.signal(signal.SIGINT, before)

    signal.signal(signal.SIGINT, stop)
    try:
        yield event
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def status_line() -> Iterator[Callable[[str], None]]:
    """Yields a function that replaces the status line, on a terminal."""
    console = Console(stderr=True, highlight=False)
    if not console.is_terminal:
        yield lambda text: None
        return
    with console.status("") as status:
        yield status.update


def warn(lines: Sequence[str]) -> None:
    """Prints the first warnings, and how many more there are."""
    for line in lines[:_MOST_WARNINGS]:
        click.echo(f"warning: {' '.join(line.split())}", err=True)
    if len(lines) > _MOST_WARNINGS:
        click.echo(f"warning: and {len(lines) - _MOST_WARNINGS} more", err=True)


def print_table(table: Table) -> None:
    """Prints a table in full width, even on a narrow terminal."""
    console = Console(highlight=False)
    width = Measurement.get(console, console.options.update(max_width=1000), table).maximum
    Console(highlight=False, width=width).print(table)


def write_json(path: Path, value: Any) -> None:
    """Writes a JSON file atomically."""
    text = json.dumps(value, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
    # Half characters, which file names may hold, become JSON's own escapes.
    write_text(path, text.encode("utf-8", "backslashreplace").decode())
