# SPDX-License-Identifier: GPL-3.0-or-later
"""What a model is trained from, and which model is used; a part of the scene's settings."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty, StringProperty
from bpy.types import Context, PropertyGroup

from ..session.training import classes_in, with_name


def _classes(training: PropertyGroup, context: Context, text: str) -> list[str]:
    """The classes of the scene's database, after what is written already."""
    database = bpy.path.abspath(context.scene.sparse_mocap.database)
    before, _, last = text.rpartition(",")
    known = [name for name in classes_in(database) if last.strip().lower() in name.lower()]
    return [with_name(before, name) for name in known]


class SPARSEMOCAP_PG_training(PropertyGroup):
    """The model in use and what to train the next one from."""

    model: StringProperty(
        name="Model", description="The trained model (.smmodel) to reconstruct with"
    )
    classes: StringProperty(
        name="Classes",
        description=(
            "Classes of the motion database to learn from, separated by commas. Each becomes a "
            "type of motion, and takes are recognised as one of them. Empty: all"
        ),
        search=_classes,
        search_options={"SUGGESTION"},
    )
    clips: StringProperty(
        name="Clips",
        description=(
            "Names of clips to learn from, separated by commas, for example: walk_01, run*. "
            "One or two clips of each type are enough. Empty: all of the classes"
        ),
    )
    phases: StringProperty(
        name="Phases",
        description=(
            "A file (.csv) that says where the phases of the clips begin, as Write Phases makes "
            "it. Empty: found by the feet that leave the floor"
        ),
        subtype="FILE_PATH",
    )
    output: StringProperty(
        name="Save as",
        description="The model file to write. Empty: next to the motion database",
    )
    phone_site: EnumProperty(
        name="Worn at",
        description="Where the phone is worn",
        items=(
            ("left_ankle", "Left Ankle", "At the left ankle"),
            ("right_ankle", "Right Ankle", "At the right ankle"),
            ("left_wrist", "Left Wrist", "At the left wrist"),
            ("right_wrist", "Right Wrist", "At the right wrist"),
            ("pelvis", "Pelvis", "At the pelvis"),
        ),
    )
