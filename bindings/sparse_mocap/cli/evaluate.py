# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap evaluate``: measures the errors of reconstructions of known motion."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
import numpy as np
from rich.table import Table

from ..evaluation import (
    SCENARIOS,
    Contender,
    Evaluation,
    Settings,
    contenders,
    variants,
)
from ..evaluation import evaluate as run_evaluation
from ..evaluation.movement import DRIFT_AFTER_S
from ..methods import DEFAULT_METHOD, Experiment, method_info, methods, renamed_preset
from ..workers import cluster
from .console import print_table, progress_bar, warn, write_json
from .evaluate_paper import PaperChoice, paper_options, run_paper
from .evaluated_files import DEFAULT_FPS, chosen_pairs, evaluation_database, with_files
from .options import (
    PAPER_SITES,
    FilePath,
    OutputPath,
    Sites,
    channels_option,
    noise_option,
    scheduler_option,
    seed_option,
    set_option,
)

__all__ = ["evaluate"]


def _simulation_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """What the sensors give, and how well; the command gets it as ``simulation``, for Settings."""

    @functools.wraps(command)
    def with_simulation(
        *args: Any,
        sites: tuple[str, ...],
        noise: str,
        seed: int,
        channels: tuple[str, ...],
        gyroscopes: bool,
        **options: Any,
    ) -> Any:
        simulation = {"sites": sites, "noise": noise, "seed": seed, "channels": channels}
        simulation["with_gyroscopes"] = gyroscopes
        return command(*args, simulation=simulation, **options)

    sites = click.option("--sites", type=Sites(), default=PAPER_SITES, help="Sensor locations.")
    gyroscopes = click.option(
        "--gyroscopes", is_flag=True, help="Also simulate gyroscopes, and use them."
    )
    decorated: Callable[..., Any] = with_simulation
    for option in (seed_option, noise_option, sites, channels_option, gyroscopes):
        decorated = option(decorated)
    return decorated


@click.command()
@click.option(
    "--database-source", "source", metavar="DIR", type=FilePath, required=True,
    help="The folder of motion capture, for both the database and the tests.",
)  # fmt: skip
@click.option(
    "--scenario", type=click.IntRange(1, 3),
    help="; ".join(f"{number}: {text}" for number, text in SCENARIOS.items())
    + ". Must be given, except with --paper.",
)  # fmt: skip
@click.option(
    "--tests", metavar="GLOB", help="Files to test; by default one for each actor and class."
)
@click.option(
    "--train", "training", metavar="GLOB",
    help="Files to make the database and models from, not the scenario's. Needs --tests.",
)  # fmt: skip
@click.option("--json", "json_path", type=OutputPath(), help="Write all results as JSON.")
@click.option("--plots", type=FilePath, help="Write plots of the errors to this folder.")
@click.option(
    "--method", "names", type=click.Choice([method.name for method in methods()]), multiple=True,
    help="The methods to evaluate. Can be repeated.  [default: all that need only a database]",
)  # fmt: skip
@click.option(
    "--preset", "presets", multiple=True, help="The presets to evaluate. Can be repeated."
)
@set_option
@click.option(
    "--experiment", "experiments", multiple=True, metavar="NAME",
    help="Run a comparison from the method's paper; `methods NAME` lists them. Can be repeated.",
)  # fmt: skip
@click.option(
    "--paper", is_flag=True,
    help="Run all comparisons from the methods' papers. Without --scenario: all that "
    "Tautges et al. 2011 evaluate, written as PAPER.md and plots; --cache keeps what is done.",
)  # fmt: skip
@paper_options
@click.option(
    "--offline", is_flag=True, help="Also evaluate best quality, for methods that have it."
)
@_simulation_options
@click.option(
    "--fps", type=click.FloatRange(1.0, 1000.0), default=DEFAULT_FPS, show_default=True,
    help="Frames per second of the database, and so of what is reconstructed.",
)  # fmt: skip
@click.option(
    "--cache", type=FilePath, help="Folder to save the database in, for the next evaluation."
)
@scheduler_option
def evaluate(
    source: Path,
    scenario: int | None,
    tests: str | None,
    training: str | None,
    json_path: Path | None,
    plots: Path | None,
    names: tuple[str, ...],
    presets: tuple[str, ...],
    settings: tuple[tuple[str, str], ...],
    experiments: tuple[str, ...],
    paper: bool,
    offline: bool,
    simulation: dict[str, Any],
    cache: Path | None,
    scheduler: str | None,
    fps: float,
    whole_paper: PaperChoice,
) -> None:
    """Measures errors on held-out clips.

    Each clip is reconstructed from simulated sensors, without using the clip itself, its copies and
    the clips that the scenario excludes. Errors are the RMS over 21 joints in the heading frame,
    averaged over each clip's frames. How methods move is beside the truth (in
    brackets): jumps are clips with a step over 50 cm, and over three times the true ones; warnings
    are poor matches, precision and recall, where the clip's mean pose is nearer.
    """
    if scheduler is not None and cache is None:
        raise click.UsageError(
            "--scheduler needs --cache: a folder for the database that all workers can read."
        )
    if scenario is None:
        if not paper:
            raise click.UsageError("Missing option '--scenario': 1, 2 or 3.")
        run_paper(source, cache, whole_paper)
        return
    names, presets = _renamed(names, presets)
    common = Settings(scenario, tests=tests, pairs=chosen_pairs(training, tests), **simulation)
    if paper or experiments:
        runs = _comparisons(names, experiments, common)
    else:
        chosen = _contenders(names, presets, settings, offline, common.all_channels)
        runs = [("", replace(common, contenders=chosen))]
    found = _evaluated(source, runs, cache, fps, scheduler)
    _write(found, json_path, plots)
    for title, evaluation in found:
        warn([f"not tested: {line}" for line in evaluation.left_out])
        _show(title, evaluation)


