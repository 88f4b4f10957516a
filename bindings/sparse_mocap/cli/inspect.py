# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap inspect``: shows the content of motion files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from rich.table import Table

from .. import (
    MotionDatabase,
    find_motion_files,
    forget_mapping,
    read_mapping,
    remember_mapping,
    write_mapping,
)
from ..inspection import Inspection, inspect_motion
from .console import print_table, progress_bar, write_json
from .database_info import described, show
from .faults import Fault
from .options import FilePath, OutputPath, reading_options

__all__ = ["inspect"]


@click.command("inspect")
@click.argument("sources", metavar="SOURCE...", type=FilePath, nargs=-1, required=True)
@click.option(
    "--mapping", "mapping_path", metavar="MAP.json", type=FilePath,
    help="Skeleton mapping to use instead of detecting the joints.",
)  # fmt: skip
@click.option(
    "--save-mapping", metavar="MAP.json", type=OutputPath(),
    help="Write the detected skeleton mapping to a file, to edit and use with --mapping.",
)  # fmt: skip
@click.option(
    "--remember", is_flag=True, help="Use --mapping for all files with this skeleton from now on."
)
@click.option("--forget", is_flag=True, help="Forget the mapping remembered for this skeleton.")
@click.option("--json", "json_path", type=OutputPath(), help="Also write everything as JSON.")
@click.option(
    "--plot", type=OutputPath(),
    help="Also draw six frames of each file, its own skeleton next to the standard one (.png).",
)  # fmt: skip
@reading_options
def inspect(
    sources: tuple[Path, ...],
    mapping_path: Path | None,
    save_mapping: Path | None,
    remember: bool,
    forget: bool,
    json_path: Path | None,
    plot: Path | None,
    reading: dict[str, Any],
) -> None:
    """Shows the content of motion files and how their joints are mapped.

    SOURCE is a .bvh, .amc, .npz (SMPL, AMASS) or .mvnx file, or a folder, which is searched
    recursively. Errors are angles between limbs of the file and of the standard skeleton. Of a
    motion database (.smdb) it shows the same as `database info`.
    """
    if remember and mapping_path is None:
        raise click.UsageError("--remember needs --mapping")
    databases = [path for path in sources if path.suffix == ".smdb"]
    sources = tuple(path for path in sources if path not in databases)
    for path in databases:
        show(described(MotionDatabase(path)))
    if databases and not sources:
        return
    by_hand = read_mapping(mapping_path) if mapping_path else None
    files = [Path(path) for path in find_motion_files(list(sources))]
    if save_mapping and len(files) != 1:
        raise click.UsageError(f"--save-mapping needs one motion file, got {len(files)}")
    inspections = []
    with progress_bar("Reading") as progress:
        for done, path in enumerate(files):
            if not progress(done, len(files), path.name):
                raise click.Abort
            inspections.append(_inspect(path, by_hand, forget, reading))
    if json_path:
        write_json(json_path, [inspection.described() for inspection in inspections])
    if plot:
        from ..plots_motion import plot_inspections

        plot_inspections(inspections, plot)
    print_table(_table(inspections))
    if len(inspections) == 1:
        _show_one(inspections[0])
        _save(inspections[0], save_mapping, remember)
    elif remember:
        for inspection in inspections:
            _save(inspection, None, remember)


def _inspect(
    path: Path, by_hand: dict[str, str] | None, forget: bool, reading: dict[str, Any]
) -> Inspection:
    inspection = inspect_motion(path, by_hand, reading)
    if forget and inspection.motion and forget_mapping(inspection.motion.skeleton):
        inspection = inspect_motion(path, by_hand, reading)
    return inspection


def _table(inspections: list[Inspection]) -> Table:
    table = Table("file", "joints", "frames", "Hz", "mapped by", "mean °", "worst °", "notes")
    for inspection in inspections:
        motion = inspection.motion
        has_mapping = inspection.mapping is not None
        table.add_row(
            f"{inspection.path.parent.name}/{inspection.path.name}",
            str(len(motion.skeleton.names)) if motion else "-",
            str(motion.num_frames) if motion else "-",
            f"{1.0 / motion.frame_time_s:.4g}" if motion else "-",
            inspection.found_by,
            f"{inspection.mean_error_deg:.2f}" if has_mapping else "-",
            f"{inspection.worst_error_deg:.1f}" if has_mapping else "-",
            f"rejected: {inspection.refusal}" if inspection.refusal else _notes(inspection),
        )
    return table


def _notes(inspection: Inspection) -> str:
    return "; ".join(" ".join(warning.split()) for warning in inspection.warnings)


_RELAXED = {
    "foot": "level while it stands, else at right angles to the shank",
    "toes": "straight",
    "hand": "hangs a little bent",
}


def _show_one(inspection: Inspection) -> None:
    if inspection.mapping is None:
        where = f"{inspection.path}: "
        raise Fault(where + (inspection.refusal or "").removeprefix(where))
    for standard, joint in inspection.mapping.joints.items():
        mean, worst = inspection.limb_errors_deg.get(standard, (None, None))
        error = "" if mean is None else f"  mean {mean:.2f}°, worst {worst:.1f}°"
        click.echo(f"{standard:<10} {joint}{error}")
    for extremity in ("lfoot", "ltoes", "lhand", "rfoot", "rtoes", "rhand"):
        joint = inspection.mapping.extremities.get(extremity, "")
        click.echo(f"{extremity:<10} {joint or 'not in the file: ' + _RELAXED[extremity[1:]]}")


def _save(inspection: Inspection, save_mapping: Path | None, remember: bool) -> None:
    if inspection.mapping is None or inspection.motion is None:
        return
    joints = inspection.mapping.joints
    if save_mapping:
        write_mapping(save_mapping, joints)
        click.echo(f"{save_mapping}: {len(joints)} joints")
    if remember:
        click.echo(f"remembered in {remember_mapping(inspection.motion.skeleton, joints)}")
