# SPDX-License-Identifier: GPL-3.0-or-later
"""The modal operators need a window: another Blender with one, on the display there is."""

import os
import subprocess
import tempfile
from pathlib import Path

import bpy
from support import Skipped, library

SCRIPT = Path(__file__).parent / "window_script.py"


def _in_window(scenario: str, tmp_path: Path) -> None:
    if not bpy.app.binary_path:
        raise Skipped("a bpy module opens no window")
    if not os.environ.get("DISPLAY"):
        raise Skipped("there is no display")
    options = ["--factory-startup", "-noaudio", "--enable-event-simulate"]
    files = [library().motions, library().database, library().take, tmp_path]
    command = [bpy.app.binary_path, *options, "--python", SCRIPT, "--", scenario]
    with tempfile.TemporaryDirectory() as settings:
        own = {"BLENDER_USER_CONFIG": settings, "LIBGL_ALWAYS_SOFTWARE": "1"}
        done = subprocess.run(
            [*command, *map(str, files)],
            env={**os.environ, **own},
            capture_output=True,
            text=True,
            timeout=240,
        )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Traceback" not in done.stdout + done.stderr, done.stdout + done.stderr


def test_modal_reconstruction_is_one_undo_step(tmp_path):
    _in_window("reconstruct", tmp_path)


def test_escape_leaves_no_file(tmp_path):
    _in_window("escape", tmp_path)


def test_escape_while_a_take_is_put_on_a_character_leaves_nothing(tmp_path):
    _in_window("bake_escaped", tmp_path)


def test_cancel_button_leaves_no_file(tmp_path):
    _in_window("cancel", tmp_path)


def test_undo_meanwhile_does_no_harm(tmp_path):
    _in_window("undo", tmp_path)


def test_another_file_meanwhile_ends_the_job(tmp_path):
    _in_window("load", tmp_path)


def test_unregister_meanwhile_ends_the_job(tmp_path):
    _in_window("unregister", tmp_path)


def test_quitting_meanwhile_leaves_no_file(tmp_path):
    _in_window("quit", tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_the_last_operator_can_be_adjusted(tmp_path):
    _in_window("adjust", tmp_path)


def test_import_is_one_undo_step_and_does_not_freeze_the_window(tmp_path):
    _in_window("import", tmp_path)


def test_escape_while_keys_are_set_leaves_nothing(tmp_path):
    _in_window("import_escaped", tmp_path)


def test_undo_while_keys_are_set_does_no_harm(tmp_path):
    _in_window("import_undone", tmp_path)


def test_import_through_the_file_browser(tmp_path):
    _in_window("import_chosen", tmp_path)


def test_import_of_a_dropped_file(tmp_path):
    _in_window("dropped", tmp_path)


def test_leaving_the_import_dialog_does_nothing(tmp_path):
    _in_window("import_left", tmp_path)


def test_a_previewed_clip_plays(tmp_path):
    _in_window("preview", tmp_path)
