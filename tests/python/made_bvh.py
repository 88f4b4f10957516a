# SPDX-License-Identifier: GPL-3.0-or-later
"""BVH texts of people that tests make: joints as (name, parent, offset in cm), angles by joint."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

Joint = tuple[str, str | None, tuple[float, float, float]]
Angles = Mapping[str, tuple[float, float, float]]

PERSON: tuple[Joint, ...] = (
    ("Hips", None, (0.0, 94.0, 0.0)),
    ("Spine", "Hips", (0.0, 12.0, 0.0)),
    ("Chest", "Spine", (0.0, 22.0, 0.0)),
    ("Neck", "Chest", (0.0, 21.0, 0.0)),
    ("Head", "Neck", (0.0, 9.0, 0.0)),
    ("LeftCollar", "Chest", (3.0, 17.0, 0.0)),
    ("LeftShoulder", "LeftCollar", (14.0, 0.0, 0.0)),
    ("LeftElbow", "LeftShoulder", (29.0, 0.0, 0.0)),
    ("LeftWrist", "LeftElbow", (26.0, 0.0, 0.0)),
    ("RightCollar", "Chest", (-3.0, 17.0, 0.0)),
    ("RightShoulder", "RightCollar", (-14.0, 0.0, 0.0)),
    ("RightElbow", "RightShoulder", (-29.0, 0.0, 0.0)),
    ("RightWrist", "RightElbow", (-26.0, 0.0, 0.0)),
    ("LeftHip", "Hips", (9.0, -4.0, 0.0)),
    ("LeftKnee", "LeftHip", (0.0, -42.0, 0.0)),
    ("LeftAnkle", "LeftKnee", (0.0, -40.0, 0.0)),
    ("RightHip", "Hips", (-9.0, -4.0, 0.0)),
    ("RightKnee", "RightHip", (0.0, -42.0, 0.0)),
    ("RightAnkle", "RightKnee", (0.0, -40.0, 0.0)),
)
TIPS = {"Head": (0.0, 18.0, 0.0), "LeftWrist": (9.0, 0.0, 0.0), "RightWrist": (-9.0, 0.0, 0.0)}


def changed(
    joints: Sequence[Joint] = PERSON,
    names: Mapping[str, str] | None = None,
    scale: float = 1.0,
) -> tuple[Joint, ...]:
    """The joints under other names and in another unit."""
    new = names or {}
    return tuple(
        (new.get(name, name), new.get(parent, parent) if parent else None,
         (offset[0] * scale, offset[1] * scale, offset[2] * scale))
        for name, parent, offset in joints
    )  # fmt: skip


def hierarchy(joints: Sequence[Joint] = PERSON, end_site: str = "End Site") -> str:
    """The HIERARCHY section; leaves get an End Site."""
    lines = ["HIERARCHY"]

    def write(joint: Joint, depth: int) -> None:
        name, parent, offset = joint
        indent = "  " * depth
        children = [child for child in joints if child[1] == name]
        position = "6 Xposition Yposition Zposition" if parent is None else "3"
        lines.append(f"{indent}{'ROOT' if parent is None else 'JOINT'} {name}")
        lines.append(indent + "{")
        lines.append(f"{indent}  OFFSET {' '.join(map(str, offset))}")
        lines.append(f"{indent}  CHANNELS {position} Zrotation Xrotation Yrotation")
        for child in children:
            write(child, depth + 1)
        if not children:
            tip = TIPS.get(name, (0.0, 0.0, 0.0))
            lines.append(f"{indent}  {end_site}\n{indent}  {{")
            lines.append(f"{indent}    OFFSET {' '.join(map(str, tip))}\n{indent}  }}")
        lines.append(indent + "}")

    write(joints[0], 0)
    return "\n".join(lines) + "\n"


def _order(joints: Sequence[Joint]) -> list[str]:
    names: list[str] = []

    def visit(name: str) -> None:
        names.append(name)
        for child in joints:
            if child[1] == name:
                visit(child[0])

    visit(joints[0][0])
    return names


def row(
    joints: Sequence[Joint], root: tuple[float, float, float], angles: Angles | None = None
) -> str:
    """A frame: the root's position and each joint's angles z, x, y in degrees."""
    given = angles or {}
    numbers = [*root]
    for name in _order(joints):
        numbers += given.get(name, (0.0, 0.0, 0.0))
    return " ".join(f"{number:.6f}" for number in numbers)


def bvh(
    joints: Sequence[Joint] = PERSON,
    frames: Sequence[tuple[tuple[float, float, float], Angles]] | None = None,
    frame_time: str = "0.0333333",
    end_site: str = "End Site",
) -> str:
    """A whole file; without frames the person stands for four of them."""
    standing = joints[0][2]
    rows = [row(joints, *frame) for frame in frames or [(standing, {})] * 4]
    head = f"MOTION\nFrames: {len(rows)}\nFrame Time: {frame_time}\n"
    return hierarchy(joints, end_site) + head + "\n".join(rows) + "\n"


def walking(turn: Callable[[float, float], tuple[tuple[float, float, float], Angles]]
            | None = None, num_frames: int = 60) -> str:  # fmt: skip
    """A person who swings arms and legs on the way; turn gives the root's place and angles."""
    frames = []
    for t in range(num_frames):
        swing = 25.0 * np.sin(2.0 * np.pi * t / 30)
        ahead = 4.0 * t
        root, hips = turn(ahead, 92.0) if turn else ((0.0, 92.0, ahead), {})
        angles = {"LeftHip": (0.0, swing, 0.0), "RightHip": (0.0, -swing, 0.0),
                  "LeftKnee": (0.0, max(0.0, swing), 0.0), "LeftShoulder": (-70.0, 0.0, swing),
                  "RightShoulder": (70.0, 0.0, swing)}  # fmt: skip
        frames.append((root, angles | dict(hips)))
    return bvh(frames=frames)
