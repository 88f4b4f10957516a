# SPDX-License-Identifier: GPL-3.0-or-later
"""Body sizes and the skeleton built from them (T-pose at rest, lengths in cm)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .curves import Array

__all__ = ["Body"]

_LEG = ("HipJoint", "UpLeg", "Leg", "Foot")
_ARM = ("Shoulder", "Arm", "ForeArm", "Hand")
_SPINE = ("LowerBack", "Spine", "Spine1", "Neck", "Neck1", "Head")


def _names() -> tuple[tuple[str, ...], tuple[int, ...]]:
    """Joint names in file order, and the index of each joint's parent (-1 for the root)."""
    names, parents = ["Hips"], [-1]

    def chain(members: list[str], root: str) -> None:
        for name in members:
            parents.append(names.index(root))
            names.append(name)
            root = name

    chain(["LHipJoint", *(f"Left{part}" for part in _LEG[1:])], "Hips")
    chain(["RHipJoint", *(f"Right{part}" for part in _LEG[1:])], "Hips")
    chain(list(_SPINE), "Hips")
    chain([f"Left{part}" for part in _ARM], "Spine1")
    chain([f"Right{part}" for part in _ARM], "Spine1")
    return tuple(names), tuple(parents)


JOINTS, PARENTS = _names()
INDEX = {name: index for index, name in enumerate(JOINTS)}


@dataclass(frozen=True)
class Body:
    """Segment lengths (cm) of one person; the defaults of :meth:`of` are average proportions."""

    height: float
    thigh: float
    shank: float
    ankle: float
    """Height of the ankle joint above the sole."""
    toe: float
    """From below the ankle to the tip of the shoe, ahead."""
    heel: float
    """From below the ankle to the end of the heel, behind."""
    hip: Array
    """Left hip joint from the root, in the pelvis frame."""
    trunk: float
    """Each of the three spine bones."""
    neck: float
    """Each of the two neck bones."""
    head: float
    clavicle: Array
    """Left shoulder joint from the top of the thorax, in the thorax frame."""
    upper_arm: float
    forearm: float
    hand: float

    @classmethod
    def of(cls, height: float, legs: float = 1.0, arms: float = 1.0, breadth: float = 1.0) -> Body:
        """A body of ``height`` cm; the other arguments scale proportions about the average."""
        h = height
        return cls(
            height=h,
            thigh=0.244 * h * legs,
            shank=0.240 * h * legs,
            ankle=0.042 * h,
            toe=0.105 * h,
            heel=0.040 * h,
            hip=np.array([0.052 * h * breadth, -0.050 * h, 0.008 * h]),
            trunk=0.078 * h * (2.0 - legs),
            neck=0.032 * h,
            head=0.110 * h,
            clavicle=np.array([0.104 * h * breadth, 0.006 * h, -0.010 * h]),
            upper_arm=0.172 * h * arms,
            forearm=0.152 * h * arms,
            hand=0.095 * h * arms,
        )

    @property
    def leg(self) -> float:
        """Hip to ankle along a straight leg."""
        return self.thigh + self.shank

    def offsets(self) -> Array:
        """Offset of every joint (joints, 3) from its parent at rest."""
        zero = np.zeros(3)
        thorax = np.array([0.0, self.trunk, 0.0])
        result = dict.fromkeys(("Spine", "Spine1", "Neck"), thorax)
        result |= dict.fromkeys(("Neck1", "Head"), np.array([0.0, self.neck, 0.006 * self.height]))
        result |= dict.fromkeys(("Hips", "LHipJoint", "RHipJoint", "LowerBack"), zero)
        for side, sign in (("Left", 1.0), ("Right", -1.0)):
            flip = np.array([sign, 1.0, 1.0])
            result[f"{side}UpLeg"] = self.hip * flip
            result[f"{side}Leg"] = np.array([0.0, -self.thigh, 0.0])
            result[f"{side}Foot"] = np.array([0.0, -self.shank, 0.0])
            result[f"{side}Shoulder"] = thorax
            result[f"{side}Arm"] = self.clavicle * flip
            result[f"{side}ForeArm"] = np.array([sign * self.upper_arm, 0.0, 0.0])
            result[f"{side}Hand"] = np.array([sign * self.forearm, 0.0, 0.0])
        return np.array([result[name] for name in JOINTS])

    def ends(self) -> dict[str, Array]:
        """Tips of the outermost bones, each in the frame of the joint named."""
        foot = np.array([0.0, -self.ankle, self.toe])
        return {
            "LeftFoot": foot,
            "RightFoot": foot,
            "Head": np.array([0.0, self.head, 0.0]),
            "LeftHand": np.array([self.hand, 0.0, 0.0]),
            "RightHand": np.array([-self.hand, 0.0, 0.0]),
        }
