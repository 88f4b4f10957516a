# SPDX-License-Identifier: GPL-3.0-or-later
"""SMPL, SMPL-H and SMPL-X motion in NumPy archives (``.npz``): AMASS, and what solves video.

Arrays (T frames): ``poses`` (T, 3 J) rotation vectors of the joints relative to their parents, or
``root_orient`` (T, 3) and ``pose_body`` (T, 63); ``trans`` (T, 3) m; a rate. The body model, which
has the joints' places for each ``betas``, has a licence of its own, so an average person's bones
stand in for it. Fingers, face and soft tissue are left out.
"""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._core import FormatError, Motion, Skeleton

__all__ = ["JOINTS", "read_smpl"]

Floats = NDArray[np.float64]

JOINTS = (
    ("pelvis", -1, (0.0, -0.22, 0.03)),
    ("left_hip", 0, (0.07, -0.09, -0.01)),
    ("right_hip", 0, (-0.07, -0.09, -0.01)),
    ("spine1", 0, (0.0, 0.11, -0.025)),
    ("left_knee", 1, (0.035, -0.38, -0.005)),
    ("right_knee", 2, (-0.035, -0.38, -0.005)),
    ("spine2", 3, (0.0, 0.135, 0.0)),
    ("left_ankle", 4, (-0.015, -0.4, -0.04)),
    ("right_ankle", 5, (0.015, -0.4, -0.04)),
    ("spine3", 6, (0.0, 0.055, 0.025)),
    ("left_foot", 7, (0.025, -0.055, 0.12)),
    ("right_foot", 8, (-0.025, -0.055, 0.12)),
    ("neck", 9, (0.0, 0.215, -0.04)),
    ("left_collar", 9, (0.08, 0.12, -0.035)),
    ("right_collar", 9, (-0.08, 0.12, -0.035)),
    ("head", 12, (0.0, 0.065, 0.05)),
    ("left_shoulder", 13, (0.095, 0.03, -0.01)),
    ("right_shoulder", 14, (-0.095, 0.03, -0.01)),
    ("left_elbow", 16, (0.255, -0.015, -0.025)),
    ("right_elbow", 17, (-0.255, -0.015, -0.025)),
    ("left_wrist", 18, (0.25, 0.01, -0.005)),
    ("right_wrist", 19, (-0.25, 0.01, -0.005)),
)
"""Name, parent and place in the parent (m, y up, facing z) of the joints that all models share."""

_TIP_BONES = {
    "head": (0.0, 0.2, 0.0),
    "left_wrist": (0.09, 0.0, 0.0),
    "right_wrist": (-0.09, 0.0, 0.0),
    "left_foot": (0.0, 0.0, 0.05),
    "right_foot": (0.0, 0.0, 0.05),
}
_RATES = ("mocap_framerate", "mocap_frame_rate", "framerate", "frame_rate", "fps")
_USUAL_RATE_HZ = 30.0
_MOST_BYTES = 1 << 30
_MOST_FRAMES = 3_000_000
_R_WORLD_AMASS = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def read_smpl(path: Path) -> tuple[Motion, list[str]]:
    """The motion in the archive, on an average person's skeleton, and warnings.

    Raises FormatError, for pickled and too large arrays too, and OSError.
    """
    arrays = _arrays(path)
    poses, translation = _poses(path, arrays), _floats(path, arrays, "trans")
    if translation.shape != (len(poses), 3):
        raise _fault(path, f"has trans of shape {translation.shape} for {len(poses)} poses")
    rate_hz, warnings = _rate_hz(path, arrays)
    warnings.append(
        "SMPL: an average person's bone lengths are used, since the body model is not at hand"
    )
    rotations = _quaternions(poses)
    positions = translation + np.array(JOINTS[0][2])
    if "mocap_framerate" in arrays or "mocap_frame_rate" in arrays:  # AMASS, which has z up
        positions = positions @ _R_WORLD_AMASS.T
        turn = np.array([np.sqrt(0.5), -np.sqrt(0.5), 0.0, 0.0])
        rotations[:, 0] = _product(turn, rotations[:, 0])
    return Motion(_skeleton(), 1.0 / rate_hz, positions, rotations), warnings


