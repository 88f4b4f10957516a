# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene's takes as a list. The files stay where they are, whatever is undone or removed."""

from __future__ import annotations

import os
from pathlib import Path

import bpy
from bpy.types import PropertyGroup, Scene

from ..session.take import SUFFIX, LoadedTake, takes
from .settings import SPARSEMOCAP_PG_take, settings_of


def add_take(scene: Scene, path: str, take: LoadedTake | None = None, match: str = "") -> None:
    """Add a take to the list, or update it there, and choose it."""
    settings = settings_of(scene)
    index = _index_of(scene, path)
    if index < 0:
        item = settings.takes.add()
        item.path, index = relative(path), len(settings.takes) - 1
    item = settings.takes[index]
    item.name = Path(path).stem
    if take is not None:
        item.duration_s, item.num_sensors = take.duration_s, len(take.sensors)
    if match:
        item.match = match
    settings.take_index = index
    settings.take = item.path


def take_of(scene: Scene) -> PropertyGroup | None:
    """The chosen take's row; None without one."""
    settings = settings_of(scene)
    index = _index_of(scene, settings.take) if settings.take else -1
    return settings.takes[index] if index >= 0 else None


def remove_take(scene: Scene) -> str:
    """Remove the chosen take from the list and return its name; its file stays."""
    settings = settings_of(scene)
    name = settings.takes[settings.take_index].name
    settings.takes.remove(settings.take_index)
    settings.take_index = min(settings.take_index, len(settings.takes) - 1)
    settings.take = settings.takes[settings.take_index].path if settings.takes else ""
    return str(name)


def find_takes(scene: Scene, folder: Path) -> int:
    """Add the takes in the folder that are not listed, and return how many.

    Listed takes whose file is gone are connected with a file of that name there.
    """
    files = sorted(folder.glob(f"*{SUFFIX}")) if folder.is_dir() else []
    by_name = {file.name: file for file in files}
    for item in settings_of(scene).takes:
        file = by_name.get(os.path.basename(item.path.replace("\\", "/")))
        if is_missing(item) and file is not None:
            item.path = relative(str(file))
    added = 0
    for file in files:
        if _index_of(scene, str(file)) >= 0:
            continue
        try:
            take = takes.get(str(file))
        except Exception:
            continue
        add_take(scene, str(file), take)
        added += 1
    return added


def is_missing(item: SPARSEMOCAP_PG_take) -> bool:
    """Whether the take's file is not there."""
    return not os.path.exists(bpy.path.abspath(item.path))


def relative(path: str) -> str:
    """The path relative to the .blend file, if that is saved and on the same drive."""
    absolute = bpy.path.abspath(path)
    if not bpy.data.filepath:
        return absolute
    try:
        return str(bpy.path.relpath(absolute))
    except ValueError:  # another drive
        return absolute


def _index_of(scene: Scene, path: str) -> int:
    absolute = os.path.abspath(bpy.path.abspath(path))
    for index, item in enumerate(settings_of(scene).takes):
        if os.path.abspath(bpy.path.abspath(item.path)) == absolute:
            return index
    return -1
