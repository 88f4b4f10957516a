# SPDX-License-Identifier: GPL-3.0-or-later
"""The clip list of a window manager: one empty item a clip, filled once for an opened database."""

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
    ("length", "Length", "The shortest first"),
    ("actor", "Actor", "By actor, then by name"),
)

_listed: list[ref[Database]] = []  # the database whose clips the items stand for


class SPARSEMOCAP_PG_clip(PropertyGroup):
    """A clip: what is known of it is in the opened database, at the same index."""


class SPARSEMOCAP_PG_clip_list(PropertyGroup):
    """The list as the animator has set it; it is no part of the file."""

    items: CollectionProperty(type=SPARSEMOCAP_PG_clip)
    index: IntProperty(name="Clip", options={"SKIP_SAVE"})
    search: StringProperty(
        name="Search",
        description="Words that are in the clip's name, actor or class",
        options={"TEXTEDIT_UPDATE", "SKIP_SAVE"},
    )
    sort: EnumProperty(name="Sort", description="What the list is sorted by", items=_SORTS)
    shows_copies: BoolProperty(
        name="Copies",
        description="List mirrored, reversed and faster or slower copies as well",
    )


def clip_list(context: Context) -> SPARSEMOCAP_PG_clip_list:
    """The list."""
    return context.window_manager.sparse_mocap_clips


def opened_database(context: Context) -> Database | None:
    """The scene's database if it is opened."""
    path = settings_of(context.scene).database
    return databases.peek(bpy.path.abspath(path)).value if path else None


def is_listed(context: Context, database: Database) -> bool:
    """Whether the items stand for that database's clips."""
    is_same = bool(_listed) and _listed[0]() is database
    return is_same and len(clip_list(context).items) == len(database.clips.rows)


def fill(context: Context) -> None:
    """Let the items stand for the clips of the scene's database, if it is opened."""
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
    """Give the window manager its list."""
    bpy.utils.register_class(SPARSEMOCAP_PG_clip)
    bpy.utils.register_class(SPARSEMOCAP_PG_clip_list)
    WindowManager.sparse_mocap_clips = PointerProperty(type=SPARSEMOCAP_PG_clip_list)


def unregister() -> None:
    """Take the list away."""
    _listed.clear()
    del WindowManager.sparse_mocap_clips
    bpy.utils.unregister_class(SPARSEMOCAP_PG_clip_list)
    bpy.utils.unregister_class(SPARSEMOCAP_PG_clip)
