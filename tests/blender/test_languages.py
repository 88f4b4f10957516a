# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels in the language that Blender is set to."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress

import bpy
import installed
import rigs
from support import Skipped, addon, choose_files, error_of, raised, settings

NOT_SHOWN = {
    # What file browsers and buttons fill in, and groups:
    *("directory", "index", "training", "teaching"),
    "The options of a sensor protocol; the tooltip shows them.",  # says those of the protocol
}


@contextmanager
def german() -> Iterator[None]:
    """Blender in German. Raises Skipped in a Blender without languages."""
    view = bpy.context.preferences.view
    before = (view.language, view.use_translate_interface)
    for name in ("de_DE", "de"):
        with suppress(TypeError):  # Blender calls it otherwise
            view.language = name
    if not view.language.startswith("de"):
        raise Skipped("this Blender has no languages")
    try:
        view.use_translate_interface = True
        yield
    finally:
        view.language, view.use_translate_interface = before


def test_texts_are_german_where_blender_is():
    tr = addon("scene.translations").tr
    assert tr("Live Sensors") == "Live Sensors"
    with german():
        assert tr("Live Sensors") == "Sensoren live"
        assert tr("something else") == "something else"
        assert tr("Reversed") == "Rückwärts"  # not as Blender calls what is inverted
        connect = bpy.ops.sparse_mocap.connect_sensors.get_rna_type()
        shown = bpy.app.translations.pgettext_iface(connect.name, connect.translation_context)
        assert shown == "Verbinden"
        in_operators = bpy.app.translations.pgettext_iface("Reconstruct", "Operator")
        assert in_operators == "Rekonstruieren"
        installed.unregister()
        assert bpy.app.translations.pgettext_iface("Live Sensors") == "Live Sensors"


def test_errors_are_german_where_blender_is():
    armature = rigs.named_rig("mixamo")
    armature.name, armature.scale = "Render", (1.0, 1.0, -1.0)  # a word that Blender translates
    settings().target = armature
    choose_files()
    mirrored = '"Render" has a negative scale: apply the scale (Ctrl A)'
    assert error_of(bpy.ops.sparse_mocap.reconstruct) == mirrored
    with german():
        said = raised(RuntimeError, bpy.ops.sparse_mocap.reconstruct)
        assert said.endswith(": „Render“ ist gespiegelt skaliert: die Skalierung anwenden (Strg A)")
        line = addon("scene.translations").tr_line
        running = line("Loading Take is still running: wait or cancel it first")
        assert running.endswith("läuft noch: warten oder zuerst abbrechen")
        assert line("Choose a motion database first") == "Zuerst eine Bewegungsdatenbank wählen"
        assert line("walk.bvh:3:1: expected 3 numbers") == "walk.bvh:3:1: expected 3 numbers"
        assert line("Left Hand moved by 9 cm during bow; hold the pose still") == (
            "Linke Hand hat sich bei bow um 9 cm bewegt; die Pose still halten"
        )
        assert line("/a: b/c.smdb: no such file or folder; check the path") == (
            "/a: b/c.smdb: diese Datei oder diesen Ordner gibt es nicht; den Pfad prüfen"
        )


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
