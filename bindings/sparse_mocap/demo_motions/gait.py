# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything that steps: walking and jogging, straight or curved, and turning in place.

One engine makes them all.  A smooth course of the body (speed and turning rate that rise from
standing and fall back to it) is laid first; each foot then lands where the body will be in the
middle of that foot's next stay on the floor.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf, pi, radians

import numpy as np

from .body import Body
from .controls import (
    ARM,
    FACING,
    FOOT,
    HEAD,
    PLACE,
    SIDES,
    SPINE,
    TILT,
    half_stance,
    neutral,
    set_back,
)
from .curves import Array, cruise, pulse, ramp, running_integral, timeline
from .feet import Step, foot_curve
from .style import Actor

__all__ = ["Course", "Gait", "jog", "perform", "turn_in_place", "walk"]

LEAD = 0.45
"""Seconds of standing before the first foot leaves the floor."""


@dataclass(frozen=True)
class Gait:
    """What distinguishes one gait from another; the left foot starts."""

    steps: int
    speed: float
    """Speed at full swing, cm/s."""
    step_time: float
    """Seconds from one foot leaving the floor to the other."""
    turn: float = 0.0
    """Change of heading over the whole course, to the left."""
    swing: float = 0.90
    """Time in the air as a share of the step time; beyond 1 both feet fly for a while."""
    toe_off: float = radians(48)
    """Pitch of the foot on leaving the floor, at full speed."""
    landing: float = radians(-17)
    """Pitch on touching it: negative lands on the heel."""
    settle: float = 0.11
    """Seconds from touching the floor to the flat foot."""
    clearance: float = 4.0
    """Lift of the ankle in the air beyond what the rolling foot gives, cm."""
    narrow: float = 0.65
    """Distance between the tracks as a share of the standing distance."""
    lag: float = 0.036
    """Seconds the feet trail the body: larger lands them closer under it."""
    crouch: float = 0.0
    """Lowering of the pelvis in cm."""
    bounce: float = 0.0
    """Rise and fall of a running pelvis, half the range, cm."""
    sway: float = 2.2
    """Shift of the pelvis over the standing foot, cm."""
    twist: float = radians(5)
    """Turn of the pelvis with the leading leg; the thorax turns back."""
    drop: float = radians(3)
    """Sinking of the pelvis on the side of the swinging leg."""
    lean: float = radians(2)
    """Forward bend of the spine at full speed."""
    arm_swing: float = radians(22)
    arm_back: float = 0.0
    """How far behind its place at rest an arm swings on average."""
    elbow: float = 0.0
    """Elbow flexion beyond that at rest."""
    elbow_swing: float = radians(9)
    ease: float = 1.6
    """Steps it takes to get to full speed."""


@dataclass(frozen=True)
class Course:
    """Where the body goes: per frame x and z (cm), heading, and activity between 0 and 1."""

    time: Array
    place: Array
    heading: Array
    activity: Array

    def at(self, moment: float) -> tuple[Array, float, float]:
        """Place, heading and activity at any time; the end of the course for infinity."""
        pick = [
            np.interp(moment, self.time, column)
            for column in (*self.place.T, self.heading, self.activity)
        ]
        return np.array(pick[:2]), float(pick[2]), float(pick[3])


def walk(body: Body, tempo: float, speed: float = 1.0, steps: int = 7, turn: float = 0.0) -> Gait:
    """A walk; ``speed`` 1 is comfortable, about 1.15 m/s for an average body."""
    return Gait(
        steps=steps,
        speed=1.42 * body.leg * speed,
        step_time=0.57 / (tempo * speed**0.5) ** 0.7,
        turn=turn,
        toe_off=radians(44) * min(1.15, 0.4 + 0.6 * speed),
        landing=radians(-17) * speed,
    )


