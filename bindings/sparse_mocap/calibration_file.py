# SPDX-License-Identifier: GPL-3.0-or-later
"""The calibration file: JSON, checked key by key."""

from __future__ import annotations

import difflib
import json
import os
from dataclasses import fields
from math import isfinite
from typing import Any

import numpy as np

from . import site_names
from .body_file import body_with_bones, bones_by_name
from .calibration import Calibration, SensorCalibration
from .files import write_text
from .json_keys import unique_keys
from .table_errors import TableError, read_lines

__all__ = ["CalibrationFileError", "read_calibration", "write_calibration"]

Path = str | os.PathLike[str]

_FORMAT = "sparse_mocap_calibration"
_VERSION = 3
_OLD_NAMES = {
    "place": "position_along_bone",
    "is_place_determined": "is_position_determined",
    "place_deviation": "position_deviation",
}
"""Of version 1, which stated none."""
_SHAPES: dict[str, tuple[int, ...]] = {
    "R_site_sensor": (3, 3),
    "gyroscope_bias": (3,),
    "offset_m": (3,),
}
_NEEDED = ("site", "scale", "R_site_sensor", "position_along_bone")
_DEFAULTS: dict[str, Any] = {
    "gyroscope_bias": [0.0, 0.0, 0.0],
    "quality": 0.0,
    "is_mounting_determined": True,
    "is_position_determined": True,
    "gravity": 0.0,
    "unrest_mps2": 0.0,
    "axis_ratio": 1.0,
    "position_deviation": 1.0,
    "notes": [],
    "device": "",
    "offset_m": [0.0, 0.0, 0.0],
}
"""Version 2 has no offset_m, and no bones_m beside the sensors."""
_LIMITS = {"scale": (0.01, 100.0), "position_along_bone": (0.0, 1.0)}


class CalibrationFileError(TableError):
    """A calibration file cannot be used."""


def write_calibration(path: Path, calibration: Calibration) -> None:
    """Writes a calibration file atomically."""
    sensors = {name: _plain(sensor) for name, sensor in calibration.sensors.items()}
    whole: dict[str, Any] = {"format": _FORMAT, "format_version": _VERSION, "sensors": sensors}
    if calibration.body is not None:
        whole["bones_m"] = bones_by_name(calibration.body)
    write_text(path, json.dumps(whole, indent=2, ensure_ascii=False) + "\n")


def read_calibration(path: Path) -> Calibration:
    """Returns the calibration in a file. Raises CalibrationFileError, naming the key, and OSError.

    What a sensor needs is site, scale, R_site_sensor and position_along_bone, which files of format
    version 1 call place.
    """
    try:
        whole = json.loads("\n".join(read_lines(path, CalibrationFileError)),
                           object_pairs_hook=unique_keys)  # fmt: skip
    except json.JSONDecodeError as error:
        raise CalibrationFileError(path, error.lineno, f"is not JSON: {error.msg}") from None
    except (ValueError, RecursionError) as error:
        raise CalibrationFileError(path, 0, str(error) or "is nested too deeply") from None
    if not isinstance(whole, dict) or whole.get("format") != _FORMAT:
        raise CalibrationFileError(
            path, 0, f'is not a calibration file; it must be an object with "format": "{_FORMAT}"'
        )
    _check_keys(path, "", whole, ("format", "format_version", "sensors", "bones_m"), ("sensors",))
    version = whole.get("format_version", 1)
    if isinstance(version, bool) or version not in range(1, _VERSION + 1):
        raise CalibrationFileError(
            path, 0, f"format_version is {version!r}; this version of Sparse Mocap reads 1 to "
            f"{_VERSION}: update it, or calibrate again"
        )  # fmt: skip
    sensors = whole["sensors"]
    if not isinstance(sensors, dict) or not sensors:
        raise CalibrationFileError(path, 0, "'sensors' must be an object with a sensor or more")
    names = _OLD_NAMES if version == 1 else {}
    found = {name: _sensor(path, name, value, names) for name, value in sensors.items()}
    body = body_with_bones(path, whole["bones_m"]) if "bones_m" in whole else None
    return Calibration(found, body)


def _plain(sensor: SensorCalibration) -> dict[str, Any]:
    values = {field.name: getattr(sensor, field.name) for field in fields(sensor)}
    return {
        key: np.asarray(value).tolist() if key in _SHAPES or key == "notes" else value
        for key, value in values.items()
    }


def _sensor(path: Path, name: str, value: Any, new_names: dict[str, str]) -> SensorCalibration:
    if not isinstance(value, dict):
        raise CalibrationFileError(path, 0, f"sensors.{name} must be an object")
    value = {new_names.get(key, key): entry for key, entry in value.items()}
    known = [field.name for field in fields(SensorCalibration)]
    _check_keys(path, f"sensors.{name}.", value, known, _NEEDED)
    checked = {
        key: _value(path, f"sensors.{name}.{key}", key, value.get(key, _DEFAULTS.get(key)))
        for key in known
    }
    return SensorCalibration(**checked)


def _check_keys(
    path: Path, where: str, value: dict[str, Any], known: Any, needed: tuple[str, ...]
) -> None:
    for key in value:
        if key not in known:
            near = difflib.get_close_matches(key, known, n=1, cutoff=0.0)[0]
            raise CalibrationFileError(path, 0, f"{where}{key} is unknown; the nearest is {near}")
    for key in needed:
        if key not in value:
            raise CalibrationFileError(path, 0, f"{where}{key} is missing")


def _value(path: Path, where: str, key: str, value: Any) -> Any:
    def refuse(what: str) -> CalibrationFileError:
        return CalibrationFileError(path, 0, f"{where} {what}")

    if key == "site":
        if value not in site_names():
            raise refuse(
                f"is the unknown sensor location {value!r}; choose from {', '.join(site_names())}"
            )
        return value
    if key == "notes":
        if not isinstance(value, list) or not all(isinstance(note, str) for note in value):
            raise refuse("must be a list of texts")
        return tuple(value)
    if key == "device":
        if not isinstance(value, str):
            raise refuse("must be a text")
        return value
    if key.startswith("is_"):
        if not isinstance(value, bool):
            raise refuse("must be true or false")
        return value
    if key in _SHAPES:
        return _array(refuse, key, value)
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise refuse("must be a number")
    low, high = _LIMITS.get(key, (-np.inf, np.inf))
    if not low <= value <= high:
        raise refuse(f"is {value:g}; it must be from {low:g} to {high:g}")
    return float(value)


def _array(refuse: Any, key: str, value: Any) -> Any:
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.shape != _SHAPES[key] or not np.isfinite(array).all():
        raise refuse(f"must be numbers in the shape {_SHAPES[key]}")
    if key == "R_site_sensor":
        determinant = float(np.linalg.det(array))
        if abs(array @ array.T - np.eye(3)).max() > 1e-3 or determinant < 0:
            raise refuse(f"is not a rotation (determinant {determinant:.3f})")
    return array
