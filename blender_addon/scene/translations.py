# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels in the language that Blender is set to. Needs neither NumPy nor the core."""

from __future__ import annotations

import re
from functools import lru_cache

import bpy

from ..languages import german, german_core, german_reports

_ADDON = __package__.rpartition(".")[0]
CONTEXT = "Sparse Mocap"
"""Where Blender's own translation of a text means something else."""
_CONTEXTS = ("*", "Operator", CONTEXT)
_LOCALES = ("de", "de_DE")  # as Blender calls it before and since 4.0, or the other way round


def tr(text: str) -> str:
    """The text in the language of Blender's interface, or as it is."""
    ours = str(bpy.app.translations.pgettext_iface(text, CONTEXT))
    return ours if ours != text else str(bpy.app.translations.pgettext_iface(text))


def tr_line(line: str) -> str:
    """A line of an operator or a session in the language of Blender's interface, or as it is.

    Such lines are made where nothing knows of Blender, with names and numbers filled in.
    """
    locale = bpy.app.translations.locale
    if locale not in _LOCALES:
        return line
    return _said(line, (locale, bpy.context.preferences.view.use_translate_interface))


@lru_cache(maxsize=512)  # panels ask for the same lines at each redraw
def _said(line: str, _language: tuple[str, bool]) -> str:
    said = tr(line)
    if said != line:
        return said
    for template, pattern in _TEMPLATES:
        found = pattern.fullmatch(line)
        if found is not None and (said := tr(template)) != template:
            filled = found.groupdict()
            filled |= {name: tr_line(text) for name, text in filled.items() if name in _OUR_WORDS}
            return said.format(**filled)
    return line


_OUR_WORDS = {"agreement", "kind", "job", "match", "other", "reason", "site"}
"""What is filled in that is ours to translate, unlike the names of objects and files."""


def _pattern(template: str) -> re.Pattern[str]:
    """What lines look like that are made from the template."""
    parts = re.split(r"\{(\w+)\}", template)
    parts[::2] = [re.escape(text) for text in parts[::2]]
    parts[1::2] = [f"(?P<{name}>.+?)" for name in parts[1::2]]
    return re.compile("".join(parts))


def _num_literal(template: str) -> int:
    return len(re.sub(r"\{\w+\}", "", template))


_TEMPLATES = [
    (template, _pattern(template))
    for template in sorted(
        (*german_reports.REPORTS, *german_core.CORE), key=_num_literal, reverse=True
    )
    if "{" in template
]


def register() -> None:
    """Register the translations."""
    table = {(context, text): said for text, said in german.TEXTS.items() for context in _CONTEXTS}
    bpy.app.translations.register(_ADDON, dict.fromkeys(_LOCALES, table))
    _said.cache_clear()


def unregister() -> None:
    """Unregister them."""
    bpy.app.translations.unregister(_ADDON)
    _said.cache_clear()
