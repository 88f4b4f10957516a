# SPDX-License-Identifier: GPL-3.0-or-later
"""The mapping of the last imported skeleton, as rows that can be edited; no part of the file."""

from __future__ import annotations

import bpy
from bpy.props import CollectionProperty, PointerProperty, StringProperty
from bpy.types import Context, PropertyGroup, WindowManager

from ..session.core import core
from ..session.mapping import Mapped, last_mapped


class SPARSEMOCAP_PG_mapped_joint(PropertyGroup):
    """A standard joint (its name) and the skeleton's joint that carries it."""

    source: StringProperty(
        name="Joint", description="The file's joint; empty: found by its name or its place"
    )


class SPARSEMOCAP_PG_source_joint(PropertyGroup):
    """A joint of the skeleton (its name), to choose from."""


class SPARSEMOCAP_PG_mapping(PropertyGroup):
    """All standard joints, and all of the skeleton's."""

    joints: CollectionProperty(type=SPARSEMOCAP_PG_mapped_joint)
    sources: CollectionProperty(type=SPARSEMOCAP_PG_source_joint)


CLASSES = (SPARSEMOCAP_PG_mapped_joint, SPARSEMOCAP_PG_source_joint, SPARSEMOCAP_PG_mapping)


def mapping_of(context: Context) -> SPARSEMOCAP_PG_mapping:
    """The rows."""
    return context.window_manager.sparse_mocap_mapping


def show_mapping(context: Context, found: Mapped) -> None:
    """Let the rows show a skeleton's mapping; it is the one at hand from now on."""
    last_mapped[:] = [found]
    rows = mapping_of(context)
    rows.sources.clear()
    for name in found.source_joints:
        rows.sources.add().name = name
    show_joints(context, found.joints)


def show_joints(context: Context, joints: dict[str, str]) -> None:
    """Let the rows show these joints."""
    rows = mapping_of(context)
    rows.joints.clear()
    for name in core().standard_joint_names():
        row = rows.joints.add()
        row.name, row.source = name, joints.get(name, "")


def shown_joints(context: Context) -> dict[str, str]:
    """What the rows say."""
    return {row.name: row.source for row in mapping_of(context).joints}


def register() -> None:
    """Give the window manager its rows."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    WindowManager.sparse_mocap_mapping = PointerProperty(type=SPARSEMOCAP_PG_mapping)


def unregister() -> None:
    """Take them away."""
    del WindowManager.sparse_mocap_mapping
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