def _evaluated(
    source: Path,
    runs: Sequence[tuple[str, Settings]],
    cache: Path | None,
    fps: float,
    scheduler: str | None,
) -> list[tuple[str, Evaluation]]:
    executor = nullcontext() if scheduler is None else cluster(scheduler)
    with (
        progress_bar("Evaluating") as progress,
        executor as workers,
        evaluation_database(source, cache, fps, progress, workers) as database,
    ):
        if len(runs) > 1:
            runs = with_files(database, runs)
        return [
            (title, run_evaluation(database, source, run, progress, workers)) for title, run in runs
        ]


def _comparisons(
    names: Sequence[str], experiments: Sequence[str], common: Settings
) -> list[tuple[str, Settings]]:
    """Returns the comparisons from the methods' papers, each with its title."""
    return [
        (
            f"{method}: {experiment.help}",
            replace(common, contenders=tuple(variants(method, experiment)), pairs=experiment.pairs),
        )
        for method, experiment in _experiments(names, experiments)
    ]


def _renamed(
    names: Sequence[str], presets: Sequence[str]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Returns methods and presets by their current names, with a warning for each old name."""
    kept = []
    methods_found = list(names)
    for preset in presets:
        method, same, renamed = renamed_preset(names[0] if len(names) == 1 else None, preset)
        if renamed:
            warn([renamed])
            methods_found = [name for name in methods_found if name != "tautges2011"]
            methods_found.append(method or DEFAULT_METHOD)
        elif same is not None:
            kept.append(same)
            methods_found += [] if names else [DEFAULT_METHOD]
    return tuple(dict.fromkeys(methods_found)), tuple(kept)


def _contenders(
    names: Sequence[str],
    presets: Sequence[str],
    options: Sequence[tuple[str, str]],
    offline: bool,
    channels: Sequence[str],
) -> tuple[Contender, ...]:
    wanted = names or [
        method.name
        for method in methods()
        if method.needs == ("database",) and method.can_use(channels)
    ]
    known = {preset.name for name in wanted for preset in method_info(name).presets}
    for preset in presets:
        if preset not in known:
            raise click.BadParameter(
                f"unknown preset {preset!r}; choose from {', '.join(sorted(known))}",
                param_hint="'--preset'",
            )
    return tuple(
        contenders(wanted, presets=presets, options=dict(options), with_best_quality=offline)
    )


def _experiments(names: Sequence[str], wanted: Sequence[str]) -> list[tuple[str, Experiment]]:
    """Returns the experiments with these names, or all if there are none, and their methods."""
    known = [
        (method.name, experiment)
        for method in methods()
        if not names or method.name in names
        for experiment in method.experiments
    ]
    there = [experiment.name for _, experiment in known]
    for name in wanted:
        if name not in there:
            choices = f"choose from {', '.join(there)}" if there else "these methods have none"
            raise click.BadParameter(
                f"unknown experiment {name!r}; {choices}", param_hint="'--experiment'"
            )
    return [pair for pair in known if not wanted or pair[1].name in wanted]


def _write(
    found: Sequence[tuple[str, Evaluation]], json_path: Path | None, plots: Path | None
) -> None:
    if json_path is not None:
        reports = [{"title": title} | evaluation.as_dict() for title, evaluation in found]
        write_json(json_path, found[0][1].as_dict() if len(found) == 1 else reports)
    if plots is not None:
        from ..plots import plot_evaluation

        for index, (_, evaluation) in enumerate(found):
            plot_evaluation(evaluation, plots if len(found) == 1 else plots / str(index + 1))


def _show(title: str, found: Evaluation) -> None:
    settings = found.settings
    click.echo(
        f"{title + chr(10) if title else ''}Scenario {found.scenario}: "
        f"{SCENARIOS[found.scenario]}; {len(found.tests)} clips, noise {settings['noise']}. "
        "Errors in cm.\n"
    )
    print_table(_summary(found))
    parts = {
        method: found.part_errors_cm(method)
        | {
            "frames under 5 cm (%)": 100.0 * found.share_of_close_frames(method),
            "clips always under 5 cm (%)": 100.0 * found.share_of_close_clips(method),
        }
        for method in found.methods
    }
    classes = {method: found.class_errors_cm(method) for method in found.methods}
    joints = {method: found.joint_errors_cm(method) for method in found.methods}
    for kind, errors in (("part", parts), ("class", classes), ("joint", joints)):
        click.echo()
        print_table(_breakdown(kind, errors))
    for method in found.methods:
        if found.movement(method):
            click.echo()
            print_table(_moving(found, method))


def _summary(found: Evaluation) -> Table:
    table = Table("", box=None, pad_edge=False)
    columns = ("mean", "median", "90 %", "angle (°)", "Euler (°)", "jerk (km/s³)", "latency (ms)")
    for name in columns:
        table.add_column(name, justify="right")
    for method in found.methods:
        figures: dict[str, Any] = found.summary(method)
        late, angle = figures["latency_ms"], figures["joint_angle_deg"]
        euler = figures["euler_angle_deg"]
        table.add_row(
            method,
            *(f"{figures[key]:.2f}" for key in ("mean_cm", "median_cm", "p90_cm")),
            "" if angle is None else f"{angle:.1f}",
            "" if euler is None else f"{euler:.2f} ± {figures['euler_angle_deviation_deg']:.2f}",
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


def _moving(found: Evaluation, method: str) -> Table:
    """Returns how a method moves over all tests and over each class's, see Movement."""
    table = Table(method, box=None, pad_edge=False)
    for name in (
        "wrists (°)", "step (cm)", "jumps", "jerk ratio", "most", "feet (cm/s)", "sunk (%)",
        *(f"{of} {s} s" for of in ("root", "heading") for s in DRIFT_AFTER_S), "warnings",
    ):  # fmt: skip
        table.add_column(name, justify="right")
    parts = [("all", found), *((name, found.of_class(name)) for name in found.classes)]
    for label, part in parts:
        table.add_row(label, *_moving_row(part.moving(method)))
    return table


def _moving_row(told: dict[str, Any]) -> list[str]:
    moved, truth, warned = told["movement"], told["truth_movement"], told["warnings"]

    def shown(value: float | None, digits: int = 0) -> str:
        return "" if value is None else f"{value:.{digits}f}"

    def beside_truth(figure: str, digits: int) -> str:
        return f"{shown(moved[figure], digits)} ({shown(truth[figure], digits)})"

    wrists, true_wrists = (
        np.mean([turns["turn_deg"][wrist] for wrist in ("lwrist", "rwrist")])
        for turns in (moved, truth)
    )
    return [
        f"{wrists:.1f} ({true_wrists:.1f})",
        beside_truth("largest_step_cm", 0),
        f"{told['jumps']['over_50_cm']} / {told['jumps']['over_3_true_steps']}",
        shown(told["jerk_ratio"], 1),
        shown(told["largest_jerk_ratio"], 1),
        beside_truth("standing_cmps", 1),
        shown(100.0 * moved["under_floor"], 1),
        *(shown(moved[f"root_after_{s}_s_cm"]) for s in DRIFT_AFTER_S),
        *(shown(moved[f"heading_after_{s}_s_deg"]) for s in DRIFT_AFTER_S),
        " / ".join(shown(warned[of], 2) or "-" for of in ("precision", "recall")),
    ]
