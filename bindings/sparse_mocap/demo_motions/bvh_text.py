# SPDX-License-Identifier: GPL-3.0-or-later
"""Writing a posed motion as BVH text (offsets and root in cm, rotations in degrees, z y x)."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .body import INDEX, JOINTS, PARENTS, Body
from .curves import FRAME_RATE, Array
from .kinematics import angles_zyx
from .solve import Pose

__all__ = ["write_bvh"]


def write_bvh(path: Path, body: Body, pose: Pose) -> Path:
    """Write ``pose`` of the skeleton of ``body`` to ``path``."""
    lines = ["HIERARCHY", *_hierarchy(body, 0, 0), "MOTION"]
    lines += [f"Frames: {len(pose.root)}", f"Frame Time: {1.0 / FRAME_RATE:.7f}"]
    path.write_text("\n".join([*lines, *_rows(pose)]) + "\n", encoding="ascii", newline="\n")
    return path


def _hierarchy(body: Body, joint: int, depth: int) -> list[str]:
    """Lines of ``joint`` and everything below it."""
    name, pad = JOINTS[joint], "\t" * depth
    position = "Xposition Yposition Zposition " if joint == 0 else ""
    count = 6 if joint == 0 else 3
    inner = [
        _offset(body.offsets()[joint]),
        f"CHANNELS {count} {position}Zrotation Yrotation Xrotation",
    ]
    children = [i for i, parent in enumerate(PARENTS) if parent == joint]
    for child in children:
        inner += _hierarchy(body, child, 0)
    if not children:
        inner += ["End Site", "{", "\t" + _offset(body.ends()[name]), "}"]
    kind = "ROOT" if joint == 0 else "JOINT"
    return [f"{pad}{kind} {name}", f"{pad}{{", *(f"{pad}\t{line}" for line in inner), f"{pad}}}"]


def _offset(offset: Array) -> str:
    x, y, z = offset + 0.0
    return f"OFFSET {x:.5f} {y:.5f} {z:.5f}"


def _rows(pose: Pose) -> list[str]:
    """One line of numbers a frame; channels that never move are written as a bare zero."""
    angles = np.degrees(angles_zyx(pose.local))
    for side in ("Left", "Right"):
        angles[:, INDEX[f"{side}Leg"], :2] = 0.0
        angles[:, INDEX[f"{side}Hand"], :2] = 0.0
        angles[:, INDEX[f"{side}Shoulder"], 2] = 0.0
    table = np.concatenate([pose.root, angles.reshape(len(angles), -1)], axis=1)
    table = np.round(table, 4) + 0.0
    moving = np.any(table != 0.0, axis=0)
    form = " ".join("%.4f" if m else "0" for m in moving)
    return [form % tuple(row) for row in table[:, moving].tolist()]
