# SPDX-License-Identifier: GPL-3.0-or-later
"""Calibration: how each sensor is scaled, turned on its limb, and where it sits along its bone.

The wearer stands still, then makes guided movements (guided_movements() names them); the spans of
a take in which they do so are the steps. The result is kept in a file and holds until the sensors
are strapped on anew.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._core import (
    Body,
    ConfigError,
    SensorInput,
    Skeleton,
    calibrate_sensor,
    guided_movements,
    site_names,
    standing_pose_names,
)
from .take import SensorRecord, Take, devices_of

Floats = NDArray[np.float64]
Span = tuple[float, float]
"""From and to, in the take's seconds."""

__all__ = [
    "Calibration",
    "CalibrationError",
    "SensorCalibration",
    "Steps",
    "apply",
    "assign_by_shaking",
    "calibrate",
    "guided_movements",
    "positions_along_bone",
    "sensor_inputs",
    "standing_pose_names",
    "worn_at",
]

_CLEARLY = 2.0  # how much more the shaken sensor must move than any other
_LEAST_SHAKING_MPS2 = 3.0


class CalibrationError(ConfigError):
    """A take does not calibrate its sensors; str() is one line."""


@dataclass(frozen=True)
class SensorCalibration:
    """What turns one sensor's readings into those of an ideal sensor at its site."""

    site: str
    scale: float
    """Readings times this are m/s^2."""
    R_site_sensor: Floats
    """(3, 3), applied after the scale."""
    position_along_bone: float
    """0 at the pivot of the site's bone (elbow, knee), 1 at its end (wrist, ankle)."""
    gyroscope_bias: Floats
    """(3,) rad/s, in the sensor's own axes."""
    quality: float
    """0, nothing is sure, to 1."""
    is_mounting_determined: bool
    is_position_determined: bool
    gravity: float
    """What it read at rest, in its own unit."""
    unrest_mps2: float
    """How far its readings strayed while the wearer stood."""
    axis_ratio: float
    """How clearly the movements show one axis; 1 is not at all."""
    position_deviation: float
    """Standard deviation of position_along_bone."""
    notes: tuple[str, ...] = ()
    """What could not be determined, why, and what was taken instead."""
    device: str = ""
    """The identity of the device that was calibrated; empty: not known."""
    offset_m: Floats = field(default_factory=lambda: np.zeros(3))
    """(3,) where it sits, seen from its site, in the site's axes; for trackers of position."""


@dataclass(frozen=True)
class Calibration:
    """The calibrations of a take's sensors, by the names that the take gives them."""

    sensors: dict[str, SensorCalibration]
    body: Body | None = None
    """The performer's, where the calibration found it; used by methods that know one."""

    @property
    def quality(self) -> float:
        """That of the worst sensor."""
        return min(sensor.quality for sensor in self.sensors.values())

    @property
    def notes(self) -> list[str]:
        """The sensors' notes, each after its sensor's name."""
        return [f"{name}: {note}" for name, s in self.sensors.items() for note in s.notes]


@dataclass(frozen=True)
class Steps:
    """When in a take the wearer did what."""

    stand: Span
    movements: tuple[tuple[str, Span], ...] = ()
    """Guided movements by name; one may be made more than once."""
    pose: str = "arms_down"
    """How the wearer stood, one of standing_pose_names()."""


def calibrate(
    take: Take,
    steps: Steps,
    *,
    sites: Mapping[str, str] | None = None,
    height_m: float = 1.75,
    body: Skeleton | None = None,
    positions: Mapping[str, float] | None = None,
) -> Calibration:
    """Returns the calibration of every sensor in the take.

    ``sites`` says where sensors are worn that the take names otherwise; ``height_m`` is the
    wearer's, and scales the bones that positions refer to, unless ``body`` is a standard skeleton
    that has them; ``positions`` along the bone are by site and measured, so
    they win over what the movements show. Raises CalibrationError naming the sensor, what it
    read and what to do; ConfigError for names that are not known.
    """
    worn = worn_at(take, sites or {})
    devices = devices_of(take)
    found = {}
    for name, record in take.sensors.items():
        stand = _cut(name, record, steps.stand, "the standing pose")
        moves = [(move, _cut(name, record, span, move)) for move, span in steps.movements]
        position = (positions or {}).get(worn[name])
        try:
            told = calibrate_sensor(worn[name], steps.pose, stand, moves, height_m, position, body)
        except ConfigError as error:
            raise CalibrationError(f"{name}: {error}") from None
        calibrated = _at_known_position(worn[name], told, position)
        found[name] = replace(calibrated, device=devices.get(name, ""))
    return Calibration(found)


def apply(calibration: Calibration, take: Take) -> Take:
    """Returns what ideal sensors would have read: scaled, turned, named by their sites.

    Where they sit is positions_along_bone(). Raises CalibrationError when a sensor has no
    calibration.
    """
    sensors = {}
    devices = devices_of(take)
    for name, record in take.sensors.items():
        known = _of(calibration, name, devices.get(name, ""))
        ideal = _sensor_input(known, ["specific_force"]).corrected(
            record.specific_force, record.angular_velocity, record.orientation
        )
        sensors[known.site] = SensorRecord(record.times_s, *ideal, record.position)
    return Take(sensors, take.comments)


