# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel says of a take that does not match well, and how to get to its poor parts."""

from __future__ import annotations

from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import rigs
from rig_baking import bake
from support import addon, choose_files, error_of, reconstruct, settings


def _texts(panel: str) -> str:
    """All labels that a panel draws, and the buttons' names."""
    layout = MagicMock()
    for part in ("row", "column", "box", "split"):
        getattr(layout, part).return_value = layout
    cls = getattr(addon("ui.reconstruct"), panel)
    cls.draw(SimpleNamespace(layout=layout), bpy.context)
    labels = [call.kwargs.get("text", "") for call in layout.label.call_args_list]
    buttons = [call.args[0] for call in layout.operator.call_args_list]
    return " ".join([*labels, *buttons])


def _bake_as(match):
    module = addon("session.reconstruct")
    found, module.match_of = module.match_of, lambda *_: match
    try:
        return bake(rigs.named_rig("mixamo"))
    finally:
        module.match_of = found


def test_poor_parts_are_listed_and_found_with_the_playhead():
    match = addon("session.match").Match(
        "poor", ("poor", "good", "poor", "fair"), True, "Add some clips of it", "left_wrist"
    )
    action = _bake_as(match)
    facts = addon("scene.performance").facts_of(action)
    assert (facts.match, facts.seconds) == ("poor", "poor good poor fair")
    shown = _texts("SPARSEMOCAP_PT_reconstruct")
    for text in ("Poor: 0-1, 2-3 s", "next_poor_part", "Add some clips of it"):
        assert text in shown
    assert "Check the sensor at Left Wrist" in " ".join(shown.split())
    scene = bpy.context.scene
    scene.frame_set(1)
    for wanted in (49, 1, 49):  # 24 frames/s; after the last one comes the first
        assert bpy.ops.sparse_mocap.next_poor_part() == {"FINISHED"}
        assert scene.frame_current == wanted


def test_a_good_take_needs_no_advice():
    action = bake(rigs.named_rig("mixamo"))
    facts = addon("scene.performance").facts_of(action)
    assert facts.match == "good"
    assert set(facts.seconds.split()) <= {"good", "fair"}
    assert "Poor:" not in _texts("SPARSEMOCAP_PT_reconstruct")
    assert "No part" in error_of(bpy.ops.sparse_mocap.next_poor_part)


def test_what_is_not_said_comes_in_best_quality():
    choose_files()
    assert settings().offline
    asked = []
    module = addon("session.reconstruct")
    solve = module.reconstruct

    def noted(*arguments, best_quality, **options):
        asked.append(best_quality)
        return solve(*arguments, best_quality=best_quality, **options)

    module.reconstruct = noted
    try:
        bpy.ops.sparse_mocap.reconstruct()
        reconstruct(offline=False)
        bpy.ops.sparse_mocap.reconstruct(method="tautges2011")
    finally:
        module.reconstruct = solve
    has_best = addon("session.methods").has_best_quality("tautges2011")
    assert asked == [True, False, has_best]
