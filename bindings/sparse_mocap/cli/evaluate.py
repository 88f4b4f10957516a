# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap evaluate``: how good reconstructions are on motion that is known."""

from __future__ import annotations

import hashlib
import json
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
from rich.table import Table

from .. import MotionDatabase, _core, build_database, mapping_folder
from ..evaluation import SCENARIOS, Evaluation, Settings, motion_files
from ..evaluation import evaluate as run_evaluation
from .console import ProgressCallback, print_table, progress_bar, warn, write_json
from .options import (
    PAPER_SITES,
    FilePath,
    Sites,
    check_presets,
    method_option,
    noise_option,
    seed_option,
)


@click.command()
@click.option(
    "--database-source", "source", metavar="DIR", type=FilePath, required=True,
    help="The folder of motion capture that is both database and tests.",
)  # fmt: skip
@click.option(
    "--scenario", type=click.IntRange(1, 3), required=True,
    help="; ".join(f"{number}: {text}" for number, text in SCENARIOS.items()) + ".",
)  # fmt: skip
@click.option(
    "--tests", metavar="GLOB", help="Files to test; without it one for each actor and class."
)
@click.option("--json", "json_path", type=FilePath, help="Writes all figures.")
@click.option("--plots", type=FilePath, help="Writes pictures of the errors into this folder.")
@method_option
@click.option(
    "--preset", "presets", multiple=True, help="May be repeated.  [default: default, paper]"
)
@click.option("--offline", is_flag=True, help="Runs each preset offline too.")
@click.option("--gyroscopes", is_flag=True, help="Sensors have gyroscopes, which are used.")
@click.option("--sites", type=Sites(), default=PAPER_SITES, help="Sensor locations.")
@noise_option
@seed_option
@click.option("--cache", type=FilePath, help="Keeps the database here for the next evaluation.")
def evaluate(
    source: Path,
    scenario: int,
    tests: str | None,
    json_path: Path | None,
    plots: Path | None,
    method: str,
    presets: tuple[str, ...],
    offline: bool,
    gyroscopes: bool,
    sites: tuple[str, ...],
    noise: str,
    seed: int,
    cache: Path | None,
) -> None:
    """Measures errors on held-out clips.

    Each clip is reconstructed from what simulated sensors read on it; the clip, its copies and
    what the scenario excludes are hidden from the database. Errors are the RMS over 21 joints in
    the heading frame, a mean over each clip's frames.
    """
    presets = presets or tuple(dict.fromkeys(("default", _paper_preset(method))))
    check_presets(method, presets)
    settings = Settings(scenario, method, presets, offline, tests, sites, noise, seed, gyroscopes)
    with progress_bar("Evaluating") as progress, _database(source, cache, progress) as database:
        found = run_evaluation(database, source, settings, progress)
    if json_path is not None:
        write_json(json_path, found.as_dict())
    if plots is not None:
        from ..plots import plot_evaluation

        plot_evaluation(found, plots)
    warn([f"not tested: {line}" for line in found.left_out])
    _show(found)


def _paper_preset(method: str) -> str:
    from .. import preset_names

    return "paper" if "paper" in preset_names(method) else "default"


@contextmanager
def _database(
    source: Path, cache: Path | None, progress: ProgressCallback
) -> Iterator[MotionDatabase]:
    """Gives the database of a folder with mirrored copies, a kept one if nothing changed."""
    with tempfile.TemporaryDirectory(prefix="sparse_mocap_") as temporary:
        path = Path(temporary) / "evaluation.smdb"
        if cache is not None:
            cache.mkdir(parents=True, exist_ok=True)
            path = cache / f"evaluation_{_fingerprint(source)}.smdb"
        if not path.exists():
            build_database(
                [source], path, mirror=True, mappings=mapping_folder(), progress=progress
            )
        yield MotionDatabase(path)


def _fingerprint(source: Path) -> str:
    files = {path for same_name in motion_files(source).values() for path in same_name}
    files |= set(source.rglob("*.[aA][sS][fF]"))
    files.add(Path(_core.__file__))  # another build may build another database
    seen = [[str(path), path.stat().st_size, path.stat().st_mtime_ns] for path in sorted(files)]
    return hashlib.sha256(json.dumps(seen).encode()).hexdigest()[:12]


def _show(found: Evaluation) -> None:
    settings = found.settings
    click.echo(
        f"Scenario {found.scenario}: {SCENARIOS[found.scenario]}; {len(found.tests)} clips, "
        f"{settings['method']}, noise {settings['noise']}. Errors in cm.\n"
    )
    print_table(_summary(found))
    classes = {method: found.class_errors_cm(method) for method in found.methods}
    joints = {method: found.joint_errors_cm(method) for method in found.methods}
    for kind, errors in (("class", classes), ("joint", joints)):
        click.echo()
        print_table(_breakdown(kind, errors))


def _summary(found: Evaluation) -> Table:
    table = Table("method", box=None, pad_edge=False)
    for name in ("mean", "median", "90 %", "jerk (km/s³)", "latency (ms)"):
        table.add_column(name, justify="right")
    for method in found.methods:
        figures: dict[str, Any] = found.summary(method)
        late = figures["latency_ms"]
        table.add_row(
            method,
            *(f"{figures[key]:.2f}" for key in ("mean_cm", "median_cm", "p90_cm")),
            f"{figures['jerk_kmps3']:.3f}",
            "" if late is None else f"{late:.0f}",
        )
    return table


def _breakdown(kind: str, errors: dict[str, dict[str, float]]) -> Table:
    table = Table(kind, box=None, pad_edge=False)
    for method in errors:
        table.add_column(method, justify="right")
    for label in next(iter(errors.values())):
        table.add_row(label, *(f"{values[label]:.1f}" for values in errors.values()))
    return table
