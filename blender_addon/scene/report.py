# SPDX-License-Identifier: GPL-3.0-or-later
"""What is open and chosen, for a bug report."""

from __future__ import annotations

import bpy
from bpy.types import Context

from ..session import live
from ..session.database import databases
from ..session.reconstruct import kept
from ..session.take import takes
from .performance import facts_of, performed_action
from .settings import options_text, settings_of


def facts(context: Context) -> tuple[str, ...]:
    """One line each; without names of files."""
    settings, render = settings_of(context.scene), context.scene.render
    return (
        f"Scene: {render.fps / render.fps_base:g} frames/s, mode {context.mode}",
        f"Database: {_database(settings.database)}",
        f"Take: {_take(settings.take)}",
        f"Method: {settings.method}, {settings.preset}, {options_text(settings) or 'no options'}, "
        f"{'best' if settings.offline else 'live'} quality",
        f"Character: {_character(context)}",
        f"Sensors: {_sensors()}",
    )


def _database(path: str) -> str:
    if not path:
        return "none"
    entry = databases.peek(bpy.path.abspath(path))
    database = entry.value
    if database is None:
        return entry.error or "being opened"
    return (
        f"{database.num_clips} clips, {database.minutes:.1f} min at {database.rate_hz:g} Hz, "
        f"{database.size_bytes} bytes"
    )


def _take(path: str) -> str:
    if not path:
        return "none"
    entry = takes.peek(bpy.path.abspath(path))
    take = entry.value
    if take is None:
        return entry.error or "being opened"
    return f"{take.duration_s:.1f} s at {take.rate_hz:.4g} Hz, {', '.join(take.sensors)}"


def _character(context: Context) -> str:
    settings = settings_of(context.scene)
    active = context.view_layer.objects.active
    action = performed_action(active)
    played = facts_of(action) if action is not None else None
    kind = "none chosen" if settings.target is None else f"{len(settings.target.data.bones)} bones"
    if played is None:
        return kind
    is_kept = "kept" if kept(played.take) is not None else "of an earlier session"
    return f"{kind}; plays {played.duration_s:.1f} s, match {played.match}, result {is_kept}"


def _sensors() -> str:
    session = live.current()
    if session is None:
        return "not connected"
    state = session.state
    worn = [f"{one['site'] or 'nowhere'} {one['state']}" for one in state.sensors]
    what = "connected" if state.is_connected else "ended"
    return ", ".join([what, *worn, *filter(None, (state.error, state.warning, state.no_readings))])
