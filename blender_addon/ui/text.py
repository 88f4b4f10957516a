# SPDX-License-Identifier: GPL-3.0-or-later
"""Text in panels: Blender's labels do not wrap by themselves."""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from typing import Any

import blf
from bpy.types import Context, UILayout

from ..scene.translations import tr, tr_line

_FONT = 0  # the interface's
_MARGIN_PX = 76.0  # of panel and box, and the scroll bar
PANEL_MARGIN_PX, SUBPANEL_MARGIN_PX, BOX_MARGIN_PX = 40.0, 62.0, 62.0
_NAME_SHARE = 0.4  # of a row, for a setting's name beside its value
_NAME_MARGIN_PX = 12.0
_LONGEST_NAME_SHARE = 0.6
_NAME_GAP_PX = 8.0
_ICON_PX = 24.0
_USUAL_WIDTH_PX, _USUAL_POINTS = 260.0, 11
_NARROWEST_PX = 80.0
_WIDE_PX = 320.0


def is_wide(context: Context) -> bool:
    """Whether the sidebar has room for more than what is needed."""
    return context.region is not None and _width_px(context) >= _WIDE_PX


def has_room_beside(context: Context, *names: str, margin_px: float = PANEL_MARGIN_PX) -> bool:
    """Whether names of settings fit beside their values."""
    room = _NAME_SHARE * (_width_px(context) - margin_px) - _NAME_MARGIN_PX
    return max(map(_length_of(context), map(tr, names))) <= room


def setting(
    layout: UILayout,
    context: Context,
    owner: Any,
    name: str,
    *,
    icon: str = "NONE",
    margin_px: float = PANEL_MARGIN_PX,
) -> None:
    """A setting with its name beside it, or above it where there is no room."""
    label = owner.bl_rna.properties[name].name
    if has_room_beside(context, label, margin_px=margin_px):
        layout.prop(owner, name, icon=icon)
        return
    column = layout.column(align=True)
    column.label(text=label)
    column.prop(owner, name, text="", icon=icon)


def _width_px(context: Context) -> float:
    """Of the sidebar, in pixels of an interface that is not scaled."""
    scale = context.preferences.system.ui_scale or 1.0  # 0 in the background
    return context.region.width / scale if context.region is not None else _USUAL_WIDTH_PX


def _length_of(context: Context) -> Callable[[str], float]:
    """Measures a text in such pixels."""
    styles = context.preferences.ui_styles
    blf.size(_FONT, styles[0].widget.points if len(styles) else _USUAL_POINTS)
    return lambda line: float(blf.dimensions(_FONT, line)[0])


def paragraph(layout: UILayout, context: Context, text: str, icon: str = "NONE") -> None:
    """Show the text, wrapped to the width of the sidebar."""
    room = _width_px(context) - _MARGIN_PX - (0.0 if icon == "NONE" else _ICON_PX)
    lines = wrapped(tr_line(text), _length_of(context), max(room, _NARROWEST_PX))
    column = layout.column(align=True)
    column.scale_y = 0.8
    for index, line in enumerate(lines):
        if icon == "NONE":
            column.label(text=line, translate=False)
        else:
            column.label(text=line, icon=icon if index == 0 else "BLANK1", translate=False)


def wrapped(text: str, width_of: Callable[[str], float], room: float) -> list[str]:
    """The text in lines that are no wider than the room; a word that is wider, a path, is cut."""
    lines: list[str] = []
    for word in (piece for whole in text.split() for piece in _pieces(whole, width_of, room)):
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and width_of(longer) <= room:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines or [""]


def _pieces(word: str, width_of: Callable[[str], float], room: float) -> list[str]:
    """The word in pieces that fit, cut behind a slash, dash or underscore where there is one."""
    pieces: list[str] = []
    while len(word) > 1 and width_of(word) > room:
        most = next((n for n in range(len(word) - 1, 1, -1) if width_of(word[:n]) <= room), 1)
        cuts = [n for n in range(2, most + 1) if word[n - 1] in "/\\-_"]
        end = cuts[-1] if cuts else most
        pieces.append(word[:end])
        word = word[end:]
    return [*pieces, word]


def error(layout: UILayout, context: Context, text: str) -> None:
    """Show an error."""
    box = layout.box()
    box.alert = True
    paragraph(box, context, text, icon="ERROR")


def facts(layout: UILayout, context: Context, rows: list[tuple[str, str]]) -> None:
    """Show names and values in two columns; values are shown as they are."""
    box = layout.box().column(align=True)
    box.scale_y = 0.85
    longest = max(map(_length_of(context), (tr(name) for name, _ in rows)))
    share = (longest + _NAME_GAP_PX) / max(_width_px(context) - _MARGIN_PX, _NARROWEST_PX)
    for name, value in rows:
        split = box.split(factor=min(max(share, 0.42), _LONGEST_NAME_SHARE))
        split.label(text=tr(name), translate=False)
        split.label(text=value, translate=False)


def shortened(text: str, num_characters: int = 120) -> str:
    """The text, shortened to fit into a panel."""
    return textwrap.shorten(text, num_characters, placeholder=" ...")


def size(num_bytes: int) -> str:
    """A file size in MB or GB."""
    return f"{num_bytes / 1e6:.1f} MB" if num_bytes < 1e9 else f"{num_bytes / 1e9:.2f} GB"


def duration(seconds: float) -> str:
    """A duration in s or min."""
    return f"{seconds:.1f} s" if seconds < 120.0 else f"{seconds / 60.0:.1f} min"
