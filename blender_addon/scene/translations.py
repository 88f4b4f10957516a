# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels in the language that Blender is set to. Needs neither NumPy nor the core."""

from __future__ import annotations

import bpy

from ..languages import german

_ADDON = __package__.rpartition(".")[0]
_CONTEXTS = ("*", "Operator")
_LOCALES = ("de", "de_DE")  # as Blender calls it before and since 4.0, or the other way round


def tr(text: str) -> str:
    """The text in the language of Blender's interface, or as it is."""
    return str(bpy.app.translations.pgettext_iface(text))


def register() -> None:
    """Register the translations."""
    table = {(context, text): said for text, said in german.TEXTS.items() for context in _CONTEXTS}
    bpy.app.translations.register(_ADDON, dict.fromkeys(_LOCALES, table))


def unregister() -> None:
    """Unregister them."""
    bpy.app.translations.unregister(_ADDON)
