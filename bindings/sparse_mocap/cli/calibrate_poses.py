# SPDX-License-Identifier: GPL-3.0-or-later
"""``sparse-mocap calibrate-poses``: calibrates trackers and the performer's body by poses."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click
from rich.table import Table

from .. import read_model, read_take, standard_joint_names
from ..body_file import write_body
from ..calibration_file import write_calibration
from ..pose_calibration import PoseCalibration, calibrate_by_poses, calibration_poses
from .console import print_table, warn
from .options import FilePath, Sites, Span, check_ending

__all__ = ["HeldPose", "calibrate_poses"]


class HeldPose(click.ParamType):  # type: ignore[type-arg]
    """A calibration pose and when it was held."""

    name = "NAME=FROM:TO"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, tuple[float, float]]:
        """Returns the pose's name and its span."""
        if isinstance(value, tuple):
            return value
        name, _, span = str(value).partition("=")
        known = [pose for pose, _, _ in calibration_poses()]
        if name not in known:
            self.fail(f"unknown pose {name!r}; choose from {', '.join(known)}", param, ctx)
        return name, Span().convert(span, param, ctx)


@click.command()
@click.argument("take", metavar="TAKE.csv", type=FilePath)
@click.option(
    "-o", "--output", type=FilePath, required=True, help="The calibration file to write (.json)."
)
@click.option("--body", "body_path", type=FilePath, help="Also write the body file (.json).")
@click.option(
    "--pose", "poses", type=HeldPose(), multiple=True, required=True,
    help="When a pose was held; give all eight: "
    + ", ".join(name for name, _, _ in calibration_poses()) + ".",
)  # fmt: skip
@click.option("--sites", type=Sites(), help="Sensor locations, in the take's order.")
@click.option(
    "--model", "model_path", type=FilePath, metavar="MODEL.smmodel",
    help="Bone lengths learnt by `train --method liu2011`.  [default: published proportions]",
)  # fmt: skip
def calibrate_poses(
    take: Path,
    output: Path,
    body_path: Path | None,
    poses: tuple[tuple[str, tuple[float, float]], ...],
    sites: tuple[str, ...] | None,
    model_path: Path | None,
) -> None:
    """Finds how trackers sit on the body, and the performer's bones, from held poses.

    For trackers of orientation, and of position where they have it. The performer faces the same
    way in each pose and holds it for two seconds. What the poses do not tell is reported and keeps
    its usual value. Use the files with --calibration and --body in other commands.
    """
    for path in (output, body_path):
        if path is not None:
            check_ending(path, ".json")
    recorded = read_take(take)
    if sites is not None and len(sites) != len(recorded.sensors):
        raise click.BadParameter(
            f"give one location for each sensor of the take: {', '.join(recorded.sensors)}",
            param_hint="'--sites'",
        )
    found = calibrate_by_poses(
        recorded,
        poses,
        sites=dict(zip(recorded.sensors, sites, strict=True)) if sites else {},
        model=None if model_path is None else read_model(model_path),
    )
    write_calibration(output, found.calibration)
    if body_path is not None:
        write_body(body_path, found.body, f"calibration poses of {take.name}")
    warn(found.notes)
    _print(output, found)


def _print(output: Path, found: PoseCalibration) -> None:
    sensors = Table("sensor", "location", "mounting", "offset", "quality")
    for name, sensor in found.calibration.sensors.items():
        offset = " ".join(f"{100 * value:.1f}" for value in sensor.offset_m)
        sensors.add_row(
            name,
            sensor.site,
            "found" if sensor.is_mounting_determined else "uncertain",
            f"{offset} cm ± {100 * sensor.position_deviation:.1f}",
            f"{sensor.quality:.2f}",
        )
    print_table(sensors)
    bones = Table("bone", "length", "±")
    lengths = dict(
        zip(standard_joint_names(), (found.body.bones**2).sum(axis=1) ** 0.5, strict=True)
    )
    for bone, deviation in found.bone_deviations_m.items():
        is_measured = bone not in found.undetermined_bones
        bones.add_row(
            bone,
            f"{100 * lengths[bone]:.1f} cm" + ("" if is_measured else " assumed"),
            f"{100 * deviation:.1f}",
        )
    print_table(bones)
    for pose, missed in found.missed_deg:
        click.echo(f"{pose}: {missed:.0f} degrees from the shown pose")
    click.echo(
        f"{output}: {len(found.calibration.sensors)} sensors; body height "
        f"{found.body.height_m:.2f} m; joints {found.imitation_deg:.1f} degrees from those shown"
    )
