# SPDX-License-Identifier: GPL-3.0-or-later
"""Parametric human motion, to try everything without outside data.

Exercises and gaits are written as smooth *control curves* (pelvis, trunk, arms and ankles over
time), posed by analytic inverse kinematics and stored as BVH text.  Lengths are centimetres,
angles radians, times seconds; the world is right-handed with y up, and a character at rest faces
+z with its left side towards +x.
"""

from .library import generate_library, generate_performance

__all__ = ["generate_library", "generate_performance"]
