# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration by poses: the performer imitates shown poses, with trackers on.

It finds how trackers of orientation, and of position where they have it, sit on their limbs, and
how long the performer's bones are (Liu et al. 2011, section 4). What the poses do not tell is left
as it usually is, and said. Poses may be a part of all; each is held for a second or two.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._core import (
    GRAVITY_MPS2,
    Body,
    Model,
    calibrate_from_poses,
    calibration_poses,
    standard_joint_names,
)
from .calibration import Calibration, CalibrationError, SensorCalibration, Span, worn_at
from .take import SensorRecord, Take, devices_of

Floats = NDArray[np.float64]

__all__ = ["PoseCalibration", "calibrate_by_poses", "calibration_poses"]

_LEAST_SAMPLES = 5
_MOST_SWAY_DEG = 15.0
_MOST_SWAY_M = 0.08
_TRUE_WITHIN = 0.1
"""Accelerometers of trackers are calibrated; what they read at rest shows their unit alone."""


@dataclass(frozen=True)
class PoseCalibration:
    """How the trackers sit and the performer's body, and how sure that is."""

    calibration: Calibration
    bone_deviations_m: dict[str, float]
    """The standard deviation of each bone's length, by standard joint."""
    undetermined_bones: tuple[str, ...]
    """Those that the poses do not tell: as long as such a body usually has them."""
    missed_deg: tuple[tuple[str, float], ...]
    """How far the limbs were from each shown pose (RMS)."""
    imitation_deg: float
    """How far the performer's joint angles typically are from the shown ones."""
    notes: tuple[str, ...]
    """What could not be found out, and what to do."""

    @property
    def body(self) -> Body:
        """The performer's."""
        assert self.calibration.body is not None
        return self.calibration.body


@dataclass(frozen=True)
class _Held:
    position: Floats
    rotation: Floats
    force: Floats
    turn: Floats


def calibrate_by_poses(
    take: Take,
    poses: Sequence[tuple[str, Span]],
    *,
    sites: Mapping[str, str] | None = None,
    model: Model | None = None,
    performer: str = "",
) -> PoseCalibration:
    """Returns the calibration of a take in which the performer held poses of calibration_poses().

    poses: each name, and from when to when in the take's seconds it was held. sites says where
    trackers are worn that the take names otherwise. model: bone lengths that ``train --method
    liu2011`` learnt; None: published proportions. Raises CalibrationError naming the tracker and
    the pose, and ConfigError for names that are not known.
    """
    if not poses:
        raise CalibrationError("no pose was held: say when, at least for one")
    worn = worn_at(take, sites or {})
    names = list(take.sensors)
    _require_trackers(take)
    held = [[_held(name, pose, span, take.sensors[name]) for name in names] for pose, span in poses]
    found = calibrate_from_poses(
        [worn[name] for name in names],
        [
            (pose, np.stack([s.position for s in row]), np.stack([s.rotation for s in row]))
            for (pose, _), row in zip(poses, held, strict=True)
        ],
        model,
    )
    devices = devices_of(take)
    sensors = {}
    for j, name in enumerate(names):
        own = [row[j] for row in held]
        sensors[name] = _sensor(worn[name], devices.get(name, ""), found["sensors"][j], own)
    calibration = Calibration(sensors, Body(found["bones"], performer))
    return _told(calibration, [pose for pose, _ in poses], found)


def _told(calibration: Calibration, poses: list[str], found: dict[str, Any]) -> PoseCalibration:
    bones = list(standard_joint_names())[1:]
    unknown = [
        b for b, is_known in zip(bones, found["is_bone_determined"], strict=True) if not is_known
    ]
    return PoseCalibration(
        calibration,
        dict(zip(bones, found["bone_deviation_m"].tolist(), strict=True)),
        tuple(unknown),
        tuple(zip(poses, found["missed_deg"], strict=True)),
        found["imitation_deg"],
        tuple(_notes(found["are_poses_alike"], unknown, calibration)),
    )


def _require_trackers(take: Take) -> None:
    others = [
        name
        for name, record in take.sensors.items()
        if record.orientation is None and record.position is None
    ]
    if others:
        raise CalibrationError(
            f"{', '.join(others)}: gives neither orientation nor position; calibrate such sensors "
            "by movements (`calibrate`)"
        )


