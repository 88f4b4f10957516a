# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels in the language that Blender is set to."""

from __future__ import annotations

import bpy
import installed
from support import Skipped, addon

NOT_SHOWN = {
    *("directory", "index"),  # what file browsers and buttons fill in
    "The options of a sensor protocol; the tooltip shows them.",  # says those of the protocol
}


def _german() -> str:
    """What Blender calls it. Raises Skipped in a Blender without languages."""
    system = bpy.context.preferences.view.bl_rna.properties["language"]
    names = [item.identifier for item in system.enum_items] or bpy.app.translations.locales
    found = [name for name in names if name in ("de", "de_DE")]
    if not found:
        raise Skipped("this Blender has no languages")
    return found[0]


def test_texts_are_german_where_blender_is():
    view = bpy.context.preferences.view
    before = (view.language, view.use_translate_interface)
    tr = addon("scene.translations").tr
    assert tr("Live Sensors") == "Live Sensors"
    try:
        view.language = _german()
        view.use_translate_interface = True
        assert tr("Live Sensors") == "Sensoren live"
        assert tr("something else") == "something else"
        in_operators = bpy.app.translations.pgettext_iface("Reconstruct", "Operator")
        assert in_operators == "Rekonstruieren"
        installed.unregister()
        assert bpy.app.translations.pgettext_iface("Live Sensors") == "Live Sensors"
    finally:
        view.language, view.use_translate_interface = before


def test_every_operator_and_setting_is_in_the_table():
    table = addon("languages.german").TEXTS
    missing = set()
    for cls in addon("ops.registration").CLASSES:
        kind, name = cls.bl_idname.split(".")
        rna = getattr(getattr(bpy.ops, kind), name).get_rna_type()
        texts = {rna.name, rna.description}
        for key in cls.__annotations__:
            own = rna.properties.get(key)
            hidden = own is None or own.is_hidden or own.type == "COLLECTION"
            texts |= set() if hidden else {own.name, own.description}
        missing |= {text for text in texts if text and text not in table}
    settings = bpy.context.scene.sparse_mocap
    for key in type(settings).__annotations__:
        own = settings.bl_rna.properties[key]
        texts = set() if own.type == "COLLECTION" else {own.name, own.description}
        missing |= {text for text in texts if text and text not in table}
    for panel in addon("ui.registration").CLASSES:
        if issubclass(panel, bpy.types.Panel) and panel.bl_label not in table:
            missing.add(panel.bl_label)
    assert missing <= NOT_SHOWN, missing
