# SPDX-License-Identifier: GPL-3.0-or-later
"""Text in panels."""

from __future__ import annotations

from types import SimpleNamespace

import bpy
from support import addon


def test_text_is_wrapped_by_its_width_and_keeps_every_word():
    wrapped = addon("ui.text").wrapped
    text = "A simulated performer with four simulated sensors"
    lines = wrapped(text, len, 20)
    assert lines == ["A simulated", "performer with four", "simulated sensors"]
    assert wrapped(text, lambda line: 2 * len(line), 40) == lines
    assert wrapped("", len, 5) == [""]


def test_words_that_do_not_fit_are_cut_where_paths_may_be():
    wrapped = addon("ui.text").wrapped
    path = "Saved: /home/ada/Sparse Mocap/take-2026-11-30.csv"
    lines = wrapped(path, len, 12)
    assert lines == ["Saved:", "/home/ada/", "Sparse", "Mocap/take-", "2026-11-", "30.csv"]
    assert "".join(lines).replace(" ", "") == path.replace(" ", "")
    assert max(map(len, lines)) <= 12
    assert wrapped("unbelievably long", len, 5) == ["unbel", "ievab", "ly", "long"]
    assert wrapped("wide", lambda line: 9 * len(line), 5) == ["w", "i", "d", "e"]


def test_names_stand_beside_values_where_there_is_room():
    has_room = addon("ui.text").has_room_beside
    preferences = bpy.context.preferences
    scale = preferences.system.ui_scale or 1.0

    def in_sidebar(width: float) -> SimpleNamespace:
        region = SimpleNamespace(width=width * scale)
        return SimpleNamespace(region=region, preferences=preferences)

    assert has_room(in_sidebar(400), "Speed (m/s)", "Certainty")
    assert has_room(in_sidebar(120), "To")
    assert not has_room(in_sidebar(120), "To", "Speed (m/s)")