def _held(name: str, pose: str, span: Span, record: SensorRecord) -> _Held:
    """Returns the means of what a tracker said while a pose was held."""
    begin, end = np.searchsorted(record.times_s, span)
    if end - begin < _LEAST_SAMPLES:
        raise CalibrationError(
            f"{name}: {pose} from {span[0]:g} to {span[1]:g} s holds {end - begin} samples; the "
            f"tracker's record is from {record.times_s[0]:g} to {record.times_s[-1]:g} s"
        )
    rows = slice(begin, end)
    return _Held(
        _mean_position(name, pose, record.position, rows),
        _mean_rotation(name, pose, record.orientation, rows),
        _mean(record.specific_force, rows),
        _mean(record.angular_velocity, rows),
    )


def _known(values: Floats | None, rows: slice) -> Floats:
    if values is None:
        return np.empty((0, 0))
    part = values[rows]
    return part[np.isfinite(part).all(axis=1)]


def _mean(values: Floats | None, rows: slice) -> Floats:
    known = _known(values, rows)
    return np.asarray(known.mean(axis=0)) if len(known) else np.full(3, np.nan)


def _mean_position(name: str, pose: str, values: Floats | None, rows: slice) -> Floats:
    """Returns the median, which wrong positions among the right ones do not move."""
    known = _known(values, rows)
    if not len(known):
        return np.full(3, np.nan)
    middle = np.median(known, axis=0)
    sway = float(np.median(np.linalg.norm(known - middle, axis=1)))
    if sway > _MOST_SWAY_M:
        raise CalibrationError(
            f"{name} moved by {100 * sway:.0f} cm during {pose}; hold the pose still"
        )
    return np.asarray(middle)


def _mean_rotation(name: str, pose: str, values: Floats | None, rows: slice) -> Floats:
    """Returns the mean of rotations (T, 4) as a matrix: the eigenvector of largest eigenvalue."""
    known = _known(values, rows)
    if not len(known):
        return np.full((3, 3), np.nan)
    mean = np.linalg.eigh(known.T @ known)[1][:, -1]
    cosines = np.clip(np.abs(known @ mean), 0.0, 1.0)
    sway = float(np.degrees(np.median(2.0 * np.arccos(cosines))))
    if sway > _MOST_SWAY_DEG:
        raise CalibrationError(
            f"{name} turned by {sway:.0f} degrees during {pose}; hold the pose still"
        )
    w, x, y, z = mean
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _sensor(site: str, device: str, found: dict[str, Any], held: list[_Held]) -> SensorCalibration:
    gravity = _median([float(np.linalg.norm(one.force)) for one in held])
    is_true = abs(gravity / GRAVITY_MPS2 - 1.0) < _TRUE_WITHIN
    turns = np.array([one.turn for one in held])
    bias = np.median(turns, axis=0) if np.isfinite(turns).all() else np.zeros(3)
    deviation = np.asarray(found["offset_deviation_m"])
    mounting_deg = float(found["mounting_deviation_deg"])
    is_offset_determined = bool(found["is_offset_determined"])
    notes = []
    if not found["is_mounting_determined"]:
        notes.append(f"how it is turned on its limb is known to {mounting_deg:.0f} degrees only")
    if not is_offset_determined and any(np.isfinite(one.position).all() for one in held):
        notes.append(
            f"where it sits is known to {100 * float(deviation.max()):.0f} cm only: such poses do "
            "not turn this limb about all its axes"
        )
    return SensorCalibration(
        site,
        1.0 if is_true or not gravity else GRAVITY_MPS2 / gravity,
        np.asarray(found["R_site_sensor"]),
        1.0,
        bias,
        float(np.clip(1.0 - mounting_deg / 20.0, 0.0, 1.0)),
        bool(found["is_mounting_determined"]),
        is_offset_determined,
        gravity,
        0.0,
        1.0,
        float(deviation.max()),
        tuple(notes),
        device,
        np.asarray(found["offset_m"]),
    )


def _median(values: list[float]) -> float:
    known = [value for value in values if np.isfinite(value)]
    return float(np.median(known)) if known else 0.0


def _notes(are_alike: bool, unknown: list[str], calibration: Calibration) -> list[str]:
    notes = []
    if are_alike:
        notes.append(
            "the poses are too alike to tell bones and trackers apart: hold others as well, such "
            "as arms_forward, bow and left_knee_up"
        )
    if len(unknown) == len(standard_joint_names()) - 1:
        notes.append("no bone was measured: lengths are those usual for people")
    elif unknown:
        notes.append(
            f"not measured, and taken as usual for such a body: the length of {', '.join(unknown)}"
        )
    return [*notes, *calibration.notes]
