# SPDX-License-Identifier: GPL-3.0-or-later
"""Real sensors in a Blender with a window, on the display there is."""

import os
import shutil
import subprocess
from pathlib import Path

import bpy
from live_support import emulated, own_runtime, serial_folder, until
from processes import is_alive
from support import Skipped, library

SCRIPT = Path(__file__).parent / "live_window_script.py"
TIMEOUT_S = 240.0


def test_the_armature_is_live_while_the_timeline_plays(tmp_path):
    if not bpy.app.binary_path:
        raise Skipped("a bpy module opens no window")
    if not os.environ.get("DISPLAY"):
        raise Skipped("there is no display")
    serial = serial_folder()
    import sparse_mocap
    from sparse_mocap.capture import CaptureClient

    (tmp_path / "runtime").mkdir(mode=0o700)
    (tmp_path / "settings").mkdir()
    pictures = os.environ.get("SPARSE_MOCAP_PICTURES")
    own = {"BLENDER_USER_CONFIG": str(tmp_path / "settings"), "LIBGL_ALWAYS_SOFTWARE": "1"}
    options = ["--factory-startup", "-noaudio", "--enable-event-simulate"]
    options += ["--python-exit-code", "1"]
    options += ["--window-geometry", "0", "0", "1280", "800"]
    readings = sparse_mocap.read_take(library().take)
    with own_runtime(tmp_path / "runtime"), emulated(readings) as port:
        arguments = [port, str(library().database), str(tmp_path), str(serial)]
        done = subprocess.run(
            [bpy.app.binary_path, *options, "--python", str(SCRIPT), "--", *arguments],
            env={**os.environ, **own}, capture_output=True, text=True, timeout=TIMEOUT_S,
        )  # fmt: skip
        print(done.stdout)
        assert done.returncode == 0, done.stdout + done.stderr
        assert "Traceback" not in done.stdout + done.stderr, done.stdout + done.stderr
        for capture in CaptureClient.running():
            until(lambda pid=capture.pid: not is_alive(pid))
    [take] = (tmp_path / "takes").glob("take-*.csv")
    assert sparse_mocap.read_take(take).end_s > 1.0
    if pictures:
        for picture in tmp_path.glob("*.png"):
            shutil.copy(picture, pictures)
