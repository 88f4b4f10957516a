# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs and enables an add-on of the older form: blender -b --python install_addon.py -- ZIP."""

import sys
import zipfile

import bpy

path = sys.argv[sys.argv.index("--") + 1]
bpy.ops.preferences.addon_install(filepath=path)
with zipfile.ZipFile(path) as archive:
    module = archive.namelist()[0].partition("/")[0]
assert bpy.ops.preferences.addon_enable(module=module) == {"FINISHED"}
bpy.ops.wm.save_userpref()