def _arrays(path: Path) -> dict[str, Any]:
    """The arrays by name, loaded when asked for; none that is too large."""
    try:
        with zipfile.ZipFile(path) as archive:
            size = sum(entry.file_size for entry in archive.infolist())
        if size > _MOST_BYTES:
            raise _fault(path, f"holds {size} bytes unpacked, more than {_MOST_BYTES}")
        with np.load(path, allow_pickle=False) as archive:
            wanted = {"poses", "root_orient", "pose_body", "trans", *_RATES}
            return {name: archive[name] for name in archive.files if name in wanted}
    except (zipfile.BadZipFile, ValueError, EOFError, KeyError) as error:
        if isinstance(error, FormatError):
            raise
        raise _fault(path, f"is not a NumPy archive of numbers ({error}); save it again") from None


def _poses(path: Path, arrays: dict[str, Any]) -> Floats:
    """(T, 22, 3) rotation vectors, rad."""
    if "poses" in arrays:
        poses = _floats(path, arrays, "poses")
    elif "root_orient" in arrays and "pose_body" in arrays:
        poses = np.hstack(
            [_floats(path, arrays, "root_orient"), _floats(path, arrays, "pose_body")]
        )
    else:
        raise _fault(
            path, "holds no SMPL motion: there is neither poses nor root_orient and pose_body"
        )
    poses = poses.reshape(len(poses), -1)
    if not len(poses) or poses.shape[1] < 3 * len(JOINTS) or poses.shape[1] % 3:
        raise _fault(path, f"has poses of shape {poses.shape}; 66 or more columns are needed")
    if len(poses) > _MOST_FRAMES:
        raise _fault(path, f"has {len(poses)} frames, more than {_MOST_FRAMES}")
    return poses[:, : 3 * len(JOINTS)].reshape(len(poses), len(JOINTS), 3)


def _floats(path: Path, arrays: dict[str, Any], name: str) -> Floats:
    if name not in arrays:
        raise _fault(path, f"holds no {name}")
    values = arrays[name]
    if values.dtype.kind not in "fiu" or values.ndim < 2 or not np.isfinite(values).all():
        raise _fault(path, f"{name} is no table of finite numbers")
    return np.asarray(values, dtype=np.float64)


def _rate_hz(path: Path, arrays: dict[str, Any]) -> tuple[float, list[str]]:
    for name in _RATES:
        if name not in arrays:
            continue
        value = np.asarray(arrays[name])
        if value.size == 1 and value.dtype.kind in "fiu" and 1.0 <= value.item() <= 10_000.0:
            return float(value.item()), []
        raise _fault(path, f"{name} is no frame rate from 1 to 10000 Hz")
    return _USUAL_RATE_HZ, [f"no frame rate is stated; {_USUAL_RATE_HZ:g} Hz is used"]


def _quaternions(vectors: Floats) -> Floats:
    """(..., 3) rotation vectors as (..., 4) quaternions w x y z."""
    angle = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.concatenate([np.cos(0.5 * angle), 0.5 * np.sinc(angle / (2.0 * np.pi)) * vectors], -1)


def _product(p: Floats, q: Floats) -> Floats:
    """One quaternion by each of (T, 4)."""
    w, v = q[:, :1], q[:, 1:]
    return np.hstack([p[0] * w - v @ p[1:, None], p[0] * v + w * p[1:] + np.cross(p[1:], v)])


def _skeleton() -> Skeleton:
    pivots: list[Floats] = []
    for _, parent, place in JOINTS:
        pivots.append(np.array(place) + pivots[parent] if parent >= 0 else np.zeros(3))
    names = [name for name, _, _ in JOINTS]
    tips = np.array([_TIP_BONES.get(name, (0.0, 0.0, 0.0)) for name in names])
    return Skeleton(names, [parent for _, parent, _ in JOINTS], pivots, np.array(pivots) + tips)


def _fault(path: Path, problem: str) -> FormatError:
    error = FormatError(f"{path}: {problem}")
    error.path = str(path)
    return error
