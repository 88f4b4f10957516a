# SPDX-License-Identifier: GPL-3.0-or-later
"""The body file: the bones of a performer, as JSON.

::

    {"format": "sparse_mocap_body", "format_version": 1, "performer": "anna", "source": "walk.bvh",
     "bones_m": {"root": [0, 0, 0], "lhipjoint": [0.08, -0.1, 0.04], ...}}

``bones_m`` has each of the 21 standard joints: the way from its pivot to its end in metres, in rest
pose (x to the left, y up, z forward). A body comes from a motion of the performer, or, where there
is none, from their height.
"""

from __future__ import annotations

import difflib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ._core import Body, ConfigError, FormatError, standard_joint_names
from .files import write_text
from .json_keys import unique_keys
from .mappings import to_standard
from .motion_files import read_motion
from .table_errors import TableError, read_lines

__all__ = [
    "BodyFileError",
    "body_of_motion",
    "body_with_bones",
    "bones_by_name",
    "read_body",
    "write_body",
]

FilePath = str | os.PathLike[str]

_FORMAT, _VERSION = "sparse_mocap_body", 1
_KEYS = ("format", "format_version", "performer", "source", "bones_m")


class BodyFileError(TableError):
    """A body file cannot be used."""


def write_body(path: FilePath, body: Body, source: str = "") -> None:
    """Writes a body file atomically; source says where the bones come from. Raises OSError."""
    whole = {
        "format": _FORMAT,
        "format_version": _VERSION,
        "performer": body.performer,
        "source": source,
        "bones_m": bones_by_name(body),
    }
    text = json.dumps(whole, indent=2, ensure_ascii=False)
    write_text(path, text + "\n")


def read_body(path: FilePath) -> Body:
    """Returns the body in a file. Raises BodyFileError, naming the key, and OSError."""
    whole = _parsed(path)
    version = whole.get("format_version")
    if version != _VERSION or isinstance(version, bool):
        raise BodyFileError(
            path, 0, f"is a body of format version {json.dumps(version)}, and this program reads"
            f" version {_VERSION}; update Sparse Mocap, or make the body again",
        )  # fmt: skip
    _check_keys(path, whole, _KEYS, "")
    for key in ("performer", "source"):
        if not isinstance(whole.get(key, ""), str):
            raise BodyFileError(path, 0, f"{key} must be a text")
    return body_with_bones(path, whole.get("bones_m"), whole.get("performer", ""))


def bones_by_name(body: Body) -> dict[str, list[float]]:
    """Returns a body's bones as files have them."""
    return dict(zip(standard_joint_names(), body.bones.tolist(), strict=True))


def body_with_bones(path: FilePath, bones_m: Any, performer: str = "") -> Body:
    """Returns the body whose bones a file has. Raises BodyFileError, naming the key."""
    bones = _bones(path, bones_m)
    try:
        return Body(bones, performer)
    except ConfigError as error:
        raise BodyFileError(path, 0, f"{error}; bones_m must be in metres") from None


def body_of_motion(
    path: FilePath, performer: str = "", by_hand: Mapping[str, str] | None = None
) -> Body:
    """Returns the body in a motion file: the standard skeleton in the proportions it is mapped to.

    by_hand: the file's joints for some standard ones, as read_mapping gives them. Raises
    FormatError, MappingError and OSError.
    """
    motion, _ = to_standard(read_motion(path)[0], by_hand=by_hand)
    try:
        return Body(motion.skeleton.bones, performer or Path(path).stem)
    except ConfigError as error:
        raise FormatError(
            f"{os.fspath(path)}: is not a body that can be measured: {error}"
        ) from None


def _parsed(path: FilePath) -> dict[str, Any]:
    try:
        whole = json.loads("\n".join(read_lines(path, BodyFileError)),
                           object_pairs_hook=unique_keys)  # fmt: skip
    except json.JSONDecodeError as error:
        raise BodyFileError(path, error.lineno, f"is not JSON: {error.msg}") from None
    except (ValueError, RecursionError) as error:
        if isinstance(error, BodyFileError):
            raise
        raise BodyFileError(path, 0, str(error) or "is nested too deeply") from None
    if not isinstance(whole, dict) or whole.get("format") != _FORMAT:
        raise BodyFileError(
            path, 0, f'is not a body file; it must be an object with "format": "{_FORMAT}"'
        )
    return whole


def _check_keys(path: FilePath, value: dict[str, Any], known: Any, where: str) -> None:
    for key in value:
        if key not in known:
            near = difflib.get_close_matches(key, known, n=1, cutoff=0.0)[0]
            raise BodyFileError(path, 0, f"{where}{key} is unknown; the nearest is {near}")


def _bones(path: FilePath, value: Any) -> Any:
    names = standard_joint_names()
    if not isinstance(value, dict):
        raise BodyFileError(path, 0, "bones_m must be an object from standard joints to bones")
    _check_keys(path, value, names, "bones_m.")
    for name in names:
        if name not in value:
            raise BodyFileError(path, 0, f"bones_m.{name} is missing")
    return np.array([_bone(path, name, value[name]) for name in names])


def _bone(path: FilePath, name: str, value: Any) -> list[float]:
    is_vector = isinstance(value, list) and len(value) == 3
    if not is_vector or not all(
        isinstance(number, int | float) and not isinstance(number, bool) for number in value
    ):
        raise BodyFileError(path, 0, f"bones_m.{name} must be three numbers, metres")
    return [float(number) for number in value]
