# SPDX-License-Identifier: GPL-3.0-or-later
"""Control curves: the table of numbers over time from which a pose is made.

A motion is an array (n, WIDTH), one row a frame.  Lengths are cm, angles radians.

==========  =======================================================================
``PLACE``   world position of the pelvis
``FACING``  heading: rotation about y from +z towards +x (to the left)
``TILT``    pelvis relative to the heading: pitch (forward), yaw (left), roll (left up)
``SPINE``   thorax relative to the pelvis, same three
``HEAD``    head relative to the thorax, same three
``ARM``     for a side: forward raise, sideways raise, inward twist, elbow, forearm twist
``FOOT``    for a side: world position of the ankle, heading, pitch (toes down), knee outward
==========  =======================================================================
"""

from __future__ import annotations

from math import radians

import numpy as np

from .curves import Array
from .style import Actor

__all__ = ["cropped", "displaced", "half_stance", "mirror", "neutral", "set_back"]

PLACE = slice(0, 3)
FACING = 3
TILT = slice(4, 7)
SPINE = slice(7, 10)
HEAD = slice(10, 13)
ARM = {"left": slice(13, 18), "right": slice(18, 23)}
FOOT = {"left": slice(23, 29), "right": slice(29, 35)}
WIDTH = 35

SIDES = (("left", 1.0), ("right", -1.0))

STANDING = 0.989
"""Length of the standing leg as a share of the straight leg."""

_ACROSS = (0, FOOT["left"].start, FOOT["right"].start)
_HEADINGS = (FACING, FOOT["left"].start + 3, FOOT["right"].start + 3)


def half_stance(actor: Actor) -> float:
    """Distance (cm) of each ankle from the middle when standing at ease."""
    return float(actor.body.hip[0]) * 1.02 * actor.style.stance


def set_back(actor: Actor) -> float:
    """Distance (cm) of the ankles behind the pelvis when standing at ease."""
    return 0.018 * actor.body.height


def neutral(actor: Actor) -> Array:
    """The row (WIDTH,) of standing at ease at the origin: where every exercise starts and ends."""
    body, style = actor.body, actor.style
    row = np.zeros(WIDTH)
    row[1] = body.ankle + STANDING * body.leg - body.hip[1]
    row[SPINE.start] = style.stoop
    row[HEAD.start] = -0.8 * style.stoop
    for side, sign in SIDES:
        row[ARM[side]] = [radians(3), style.carriage, radians(40), style.elbow, radians(-25)]
        row[FOOT[side]] = [
            sign * half_stance(actor),
            body.ankle,
            -set_back(actor),
            sign * style.toe_out,
            0.0,
            radians(3),
        ]
    return row


def mirror(motion: Array) -> Array:
    """The motion seen in the mirror plane x = 0: left and right exchanged."""
    result = motion.copy()
    for block in (ARM, FOOT):
        result[:, block["left"]] = motion[:, block["right"]]
        result[:, block["right"]] = motion[:, block["left"]]
    flipped = [*_ACROSS, *_HEADINGS]
    flipped += [block.start + i for block in (TILT, SPINE, HEAD) for i in (1, 2)]
    result[:, flipped] *= -1.0
    return result


def displaced(motion: Array, heading: float, x: float, z: float) -> Array:
    """The motion turned about the vertical through the origin by ``heading``, then moved (cm)."""
    result = motion.copy()
    cos, sin = np.cos(heading), np.sin(heading)
    for start in _ACROSS:
        result[:, start] = x + cos * motion[:, start] + sin * motion[:, start + 2]
        result[:, start + 2] = z - sin * motion[:, start] + cos * motion[:, start + 2]
    result[:, _HEADINGS] += heading
    return result


def cropped(motion: Array, first: int, last: int) -> Array:
    """Frames ``first`` to ``last``, moved so that they start at the origin and face ahead."""
    part = motion[first:last]
    heading, x, z = part[0, FACING], part[0, 0], part[0, 2]
    cos, sin = np.cos(heading), np.sin(heading)
    return displaced(part, -heading, -(cos * x - sin * z), -(sin * x + cos * z))
