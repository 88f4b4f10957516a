# SPDX-License-Identifier: GPL-3.0-or-later
"""Ankle trajectories of feet that roll over the floor without sliding.

On the floor a foot is flat, or turns about the end of its heel (toes up) or about its toes (heel
up); the floor point it turns about stays where it is.  In the air the ankle follows a quintic whose
position, velocity and acceleration agree with the rolling foot at both ends.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import inf

import numpy as np

from .body import Body
from .curves import Array, Knot, ramp, through

__all__ = ["Planted", "Step", "Via", "foot_curve", "on_toes"]


@dataclass(frozen=True)
class Via:
    """A point the ankle passes in the air: world position (cm), foot pitch (rad)."""

    time: float
    ankle: tuple[float, float, float]
    pitch: float


@dataclass(frozen=True)
class Step:
    """One stay in the air, from leaving the floor to being flat on it again."""

    lift: float
    strike: float
    target: tuple[float, float]
    """Where the ankle comes to stand: x and z in cm."""
    heading: float
    push: float = 0.25
    """Seconds from the flat foot to leaving the floor."""
    settle: float = 0.12
    """Seconds from touching the floor to the flat foot."""
    toe_off: float = 0.3
    landing: float = -0.1
    """Pitch on touching the floor: negative lands on the heel."""
    clearance: float = 4.0
    """Lift (cm) of the ankle in the air beyond what the roll gives."""
    vias: tuple[Via, ...] = ()


@dataclass(frozen=True)
class Planted:
    """Where a foot stands between two steps, and when (s)."""

    since: float
    until: float
    target: tuple[float, float]
    heading: float


def foot_curve(
    time: Array, body: Body, start: tuple[float, float], heading: float, steps: list[Step]
) -> Array:
    """Columns (n, 5): ankle position (cm), heading and pitch (rad) of one foot.

    The foot first stands at ``start`` with ``heading``, then takes the ``steps`` in order.
    """
    stands = [Planted(-inf, inf, start, heading)]
    for step in steps:
        last = stands.pop()
        stands.append(Planted(last.since, step.lift, last.target, last.heading))
        stands.append(Planted(step.strike, inf, step.target, step.heading))
    pitch = _pitch(time, steps)
    result = np.empty((len(time), 5))
    for stand in stands:
        here = (time >= stand.since) & (time <= stand.until)
        result[here, :3] = _rolling(body, stand, pitch[0][here])[0]
        result[here, 3] = stand.heading
        result[here, 4] = pitch[0][here, 0]
    for step, (before, after) in zip(steps, pairwise(stands), strict=True):
        here = (time > step.lift) & (time < step.strike)
        result[here, :3] = _airborne(time[here], body, steps, step, before, after)
        share = ramp(time[here], step.lift, step.strike)
        result[here, 3] = before.heading + share * (after.heading - before.heading)
        result[here, 4] = pitch[0][here, 0]
    return result


def on_toes(ankles: Array, body: Body, raised: Array) -> Array:
    """A standing foot (n, 5) with its heel raised by the pitch ``raised`` (n,) in addition."""
    result = ankles.copy()
    ahead, up = _pivot(body, raised[:, None])
    result[:, 0] += ahead[:, 0] * np.sin(ankles[:, 3])
    result[:, 1] += up[:, 0] - body.ankle
    result[:, 2] += ahead[:, 0] * np.cos(ankles[:, 3])
    result[:, 4] += raised
    return result


def _pitch(time: Array, steps: list[Step]) -> tuple[Array, Array, Array]:
    """Pitch of the foot (n, 1) and its first two derivatives."""
    knots: list[Knot] = [Knot(-1e3, 0.0)]
    for step in steps:
        rate = 1.6 * step.toe_off / step.push
        air = step.strike - step.lift
        knots += [Knot(step.lift - step.push, 0.0), Knot(step.lift, step.toe_off, rate)]
        if step.vias:
            knots += [Knot(via.time, via.pitch) for via in step.vias]
        else:
            crest = step.toe_off + 0.5 * rate * 0.16 * air
            knots.append(Knot(step.lift + 0.16 * air, crest))
            knots.append(Knot(step.lift + 0.80 * air, step.landing))
        knots += [Knot(step.strike, step.landing), Knot(step.strike + step.settle, 0.0)]
    knots.append(Knot(1e3, 0.0))
    return through(time, knots)


def _pivot(body: Body, pitch: Array) -> tuple[Array, Array]:
    """Ankle of a rolling foot: cm ahead of its flat place, and cm above the floor."""
    arm = np.where(pitch >= 0.0, body.toe, -body.heel)
    sin, cos = np.sin(pitch), np.cos(pitch)
    return arm + body.ankle * sin - arm * cos, body.ankle * cos + arm * sin


def _rolling(
    body: Body, stand: Planted, pitch: Array, rate: Array | float = 0.0, bend: Array | float = 0.0
) -> tuple[Array, Array, Array]:
    """Ankle (n, 3), velocity and acceleration of a foot on the floor with ``pitch`` (n, 1)."""
    arm = np.where(pitch >= 0.0, body.toe, -body.heel)
    sin, cos = np.sin(pitch), np.cos(pitch)
    ahead, up = _pivot(body, pitch)
    along, above = body.ankle * cos + arm * sin, arm * cos - body.ankle * sin
    course = np.array([np.sin(stand.heading), 0.0, np.cos(stand.heading)])
    rise = np.array([0.0, 1.0, 0.0])
    place = np.array([stand.target[0], 0.0, stand.target[1]]) + ahead * course + up * rise
    speed = rate * (along * course + above * rise)
    turning = rate**2 * (above * course - along * rise)
    return place, speed, bend * (along * course + above * rise) + turning


def _airborne(
    time: Array, body: Body, steps: list[Step], step: Step, before: Planted, after: Planted
) -> Array:
    """Ankle positions (n, 3) between leaving and touching the floor."""
    ends = []
    for moment, stand in ((step.lift, before), (step.strike, after)):
        state = _rolling(body, stand, *_pitch(np.array([moment]), steps))
        ends.append(Knot(moment, *(x[0] for x in state)))
    knots = [ends[0], *(Knot(via.time, np.array(via.ankle)) for via in step.vias), ends[1]]
    ankle = through(time, _in_passing(knots))[0]
    share = (time - step.lift) / (step.strike - step.lift)
    ankle[:, 1] += step.clearance * (4.0 * share * (1.0 - share)) ** 3
    return ankle


def _in_passing(knots: list[Knot]) -> list[Knot]:
    """The knots with speeds at the inner ones that carry on from neighbour to neighbour.

    A coordinate that turns back at a knot stops there, and none is so fast that it overshoots.
    """
    result = knots.copy()
    for i in range(1, len(knots) - 1):
        before, here, after = knots[i - 1 : i + 2]
        come, go = np.asarray(here.value) - before.value, np.asarray(after.value) - here.value
        limit = 3.0 * np.minimum(np.abs(come), np.abs(go))
        limit /= min(here.time - before.time, after.time - here.time)
        speed = np.clip((come + go) / (after.time - before.time), -limit, limit)
        result[i] = Knot(here.time, here.value, np.where(come * go > 0.0, speed, 0.0))
    return result