def positions_along_bone(calibration: Calibration, take: Take) -> list[float]:
    """Returns where on its bone each of the take's sensors sits, in its order."""
    devices = devices_of(take)
    return [_of(calibration, n, devices.get(n, "")).position_along_bone for n in take.sensors]


def sensor_inputs(
    calibration: Calibration | None,
    names: Sequence[str],
    channels: Sequence[Sequence[str]],
    positions: Mapping[str, float] | None = None,
    devices: Mapping[str, str] | None = None,
) -> list[SensorInput]:
    """Returns sensors of these names as a ReadingStream takes them, with the channels wanted.

    Without a calibration they are worn at the ends of their bones, as the sites they are named by
    ask for; in one they are found by devices, the sensors' identities by name, else by their names.
    Positions along the bone, by site, win over both. Raises CalibrationError when a sensor has no
    calibration, and ConfigError for an unknown site.
    """
    pairs = zip(names, channels, strict=True)
    if calibration is None:
        along = positions or {}
        return [
            SensorInput(name, list(wanted), position_along_bone=along.get(name, 1.0))
            for name, wanted in pairs
        ]
    known = {name: _of(calibration, name, (devices or {}).get(name, "")) for name in names}
    return [_sensor_input(known[name], wanted, positions) for name, wanted in pairs]


def assign_by_shaking(take: Take, span: Span) -> str:
    """Returns the name of the sensor that was shaken in the span while the others rested.

    Raises CalibrationError when none stands out.
    """
    moved = {}
    for name, record in take.sensors.items():
        _, force, _ = _cut(name, record, span, "the shaking")
        moved[name] = float(np.sqrt(np.var(force, axis=0).sum()))
    order = sorted(moved, key=lambda name: -moved[name])
    first = order[0]
    if moved[first] < _LEAST_SHAKING_MPS2:
        raise CalibrationError(
            f"no sensor was shaken from {span[0]:g} to {span[1]:g} s: the liveliest, {first}, "
            f"varies by {moved[first]:.1f} m/s^2; shake it harder"
        )
    if len(order) > 1 and moved[first] < _CLEARLY * moved[order[1]]:
        raise CalibrationError(
            f"from {span[0]:g} to {span[1]:g} s both {first} ({moved[first]:.1f} m/s^2) and "
            f"{order[1]} ({moved[order[1]]:.1f}) moved; shake one and keep the others still"
        )
    return first


def worn_at(take: Take, sites: Mapping[str, str]) -> dict[str, str]:
    """Returns where each of the take's sensors is worn, by its name. Raises CalibrationError."""
    for name in sites:
        if name not in take.sensors:
            known = ", ".join(take.sensors)
            raise CalibrationError(f"the take has no sensor {name!r}; choose from {known}")
    worn = {name: sites.get(name, name) for name in take.sensors}
    for name, site in worn.items():
        if site not in site_names():
            raise CalibrationError(
                f"{name}: unknown sensor location {site!r}; choose from {', '.join(site_names())}"
            )
        twins = [other for other, at in worn.items() if at == site]
        if len(twins) > 1:
            raise CalibrationError(f"{' and '.join(twins)} are both worn at {site}; name others")
    return worn


def _cut(
    name: str, record: SensorRecord, span: Span, what: str
) -> tuple[Floats, Floats, Floats | None]:
    begin, end = np.searchsorted(record.times_s, span)
    if end - begin < 10:
        raise CalibrationError(
            f"{name}: {what} from {span[0]:g} to {span[1]:g} s holds {end - begin} samples; the "
            f"sensor's record is from {record.times_s[0]:g} to {record.times_s[-1]:g} s"
        )
    turn = record.angular_velocity
    return (
        record.times_s[begin:end],
        record.specific_force[begin:end],
        None if turn is None else turn[begin:end],
    )


def _at_known_position(
    site: str, told: dict[str, Any], position: float | None
) -> SensorCalibration:
    found = SensorCalibration(site=site, **{**told, "notes": tuple(told["notes"])})
    if position is None:
        return found
    return replace(
        found,
        position_along_bone=position,
        is_position_determined=True,
        position_deviation=0.0,
        notes=tuple(note for note in found.notes if "position along" not in note),
    )


def _sensor_input(
    known: SensorCalibration,
    channels: Sequence[str],
    positions: Mapping[str, float] | None = None,
) -> SensorInput:
    return SensorInput(
        known.site,
        list(channels),
        position_along_bone=(positions or {}).get(known.site, known.position_along_bone),
        scale=known.scale,
        R_site_sensor=known.R_site_sensor,
        gyroscope_bias=known.gyroscope_bias,
        offset_m=known.offset_m,
    )


def _of(calibration: Calibration, name: str, device: str = "") -> SensorCalibration:
    """That of the device, wherever it is plugged in; else that of the name."""
    own = [known for known in calibration.sensors.values() if device and known.device == device]
    if own:
        if name in site_names() and own[0].site != name:
            raise CalibrationError(
                f"{device} was calibrated at {own[0].site} and is worn at {name} now: move it "
                "back, or calibrate again"
            )
        return own[0]
    if name not in calibration.sensors:
        known = ", ".join(calibration.sensors)
        raise CalibrationError(
            f"the calibration has no sensor {name!r}; it has {known}: calibrate again"
        )
    found = calibration.sensors[name]
    if device and found.device:
        raise CalibrationError(
            f"{found.device} was calibrated at {name}, and {device} is worn there now: calibrate "
            "again"
        )
    return found
