# SPDX-License-Identifier: GPL-3.0-or-later
"""Exercises on the spot.  Each returns control curves that start and end standing at ease.

One-sided exercises are written for the left; :func:`controls.mirror` makes the right one.  Counts
are repetitions, ``period`` and ``pace`` seconds of one repetition, sizes factors about 1.
"""

from __future__ import annotations

from math import pi, radians

import numpy as np

from .controls import ARM, FOOT, HEAD, PLACE, SIDES, SPINE, TILT, neutral
from .curves import Array, cruise, pulse, pulses, timeline
from .feet import Step, Via, foot_curve, on_toes
from .style import Actor

__all__ = [
    "arm_circles",
    "arm_swings",
    "hugs",
    "idle",
    "jacks",
    "kick",
    "reach_high",
    "reach_low",
    "squat",
]

LEAD = 0.3
TAIL = 0.35


def _still(actor: Actor, duration: float) -> tuple[Array, Array]:
    """Times (s) and the control curves of standing at ease for ``duration`` seconds."""
    time = timeline(duration)
    return time, np.tile(neutral(actor), (len(time), 1))


def _add(motion: Array, block: slice, curve: Array, size: list[float]) -> None:
    """Add a curve (n,) to the columns of ``block``, times the sizes given in cm or degrees."""
    unit = 1.0 if block == PLACE else pi / 180.0
    motion[:, block] += unit * curve[:, None] * np.array(size)


def squat(actor: Actor, count: int, period: float, depth: float = 1.0) -> Array:
    """Deep knee bends with the arms raised ahead; ``depth`` 1 brings the thighs near level."""
    time, motion = _still(actor, LEAD + count * period + TAIL)
    starts = [LEAD + k * period for k in range(count)]
    down = pulses(time, starts, 0.46 * period, 0.06 * period, 0.46 * period)
    leg = actor.body.leg
    _add(motion, PLACE, down, [0.0, -0.40 * leg * depth, -0.10 * leg * depth])
    _add(motion, TILT, down, [20 * depth, 0, 0])
    _add(motion, SPINE, down, [14 * depth, 0, 0])
    _add(motion, HEAD, down, [-24 * depth, 0, 0])
    for side, _ in SIDES:
        _add(motion, ARM[side], down, [110 * min(depth, 1.1), 2, -15, -2, 10])
        motion[:, FOOT[side]][:, 5] += radians(13) * depth * down
    return motion


def jacks(actor: Actor, count: int, period: float, size: float = 1.0) -> Array:
    """Jumping jacks: hop apart with the arms overhead, hop back."""
    half = 0.5 * period
    time, motion = _still(actor, 0.55 + count * period + 0.5)
    hops = [0.55 + k * half for k in range(2 * count)]
    air = min(0.30, 0.58 * half)
    span = 0.92 * half
    centres = [hop + 0.5 * air for hop in hops]
    opened = pulses(time, [c - 0.5 * span for c in centres[::2]], span, half - span, span)
    first, last = centres[0], centres[-1]
    going = pulse(time, first - half, half, last - first, half)
    rise = 3.6 * size * np.cos(2.0 * pi * (time - first) / half) - 3.8
    motion[:, PLACE.start + 1] += going * rise - 1.2 * opened
    _add(motion, SPINE, going, [3, 0, 0])
    for side, sign in SIDES:
        _add(motion, ARM[side], opened, [8, 148 * min(size, 1.05), 0, 6, 0])
        rest = motion[0, FOOT[side]].copy()
        wide = (sign * 0.165 * actor.body.leg * size, sign * radians(7))
        steps = _hops(rest, hops, air, half, wide)
        motion[:, FOOT[side]][:, :5] = foot_curve(
            time, actor.body, (rest[0], rest[2]), rest[3], steps
        )
    return motion


def _hops(
    rest: Array, times: list[float], air: float, period: float, wide: tuple[float, float]
) -> list[Step]:
    """Hops of one foot from toes to toes, by turns out (cm, rad beyond ``rest``) and back."""
    steps = []
    for k, lift in enumerate(times):
        out, turned = wide if k % 2 == 0 else (0.0, 0.0)
        steps.append(
            Step(
                lift=lift,
                strike=lift + air,
                target=(float(rest[0]) + out, float(rest[2])),
                heading=float(rest[3]) + turned,
                push=0.11,
                settle=min(0.11, period - air - 0.12),
                toe_off=radians(24),
                landing=radians(16),
                clearance=1.5,
            )
        )
    return steps


