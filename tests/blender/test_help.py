# SPDX-License-Identifier: GPL-3.0-or-later
"""What a bug report needs, while all works."""

from __future__ import annotations

import re
from pathlib import Path

import bpy
import rigs
from rig_baking import bake
from support import addon, choose_files, error_of, settings


def _report() -> str:
    """Without a window there is no clipboard: the text that would go there."""
    module = addon("ops.copy_report")
    copied = []
    report = module.report
    module.report = lambda *arguments: copied.append(report(*arguments)) or copied[-1]
    try:
        assert bpy.ops.sparse_mocap.copy_report() == {"FINISHED"}
    finally:
        module.report = report
    return copied[0]


def test_the_report_says_what_is_open_and_what_went_wrong():
    text = _report()
    assert "The add-on works" in text
    assert "Database: none" in text
    choose_files()
    bake(rigs.named_rig("mixamo"))
    settings().take = "not there.csv"
    error_of(bpy.ops.sparse_mocap.reconstruct)
    settings().take = ""
    text = _report()
    assert f"Blender {bpy.app.version_string}" in text
    assert re.search(r"Database: \d+ clips, ", text)
    assert "Method: path_regression, default, no options, best quality" in text
    assert "plays 3.9 s" in text
    assert "Log:" in text
    assert "WARNING not there.csv" in text
    assert str(Path.home()) + "/" not in text


def test_the_log_is_beside_the_settings_and_closed_with_the_add_on():
    log_file = addon("session.log_file")
    path = log_file.path()
    assert path is not None
    assert path.name == "sparse_mocap.log"
    assert "Sparse Mocap" in path.read_text("utf-8")
    addon("ops.registration").log_file.end()
    assert log_file.path() is None