def jog(body: Body, tempo: float, speed: float = 1.0, steps: int = 9, turn: float = 0.0) -> Gait:
    """A jog with short flights; ``speed`` 1 is about 2.2 m/s for an average body."""
    return Gait(
        steps=steps,
        speed=2.7 * body.leg * speed,
        step_time=0.37 / tempo**0.6,
        turn=turn,
        swing=1.40,
        toe_off=radians(46),
        landing=radians(-3),
        settle=0.07,
        clearance=14.0,
        narrow=0.45,
        lag=0.068,
        crouch=0.068 * body.leg,
        bounce=3.0,
        sway=0.8,
        twist=radians(7),
        lean=radians(7),
        arm_swing=radians(30),
        arm_back=radians(12),
        elbow=radians(70),
        elbow_swing=radians(12),
        ease=3.0,
    )


def turn_in_place(tempo: float, turn: float, steps: int) -> Gait:
    """Turning on the spot to the left by ``turn``, with small flat steps."""
    return Gait(
        steps=steps,
        speed=0.0,
        step_time=0.52 / tempo,
        turn=turn,
        toe_off=radians(22),
        landing=radians(5),
        clearance=4.5,
        narrow=1.0,
        twist=0.0,
        sway=2.6,
        arm_swing=radians(5),
        ease=1.0,
    )


def perform(actor: Actor, gait: Gait) -> Array:
    """Control curves of a gait that starts and ends standing at ease."""
    gait = replace(
        gait,
        arm_swing=gait.arm_swing * actor.style.arm_swing,
        twist=gait.twist * actor.style.energy,
        sway=gait.sway * actor.style.stance,
        bounce=gait.bounce * actor.style.energy,
    )
    course = _course(gait)
    motion = np.tile(neutral(actor), (len(course.time), 1))
    _add_trunk(motion, actor, gait, course)
    _add_arms(motion, gait, course)
    _add_feet(motion, actor, gait, course)
    return motion


def _course(gait: Gait) -> Course:
    end = LEAD + (gait.steps - 1) * gait.step_time + min(gait.swing, 0.9) * gait.step_time
    time = timeline(end + 0.55)
    start, stop, ease = LEAD - 0.28, end + 0.16, gait.ease * gait.step_time + 0.3
    activity = pulse(time, start, ease, stop - start - 2.0 * ease, ease)
    heading = gait.turn * cruise(time, start, stop, ease)
    speed = gait.speed * activity[:, None]
    place = running_integral(speed * np.stack([np.sin(heading), np.cos(heading)], axis=1))
    return Course(time, place, heading, activity)


def _phase(gait: Gait, time: Array) -> Array:
    """Phase that grows by pi each step and is zero in the middle of the first (left) swing."""
    return pi * ((time - LEAD) / gait.step_time - 0.5 * gait.swing)


def _rhythm(gait: Gait, course: Course) -> Array:
    """How far the stepping itself has set in, 0 to 1: earlier than the speed."""
    end = course.time[-1] - 0.55
    return ramp(course.time, LEAD - 0.35, LEAD + 0.2) - ramp(course.time, end - 0.3, end + 0.4)


def _add_trunk(motion: Array, actor: Actor, gait: Gait, course: Course) -> None:
    """Carry the pelvis along the course, bobbing and swaying; the thorax turns against it."""
    phase, rhythm, pace = _phase(gait, course.time), _rhythm(gait, course), course.activity
    across = -gait.sway * np.cos(phase) * rhythm
    motion[:, PLACE.start] += course.place[:, 0] + across * np.cos(course.heading)
    motion[:, PLACE.start + 2] += course.place[:, 1] - across * np.sin(course.heading)
    reach = max(0.0, 0.40 * gait.speed * gait.step_time - 3.0)
    dip = actor.body.leg - np.sqrt(actor.body.leg**2 - reach**2) if not gait.bounce else 0.0
    bob = 0.5 * dip * (1.0 - np.cos(2.0 * phase)) + gait.bounce * np.cos(2.0 * phase)
    motion[:, PLACE.start + 1] -= gait.crouch * rhythm + bob * pace
    motion[:, FACING] += course.heading
    turning = np.gradient(course.heading, course.time)
    inward = 0.5 * gait.speed * pace * turning / 981.0
    yaw, drop = -gait.twist * np.sin(phase), -gait.drop * np.cos(phase)
    motion[:, TILT] += np.stack(
        [0.5 * gait.lean * pace, yaw * pace, drop * rhythm - inward], axis=1
    )
    counter = np.stack([gait.lean * pace, -2.1 * yaw * pace, -1.2 * drop * rhythm - inward], axis=1)
    motion[:, SPINE] += counter
    motion[:, HEAD] -= 0.75 * counter
    motion[:, HEAD.start + 1] += 0.45 * yaw * pace + 0.22 * turning