def arm_circles(actor: Actor, count: int, pace: float, backward: bool = False) -> Array:
    """Straight arms circling beside the body, both at once."""
    duration = count * pace + 0.5
    time, motion = _still(actor, LEAD + duration + TAIL)
    around = cruise(time, LEAD, LEAD + duration, 0.5)
    held = pulse(time, LEAD, 0.5, duration - 1.0, 0.5)
    sign = -1.0 if backward else 1.0
    turning = 2.0 * pi * around * count * sign
    for side, _ in SIDES:
        motion[:, ARM[side]][:, 0] += turning
        _add(motion, ARM[side], held, [0, 12, -15, -4, 0])
    _add(motion, SPINE, held * np.sin(turning), [4 * sign, 0, 0])
    _add(motion, PLACE, held * np.sin(turning), [0.0, 0.0, -1.2])
    return motion


def arm_swings(actor: Actor, count: int, pace: float, size: float = 1.0) -> Array:
    """Loose arms swinging far forward and back, one against the other, with soft knees."""
    time, motion = _still(actor, LEAD + count * pace + TAIL + 0.2)
    held = pulse(time, LEAD, 0.6, count * pace - 1.0, 0.6)
    swing = held * np.sin(2.0 * pi * (time - LEAD) / pace)
    for side, sign in SIDES:
        _add(motion, ARM[side], sign * swing, [58 * size, 0, 0, 8, 0])
        _add(motion, ARM[side], held, [22 * size, 3, -5, 8, 0])
    _add(motion, SPINE, swing, [0, -16 * size, 0])
    _add(motion, TILT, swing, [0, -5 * size, 0])
    _add(motion, HEAD, swing, [0, 16 * size, 0])
    dip = held * (1.0 - np.cos(4.0 * pi * (time - LEAD) / pace))
    _add(motion, PLACE, dip, [0.0, -1.3 * size, 0.0])
    return motion


def hugs(actor: Actor, count: int, pace: float, size: float = 1.0) -> Array:
    """Arms level, swinging wide open and closed in front of the chest."""
    time, motion = _still(actor, LEAD + count * pace + 1.1 + TAIL)
    held = pulse(time, LEAD, 0.7, count * pace - 0.3, 0.7)
    swing = held * np.cos(2.0 * pi * (time - LEAD - 0.7) / pace)
    for side, sign in SIDES:
        _add(motion, ARM[side], held, [80 + 3 * sign, 28, -38, 6, 10])
        _add(motion, ARM[side], swing, [0, 40 * size, 0, -7, 0])
    _add(motion, SPINE, swing, [-5 * size, 0, 0])
    return motion


def kick(actor: Actor, pace: float, height: float = 1.0) -> Array:
    """One front kick with the left leg; ``height`` 1 brings the foot to about the hip."""
    unit, start = pace / 1.5, 0.62
    lift = start + 0.12
    strike = lift + 1.16 * unit
    time, motion = _still(actor, strike + 0.75)
    shift = pulse(time, 0.12, start + 0.02, strike - start - 0.22, 0.62)
    up = pulse(time, lift - 0.1, 0.55 * unit, 0.06, 0.6 * unit)
    support = motion[0, FOOT["right"]][0]
    _add(motion, PLACE, shift, [0.86 * support, -1.0, -1.0])
    _add(motion, PLACE, up, [0.0, -1.0, -1.5])
    _add(motion, TILT, up, [-11 * height, -7, 3])
    _add(motion, SPINE, up, [9 * height, 9, -3])
    _add(motion, HEAD, up, [4, -2, 0])
    guard = pulse(time, 0.2, 0.55, strike - 0.75, 0.6)
    for side, sign in SIDES:
        _add(motion, ARM[side], guard, [24, 5, 8, 68, 0])
        _add(motion, ARM[side], up, [-12 + sign * -14, 6, 0, -10, 0])
    rest = motion[0, FOOT["left"]].copy()
    step = Step(
        lift=lift,
        strike=strike,
        target=(rest[0], rest[2]),
        heading=rest[3],
        toe_off=radians(28),
        landing=radians(10),
        clearance=0.0,
        vias=_kick_vias(actor, lift, unit, height, 0.86 * support),
    )
    motion[:, FOOT["left"]][:, :5] = foot_curve(
        time, actor.body, (rest[0], rest[2]), rest[3], [step]
    )
    return motion


