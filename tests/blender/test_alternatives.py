# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes that leave several motions possible: A, B and C to choose from."""

from __future__ import annotations

import atexit
import shutil
import tempfile
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock

import bpy
import numpy as np
import rigs
from rig_baking import points_of
from support import addon, error_of, settings

_BONES = ("mixamorig:Hips", "mixamorig:Head", "mixamorig:LeftHand", "mixamorig:RightFoot")
_NAMES = ["ankle", "ankle B", "ankle C"]
_CLIPS = ("walk_01", "walk_02", "squat_01", "squat_02", "kickleft_01", "kickright_01")


@cache
def _doubtful() -> tuple[str, str]:
    """A database, and a take of one ankle alone, which leaves much open."""
    import sparse_mocap
    from sparse_mocap.demo_motions import generate_library, generate_performance

    folder = Path(tempfile.mkdtemp(prefix="sparse_mocap_alternatives_"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    files = generate_library(folder / "all")
    (folder / "motions").mkdir()
    for path in files:
        if path.stem in [f"{actor}_{clip}" for actor in ("ada", "bruno") for clip in _CLIPS]:
            shutil.copy(path, folder / "motions")
    sparse_mocap.build_database([folder / "motions"], folder / "library.smdb", mirror=True)
    performance = sparse_mocap.read_motion(generate_performance(folder / "performance.bvh"))[0]
    motion, _ = sparse_mocap.standard_motion(performance)
    take = folder / "ankle.csv"
    sparse_mocap.write_take(take, sparse_mocap.simulated(motion, ["right_ankle"], 100.0))
    return str(folder / "library.smdb"), str(take)


def _solve(armature, *, alternatives: bool = True):
    database, take = _doubtful()
    settings().database, settings().target = database, armature
    bpy.ops.sparse_mocap.load_take(filepath=take)
    settings().alternatives, settings().foot_lock = alternatives, 0.0
    assert bpy.ops.sparse_mocap.reconstruct(offline=True) == {"FINISHED"}
    return armature.animation_data.action


def _shown(armature) -> str:
    return addon("scene.performance").facts_of(armature.animation_data.action).letter


def _drawn() -> tuple[str, list[str]]:
    """The labels of the panel, and the texts of its buttons."""
    layout = MagicMock()
    for part in ("row", "column", "box", "split"):
        getattr(layout, part).return_value = layout
    panel = addon("ui.reconstruct").SPARSEMOCAP_PT_reconstruct
    panel.draw(SimpleNamespace(layout=layout), bpy.context)
    labels = " ".join(call.kwargs.get("text", "") for call in layout.label.call_args_list)
    return " ".join(labels.split()), [
        call.kwargs.get("text", "") for call in layout.operator.call_args_list
    ]


def test_the_animator_flips_between_the_motions_of_a_take():
    armature = rigs.named_rig("mixamo")
    first = _solve(armature)
    performance = addon("scene.performance")
    others = performance.alternatives_of(first)
    assert list(others) == ["A", "B", "C"]
    assert others["A"] == first
    assert [action.name for action in bpy.data.actions] == _NAMES
    assert others["B"].use_fake_user
    assert settings().takes[0].letters == "A/B/C"
    parts = addon("session.reconstruct").kept("ankle B").differences
    begin_s, end_s, _ = parts[0]
    farthest = max(parts, key=lambda part: part[2])
    facts = performance.facts_of(others["B"])
    assert facts.differences.startswith(f"{begin_s:.1f}-{end_s:.1f} s (")
    middle = round(facts.frame_at(0.5 * (farthest[0] + farthest[1])))
    frames = [round(facts.frame_at(begin_s - 1.0)), middle]
    before = points_of(armature, frames, _BONES)
    assert {"A", "B"} <= set(_drawn()[1])
    assert "Differs from A" not in _drawn()[0]
    assert bpy.ops.sparse_mocap.show_alternative(letter="B") == {"FINISHED"}
    assert armature.animation_data.action == others["B"]
    after = points_of(armature, frames, _BONES)
    assert f"Differs from A: {begin_s:.1f}-{end_s:.1f} s" in _drawn()[0]
    # The floor is that of the whole motion.
    assert np.abs(after[0] - before[0]).max() < 1e-3
    assert np.abs(after[1] - before[1]).max() > 0.1
    assert bpy.ops.sparse_mocap.show_alternative(letter="A") == {"FINISHED"}
    assert armature.animation_data.action == first
    assert np.abs(points_of(armature, frames, _BONES) - before).max() < 1e-6


def test_an_alternative_is_updated_alone():
    armature = rigs.named_rig("mixamo")
    _solve(armature)
    bpy.ops.sparse_mocap.show_alternative(letter="B")
    settings().smooth_s = 0.2
    assert bpy.ops.sparse_mocap.update_action() == {"FINISHED"}
    assert [action.name for action in bpy.data.actions] == _NAMES
    assert _shown(armature) == "B"
    found = addon("scene.performance").alternatives_of(armature.animation_data.action)
    assert list(found) == ["A", "B", "C"]
    bpy.ops.sparse_mocap.show_alternative(letter="A")
    assert bpy.ops.sparse_mocap.update_action() == {"FINISHED"}
    assert _shown(armature) == "A"
    assert [action.name for action in bpy.data.actions] == _NAMES


def test_the_figure_of_the_add_on_gets_them_too():
    settings().database, take = _doubtful()
    bpy.ops.sparse_mocap.load_take(filepath=take)
    assert bpy.ops.sparse_mocap.reconstruct(offline=True, alternatives=True) == {"FINISHED"}
    figure = bpy.context.view_layer.objects.active
    assert len([obj for obj in bpy.data.objects if obj.type == "ARMATURE"]) == 1
    assert _shown(figure) == "A"
    assert bpy.ops.sparse_mocap.show_alternative(letter="B") == {"FINISHED"}
    assert _shown(figure) == "B"


def test_without_them_a_take_is_one_motion():
    armature = rigs.named_rig("mixamo")
    action = _solve(armature, alternatives=False)
    assert addon("scene.performance").alternatives_of(action) == {}
    assert len(bpy.data.actions) == 1
    assert settings().takes[0].letters == ""
    assert "A" not in _drawn()[1]
    message = error_of(lambda: bpy.ops.sparse_mocap.show_alternative(letter="B"))
    assert message == "This take has no alternative B: tick Alternatives and press Reconstruct"
    # Live quality has none, whatever the setting says.
    settings().alternatives = True
    assert bpy.ops.sparse_mocap.reconstruct(offline=False) == {"FINISHED"}
    assert len(bpy.data.actions) == 2
