# SPDX-License-Identifier: GPL-3.0-or-later
"""The clip list of a window manager: one empty item for each clip of the open database."""

from __future__ import annotations

from weakref import ref

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    IntProperty,
    PointerProperty,
    StringProperty,
)
from bpy.types import Context, PropertyGroup, WindowManager

from ..session.database import Database, databases
from .settings import settings_of

_SORTS = (
    ("name", "Name", "By name"),
    ("length", "Length", "Shortest first"),
    ("actor", "Actor", "By actor, then by name"),
)

_listed: list[ref[Database]] = []  # the database that the items belong to


class SPARSEMOCAP_PG_clip(PropertyGroup):
    """An empty item; its data is in the open database, at the same index."""


class SPARSEMOCAP_PG_clip_list(PropertyGroup):
    """The state of the list; not saved in the .blend file."""

    items: CollectionProperty(type=SPARSEMOCAP_PG_clip)
    index: IntProperty(name="Clip", options={"SKIP_SAVE"})
    search: StringProperty(
        name="Search",
        description="Find clips by words in their name, actor or class",
        options={"TEXTEDIT_UPDATE", "SKIP_SAVE"},
    )
    sort: EnumProperty(name="Sort", description="Sort the list by", items=_SORTS)
    shows_copies: BoolProperty(
        name="Copies",
        description="Also list the mirrored, reversed, faster and slower copies",
    )


def clip_list(context: Context) -> SPARSEMOCAP_PG_clip_list:
    """The list."""
    return context.window_manager.sparse_mocap_clips


def opened_database(context: Context) -> Database | None:
    """The scene's database if it is open."""
    path = settings_of(context.scene).database
    return databases.peek(bpy.path.abspath(path)).value if path else None


def is_listed(context: Context, database: Database) -> bool:
    """Whether the list has this database's clips."""
    is_same = bool(_listed) and _listed[0]() is database
    return is_same and len(clip_list(context).items) == len(database.clips.rows)


def fill(context: Context) -> None:
    """Fill the list with the clips of the scene's database, if it is open."""
    database = opened_database(context)
    if database is None or is_listed(context, database):
        return
    shown = clip_list(context)
    count = len(database.clips.rows)
    while len(shown.items) > count:
        shown.items.remove(len(shown.items) - 1)
    for _ in range(len(shown.items), count):
        shown.items.add()
    shown.index = min(shown.index, max(count - 1, 0))
    _listed[:] = [ref(database)]


def register() -> None:
    """Register the list."""
    bpy.utils.register_class(SPARSEMOCAP_PG_clip)
    bpy.utils.register_class(SPARSEMOCAP_PG_clip_list)
    WindowManager.sparse_mocap_clips = PointerProperty(type=SPARSEMOCAP_PG_clip_list)


def unregister() -> None:
    """Unregister the list."""
    _listed.clear()
    del WindowManager.sparse_mocap_clips
    bpy.utils.unregister_class(SPARSEMOCAP_PG_clip_list)
    bpy.utils.unregister_class(SPARSEMOCAP_PG_clip)