def _kick_vias(
    actor: Actor, lift: float, unit: float, height: float, shift: float
) -> tuple[Via, ...]:
    """Knee drawn up, leg flung out, knee drawn back: ankle in cm from the standing hip."""
    body, row = actor.body, neutral(actor)
    hip = (row[0] + shift + body.hip[0], row[1] + body.hip[1] - 1.5, -3.0)

    def at(moment: float, length: float, elevation: float, pitch: float) -> Via:
        angle, reach = radians(elevation), length * body.leg
        place = (hip[0], hip[1] - reach * np.cos(angle), hip[2] + reach * np.sin(angle))
        return Via(lift + moment * unit, place, radians(pitch))

    return (
        at(0.34, 0.66, 34 * height, 10),
        at(0.58, 0.955, 76 * height, -38),
        at(0.83, 0.68, 36 * height, 5),
    )


def reach_high(actor: Actor, pace: float, aside: float = 0.2) -> Array:
    """The left hand stretched up, rising on the toes; ``aside`` 0 is ahead, 1 far to the side."""
    time, motion = _still(actor, LEAD + pace + TAIL)
    up = pulse(time, LEAD, 0.40 * pace, 0.16 * pace, 0.44 * pace)
    late = pulse(time, LEAD + 0.12 * pace, 0.34 * pace, 0.12 * pace, 0.36 * pace)
    half = motion[0, FOOT["left"]][0]
    raised = radians(20) * late
    for side, sign in SIDES:
        curve = on_toes(
            motion[:, FOOT[side]][:, :5], actor.body, raised * (1.0 if sign > 0 else 0.9)
        )
        motion[:, FOOT[side]][:, :5] = curve
    lift = motion[:, FOOT["right"]][:, 1] - actor.body.ankle
    motion[:, PLACE.start + 1] += 0.97 * lift
    _add(motion, PLACE, up, [0.35 * half, 0.0, 0.0])
    _add(motion, PLACE, late, [0.0, 0.0, 0.055 * actor.body.height])
    _add(motion, TILT, up, [0, -5, 3])
    _add(motion, SPINE, up, [-5, -9 + 14 * aside, 9])
    _add(motion, HEAD, up, [-16, 8, -2])
    _add(motion, ARM["left"], up, [152 - 88 * aside, 6 + 66 * aside, -10, -6, 0])
    _add(motion, ARM["right"], up, [-8, 9, 0, 8, 0])
    return motion


def reach_low(actor: Actor, pace: float, across: float = 0.0) -> Array:
    """The left hand to the floor ahead with bent knees; ``across`` turns towards the other side."""
    time, motion = _still(actor, LEAD + pace + TAIL)
    down = pulse(time, LEAD, 0.40 * pace, 0.14 * pace, 0.46 * pace)
    leg = actor.body.leg
    _add(motion, PLACE, down, [0.0, -0.34 * leg, -0.09 * leg])
    _add(motion, TILT, down, [34, -6 - 10 * across, 0])
    _add(motion, SPINE, down, [34, -12 - 14 * across, 0])
    _add(motion, HEAD, down, [-26, 10, 0])
    _add(motion, ARM["left"], down, [76, 2 - 8 * across, -20, -6, 0])
    _add(motion, ARM["right"], down, [18, 12, 0, 40, 0])
    for side, _ in SIDES:
        motion[:, FOOT[side]][:, 5] += radians(11) * down
    return motion


def idle(actor: Actor, duration: float, rng: np.random.Generator) -> Array:
    """Standing: the weight goes from one leg to the other, the eyes wander, a hand comes up."""
    time, motion = _still(actor, duration)
    half = motion[0, FOOT["left"]][0]
    side = 1.0 if rng.uniform() < 0.5 else -1.0
    lean = side * pulse(time, 0.2, 0.9, 0.32 * duration, 1.0)
    look = -side * pulse(time, 0.35 * duration, 0.6, 0.15 * duration, 0.7)
    _add(motion, PLACE, lean, [0.55 * half, -0.6, 0.0])
    _add(motion, TILT, lean, [0, 3, 2.5])
    _add(motion, SPINE, lean, [0, -2, -4])
    _add(motion, HEAD, look, [0, rng.uniform(18, 38), 0])
    _add(motion, SPINE, look, [0, 5, 0])
    name = SIDES[int(rng.integers(2))][0]
    hand = pulse(time, 0.3 * duration, 0.7, 0.12 * duration, 0.8)
    _add(motion, ARM[name], hand, [12, 4, 12, rng.uniform(35, 80), 0])
    return motion
