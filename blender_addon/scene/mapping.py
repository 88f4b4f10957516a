# SPDX-License-Identifier: GPL-3.0-or-later
"""The mapping of the skeleton looked at last as editable rows; not saved in the .blend file."""

from __future__ import annotations

import bpy
from bpy.props import CollectionProperty, IntProperty, PointerProperty, StringProperty
from bpy.types import Context, PropertyGroup, WindowManager

from ..session.core import core
from ..session.mapping import Mapped, last_mapped


class SPARSEMOCAP_PG_mapped_joint(PropertyGroup):
    """A joint of the standard skeleton (its name) and the bone or file's joint mapped to it."""

    source: StringProperty(
        name="Joint", description="The bone that is mapped. Empty: detected automatically"
    )


class SPARSEMOCAP_PG_source_joint(PropertyGroup):
    """A joint of the file (its name), to choose from."""


class SPARSEMOCAP_PG_mapping(PropertyGroup):
    """All joints of the standard skeleton, and all of the file's."""

    joints: CollectionProperty(type=SPARSEMOCAP_PG_mapped_joint)
    sources: CollectionProperty(type=SPARSEMOCAP_PG_source_joint)
    index: IntProperty(name="Part of the body")


CLASSES = (SPARSEMOCAP_PG_mapped_joint, SPARSEMOCAP_PG_source_joint, SPARSEMOCAP_PG_mapping)


def mapping_of(context: Context) -> SPARSEMOCAP_PG_mapping:
    """The rows."""
    return context.window_manager.sparse_mocap_mapping


def show_mapping(context: Context, found: Mapped) -> None:
    """Show a skeleton's mapping in the rows; it becomes the last mapped one."""
    last_mapped[:] = [found]
    rows = mapping_of(context)
    rows.sources.clear()
    for name in found.source_joints:
        rows.sources.add().name = name
    show_joints(context, found.joints)


def show_joints(context: Context, joints: dict[str, str]) -> None:
    """Show these joints in the rows."""
    rows = mapping_of(context)
    rows.joints.clear()
    for name in core().standard_joint_names():
        row = rows.joints.add()
        row.name, row.source = name, joints.get(name, "")


def shown_joints(context: Context) -> dict[str, str]:
    """The joints in the rows."""
    return {row.name: row.source for row in mapping_of(context).joints}


def register() -> None:
    """Register the rows."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    WindowManager.sparse_mocap_mapping = PointerProperty(type=SPARSEMOCAP_PG_mapping)


def unregister() -> None:
    """Unregister the rows."""
    del WindowManager.sparse_mocap_mapping
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
