# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's own figure: names that Blender mirrors, and feet, toes and hands. No Blender here.

The standard skeleton ends at ankles and wrists; what lies beyond turns with its parent, unless a
skeleton has these joints too.
"""

from __future__ import annotations

import numpy as np

from .axes import Floats

_TRUNK = {
    "root": "pelvis",
    "lowerback": "spine",
    "upperback": "spine.001",
    "thorax": "chest",
    "lowerneck": "neck",
    "upperneck": "neck.001",
    "head": "head",
}
_SIDED = {
    "hipjoint": "hip",
    "femur": "thigh",
    "tibia": "shin",
    "foot": "foot",
    "toes": "toe",
    "clavicle": "shoulder",
    "humerus": "upper_arm",
    "radius": "forearm",
    "wrist": "wrist",
    "hand": "hand",
    "fingers": "fingers",
    "thumb": "thumb",
}
NAMES: dict[str, str] = {
    **_TRUNK,
    **{f"l{joint}": f"{bone}.L" for joint, bone in _SIDED.items()},
    **{f"r{joint}": f"{bone}.R" for joint, bone in _SIDED.items()},
}
"""The figure's bone of each joint."""

# Where feet, toes and hands end from where they begin, relative to the leg (thigh and shank), in
# the core's axes: how people are built (Winter 2009, table 4.1 and figure 4.1).
_BEYOND = {
    "foot": ("shin", np.array([0.0, -0.095, 0.14])),
    "toe": ("foot", np.array([0.0, -0.015, 0.075])),
}
_HAND = 0.11  # along the wrist


def figure_names(joints: list[str]) -> list[str]:
    """The bones of the joints, as the figure names them."""
    return [NAMES.get(joint, joint) for joint in joints]


def leg_length(joints: list[str], bones: Floats) -> float:
    """Thigh and shank (m), mean of both sides; 0 for a skeleton without them."""
    lengths = [
        float(np.linalg.norm(bones[joints.index(name)]))
        for name in ("lfemur", "ltibia", "rfemur", "rtibia")
        if name in joints
    ]
    return 0.5 * sum(lengths)


def beyond(
    names: list[str], heads: Floats, tails: Floats, leg_m: float
) -> list[tuple[str, int, Floats, Floats]]:
    """Name, parent, head and tail of the bones beyond ankles and wrists that are not there yet."""
    made: list[tuple[str, int, Floats, Floats]] = []
    ends = dict(zip(names, tails, strict=True))
    index = {name: number for number, name in enumerate(names)}

    def add(name: str, parent: str, head: Floats, tail: Floats) -> None:
        if name in index or parent not in index:
            return
        made.append((name, index[parent], head, tail))
        index[name] = len(names) + len(made) - 1
        ends[name] = tail

    for side in (".L", ".R"):
        for part, (parent, along) in _BEYOND.items():
            if parent + side in ends:
                head = ends[parent + side]
                add(part + side, parent + side, head, head + leg_m * along)
        wrist = "wrist" + side
        if wrist in index:
            along = ends[wrist] - heads[index[wrist]]
            length = float(np.linalg.norm(along))
            if length > 0.0:
                head = ends[wrist]
                add("hand" + side, wrist, head, head + _HAND * leg_m / length * along)
    return made