def _add_arms(motion: Array, gait: Gait, course: Course) -> None:
    """Swing each arm against the leg of its side."""
    phase, pace = _phase(gait, course.time), course.activity
    set_in = pace if gait.speed else _rhythm(gait, course)
    for side, sign in SIDES:
        swing = -sign * np.sin(phase - 0.15)
        arm = motion[:, ARM[side]]
        arm[:, 0] += (gait.arm_swing * swing - gait.arm_back) * set_in
        arm[:, 1] += (radians(2) + 0.05 * gait.elbow) * set_in
        arm[:, 3] += (gait.elbow + gait.elbow_swing * (0.6 + swing)) * set_in


def _add_feet(motion: Array, actor: Actor, gait: Gait, course: Course) -> None:
    """Step alternately, each foot landing under the body's place at that foot's mid-stance."""
    lifts = [LEAD + k * gait.step_time for k in range(gait.steps)]
    strikes = [lift + _air(gait, course, lift) for lift in lifts]
    for first, (side, sign) in enumerate(SIDES):
        steps = []
        for k in range(first, gait.steps, 2):
            landed = strikes[k - 2] if k >= 2 else -inf
            leaves = lifts[k + 2] if k + 2 < gait.steps else inf
            times = (landed, lifts[k], strikes[k], leaves)
            steps.append(_step(actor, gait, course, sign, times))
        rest = motion[0, FOOT[side]]
        curve = foot_curve(course.time, actor.body, (rest[0], rest[2]), rest[3], steps)
        motion[:, FOOT[side]][:, :5] = curve


def _air(gait: Gait, course: Course, lift: float) -> float:
    """Seconds in the air: full flights only at full speed."""
    share = course.at(lift + 0.5 * gait.step_time)[2]
    calm = min(gait.swing, 0.9)
    return (calm + (gait.swing - calm) * share) * gait.step_time


def _step(
    actor: Actor, gait: Gait, course: Course, sign: float, times: tuple[float, float, float, float]
) -> Step:
    """The step of one foot, given when (s) it landed before, lifts, lands and lifts again."""
    landed, lift, strike, leaves = times
    middle = 0.5 * (strike + leaves)
    place, heading, pace = course.at(middle)
    ahead = np.array([np.sin(heading), np.cos(heading)])
    left = np.array([ahead[1], -ahead[0]])
    width = half_stance(actor) * (1.0 + (gait.narrow - 1.0) * pace)
    lag = set_back(actor) + gait.lag * gait.speed * pace
    target = place - lag * ahead + sign * width * left
    leaving, landing = course.at(lift)[2], course.at(strike)[2]
    return Step(
        lift=lift,
        strike=strike,
        target=(float(target[0]), float(target[1])),
        heading=heading + sign * actor.style.toe_out,
        push=min(0.29, 0.46 * (lift - landed)),
        settle=gait.settle,
        toe_off=gait.toe_off * max(leaving, 0.35),
        landing=gait.landing * max(landing, 0.15),
        clearance=gait.clearance * (0.4 + 0.6 * max(leaving, landing)),
    )
