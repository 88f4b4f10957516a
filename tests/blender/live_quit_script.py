# SPDX-License-Identifier: GPL-3.0-or-later
"""Connects to sensors and ends Blender: live_quit_script.py -- HOW PORT FOLDER SERIAL_FOLDER"""

import os
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).parent))
import installed

installed.prepare_paths()
HOW, PORT, FOLDER, SERIAL = sys.argv[sys.argv.index("--") + 1 :]
sys.path.append(SERIAL)

from live_support import DRIVER, OPTIONS, until  # noqa: E402

installed.register()
live, sensors = installed.module("session.live"), installed.module("session.sensors")
live.begin(sensors.new_session(sensors.Port(PORT, DRIVER, options=OPTIONS), Path(FOLDER)))
session = live.current()
until(lambda: session.state.error or session.state.is_connected)
assert not session.state.error, session.state.error
from sparse_mocap.capture import CaptureClient  # noqa: E402

print("connected", CaptureClient.running()[0].pid, flush=True)
if HOW == "crash":
    os.abort()
bpy.ops.wm.quit_blender()
