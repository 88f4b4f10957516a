# SPDX-License-Identifier: GPL-3.0-or-later
"""A second reader of .bvh, simple and slow, to compare with. Units and axes of the file."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np


@dataclass
class Node:
    name: str
    parent: int
    offset: np.ndarray = field(default_factory=lambda: np.zeros(3))
    channels: list[str] = field(default_factory=list)
    is_end: bool = False


def read(path: Path) -> tuple[list[Node], np.ndarray, float]:
    """The nodes (parents first, End Sites too), (T, channels) and the time of a frame (s)."""
    lines = iter(path.read_text(encoding="utf-8", errors="replace").split("\n"))
    nodes: list[Node] = []
    stack: list[int] = []
    for line in lines:
        words = line.split()
        if not words:
            continue
        if words[0] in ("ROOT", "JOINT", "End"):
            parent = stack[-1] if stack else -1
            nodes.append(Node("_".join(words[1:]), parent, is_end=words[0] == "End"))
        elif words[0] == "{":
            stack.append(len(nodes) - 1)
        elif words[0] == "}":
            stack.pop()
        elif words[0] == "OFFSET":
            nodes[stack[-1]].offset = np.array(words[1:4], dtype=float)
        elif words[0] == "CHANNELS":
            nodes[stack[-1]].channels = [word[:1].lower() + word[1:] for word in words[2:]]
        elif words[0] == "Frame":
            frame_time_s = float(words[2])
            break
    rows = [[float(word) for word in line.split()] for line in lines if line.strip()]
    return nodes, np.array(rows), frame_time_s


def turn(axis: str, degrees: float) -> np.ndarray:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[j, i], matrix[i, j] = s, -s
    return matrix


def places(nodes: list[Node], row: np.ndarray) -> np.ndarray:
    """(N, 3) where the nodes are in a frame; a position channel stands for the offset's number."""
    values = iter(row)
    points, turns = np.zeros((len(nodes), 3)), []
    for index, node in enumerate(nodes):
        offset, matrix = node.offset.copy(), np.eye(3)
        moved = {}
        for channel in node.channels:
            value = next(values)
            if channel.endswith("position"):
                moved["xyz".index(channel[0])] = value
            else:
                matrix = matrix @ turn(channel[0], value)
        for axis, value in moved.items():
            offset[axis] = value
        if node.parent >= 0:
            points[index] = points[node.parent] + turns[node.parent] @ offset
            matrix = turns[node.parent] @ matrix
        else:
            points[index] = offset
        turns.append(matrix)
    return points
