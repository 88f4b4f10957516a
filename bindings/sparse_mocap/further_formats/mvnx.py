# SPDX-License-Identifier: GPL-3.0-or-later
"""Xsens MVN motion (``.mvnx``): segments with their orientations and positions in the world.

Orientations are R_world_segment as w x y z, positions m of the segments' origins; the world has z
up and x forward.
"""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .._core import FormatError, Motion, Skeleton

__all__ = ["read_mvnx"]

Floats = NDArray[np.float64]

_PARENTS = {
    "L5": "Pelvis", "L3": "L5", "T12": "L3", "T8": "T12", "Neck": "T8", "Head": "Neck",
    "RightShoulder": "T8", "RightUpperArm": "RightShoulder", "RightForeArm": "RightUpperArm",
    "RightHand": "RightForeArm", "LeftShoulder": "T8", "LeftUpperArm": "LeftShoulder",
    "LeftForeArm": "LeftUpperArm", "LeftHand": "LeftForeArm", "RightUpperLeg": "Pelvis",
    "RightLowerLeg": "RightUpperLeg", "RightFoot": "RightLowerLeg", "RightToe": "RightFoot",
    "LeftUpperLeg": "Pelvis", "LeftLowerLeg": "LeftUpperLeg", "LeftFoot": "LeftLowerLeg",
    "LeftToe": "LeftFoot",
}  # fmt: skip
_MOST_BYTES = 2 << 30
_R_WORLD_FILE = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])


def read_mvnx(path: Path) -> tuple[Motion, list[str]]:
    """The motion in the file, on its own segments, and warnings. Raises FormatError and OSError."""
    if (size := path.stat().st_size) > _MOST_BYTES:
        raise _fault(path, f"has {size} bytes, more than {_MOST_BYTES}")
    rate_hz, segments, orientations, positions = _content(path)
    order = _ordered(path, segments)
    names = [segments[index] for index in order]
    parents = [names.index(_PARENTS[name]) if name in _PARENTS else -1 for name in names]
    R_world = _matrices(path, orientations)[:, order]
    points = positions[:, order] @ _R_WORLD_FILE.T
    R_world = _R_WORLD_FILE @ R_world @ _R_WORLD_FILE.T
    rotations = R_world.copy()
    pivots = np.zeros((len(names), 3))
    for joint, parent in enumerate(parents):
        if parent < 0:
            continue
        R_parent_world = np.swapaxes(R_world[:, parent], 1, 2)
        rotations[:, joint] = R_parent_world @ R_world[:, joint]
        pivots[joint] = pivots[parent] + R_parent_world[0] @ (points[0, joint] - points[0, parent])
    skeleton = Skeleton(names, parents, pivots, pivots)
    return Motion(skeleton, 1.0 / rate_hz, points[:, 0], _quaternions(rotations)), []


def _content(path: Path) -> tuple[float, list[str], Floats, Floats]:
    """Rate, segments, (T, S, 4) orientations and (T, S, 3) positions, frame by frame."""
    rate_hz, segments = 0.0, []
    frames: list[tuple[str, str]] = []
    try:
        for event, element in ElementTree.iterparse(path, ("start", "end")):
            tag = element.tag.rpartition("}")[2]
            if event == "start":
                if tag == "subject":
                    rate_hz = float(element.get("frameRate") or 0.0)
                continue
            if tag == "segment" and element.get("label"):
                segments.append(element.get("label") or "")
            elif tag == "frame":
                if element.get("type") == "normal":
                    texts = {child.tag.rpartition("}")[2]: child.text or "" for child in element}
                    frames.append((texts.get("orientation", ""), texts.get("position", "")))
                element.clear()
    except ElementTree.ParseError as error:
        raise _fault(path, f"is not whole XML ({error}); export it again") from None
    except ValueError:
        raise _fault(path, "states no frame rate that is a number") from None
    if not 1.0 <= rate_hz <= 10_000.0:
        raise _fault(path, "states no frame rate from 1 to 10000 Hz")
    if not frames or not segments:
        raise _fault(path, "holds no segments or no frames of the type normal")
    count = len(segments)
    tables = [_table(path, [frame[k] for frame in frames], count, (4, 3)[k]) for k in (0, 1)]
    return rate_hz, segments, tables[0], tables[1]


def _table(path: Path, texts: list[str], count: int, width: int) -> Floats:
    rows = np.empty((len(texts), count, width))
    for index, text in enumerate(texts):
        try:
            values = np.array(text.split(), dtype=np.float64)
        except ValueError:
            values = np.empty(0)
        if values.size != count * width or not np.isfinite(values).all():
            raise _fault(
                path,
                f"normal frame {index + 1} has {values.size} numbers for {count} segments, expected"
                f" {count * width}; export it with positions and orientations of the segments",
            )
        rows[index] = values.reshape(count, width)
    return rows


def _ordered(path: Path, segments: list[str]) -> list[int]:
    """The known segments, parents first."""
    known = ["Pelvis", *_PARENTS]
    if missing := [name for name in known if name not in segments]:
        raise _fault(path, f"lacks the segment {missing[0]}; export the whole body")
    return [segments.index(name) for name in known]


def _matrices(path: Path, quaternions: Floats) -> Floats:
    norms = np.linalg.norm(quaternions, axis=-1, keepdims=True)
    if not (norms > 0.5).all():
        raise _fault(path, "holds an orientation that is no unit quaternion; export it again")
    w, x, y, z = np.moveaxis(quaternions / norms, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.stack([np.stack(row, -1) for row in rows], -2)


def _quaternions(R: Floats) -> Floats:
    """(..., 3, 3) rotations as (..., 4) unit quaternions w x y z.

    Of each the largest column of the matrix q q^T, which never loses digits.
    """
    xx, yy, zz = R[..., 0, 0], R[..., 1, 1], R[..., 2, 2]
    wx, wy, wz = (
        R[..., 2, 1] - R[..., 1, 2],
        R[..., 0, 2] - R[..., 2, 0],
        R[..., 1, 0] - R[..., 0, 1],
    )
    xy, xz, yz = (
        R[..., 0, 1] + R[..., 1, 0],
        R[..., 0, 2] + R[..., 2, 0],
        R[..., 1, 2] + R[..., 2, 1],
    )
    columns = np.stack([
        np.stack([1 + xx + yy + zz, wx, wy, wz], -1),
        np.stack([wx, 1 + xx - yy - zz, xy, xz], -1),
        np.stack([wy, xy, 1 - xx + yy - zz, yz], -1),
        np.stack([wz, xz, yz, 1 - xx - yy + zz], -1),
    ], -2)  # fmt: skip
    diagonal = np.diagonal(columns, axis1=-2, axis2=-1)
    best = np.take_along_axis(columns, diagonal.argmax(-1)[..., None, None], -2)[..., 0, :]
    return np.asarray(best / np.linalg.norm(best, axis=-1, keepdims=True))


def _fault(path: Path, problem: str) -> FormatError:
    error = FormatError(f"{path}: {problem}")
    error.path = str(path)
    return error
