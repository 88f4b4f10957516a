# SPDX-License-Identifier: GPL-3.0-or-later
"""What to teach the motion database next; a part of the scene's settings."""

from __future__ import annotations

from bpy.props import BoolProperty, FloatProperty, StringProperty
from bpy.types import PropertyGroup


class SPARSEMOCAP_PG_teaching(PropertyGroup):
    """A motion and the take that was recorded with it."""

    is_open: BoolProperty(
        name="Teach",
        description=(
            "Add a movement of yours together with what your sensors measured during it, so that "
            "later takes of such movements come out better"
        ),
    )
    motion: StringProperty(
        name="Motion",
        description=(
            "The motion file (.bvh, .amc, .npz, .mvnx) of the performance, for example from video"
        ),
    )
    take: StringProperty(
        name="Take", description="The take (.csv) that the sensors recorded during the performance"
    )
    has_clap: BoolProperty(
        name="Align by a clap",
        description=(
            "Motion and take have a clap or jump in common: align them by it. "
            "Off: they are aligned by comparing all readings"
        ),
    )
    clap_from_s: FloatProperty(
        name="From (s)",
        description="When the clap starts, in seconds from the start of the take",
        min=0.0,
    )
    clap_to_s: FloatProperty(
        name="To (s)",
        description="When the clap ends, in seconds from the start of the take",
        min=0.0,
        default=2.0,
    )
