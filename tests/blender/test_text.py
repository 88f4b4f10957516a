# SPDX-License-Identifier: GPL-3.0-or-later
"""Text in panels."""

from __future__ import annotations

from support import addon


def test_text_is_wrapped_by_its_width_and_keeps_every_word():
    wrapped = addon("ui.text").wrapped
    text = "A simulated performer with four simulated sensors"
    lines = wrapped(text, len, 20)
    assert lines == ["A simulated", "performer with four", "simulated sensors"]
    assert wrapped(text, lambda line: 2 * len(line), 40) == lines
    assert wrapped("unbelievably long", len, 5) == ["unbelievably", "long"]
    assert wrapped("", len, 5) == [""]
