# SPDX-License-Identifier: GPL-3.0-or-later
"""The README's Python does in Blender what it says, on generated files of the names it has."""

import os
import re
import shutil
from contextlib import chdir

import bpy
from readme_blocks import blocks
from support import library


def _files_it_names(code, folder):
    """Motions in the folder, the take, and the .amc with the .asf beside it."""
    import sparse_mocap

    shutil.copytree(library().motions, folder / "mocap")
    shutil.copy(library().take, folder / "take.csv")
    for name in re.findall(r"\"([^\"]+)\.amc\"", code):
        motion, _ = sparse_mocap.read_motion(sorted(library().motions.iterdir())[0])
        sparse_mocap.write_acclaim(folder / f"{name}.amc", motion)


def test_its_python_runs(tmp_path):
    code = [
        block.text
        for block in blocks()
        if block.language == "python" and "import bpy" in block.text
    ]
    assert code
    for text in code:
        folder = tmp_path / str(len(os.listdir(tmp_path)))
        folder.mkdir()
        _files_it_names(text, folder)
        armatures = len(bpy.data.armatures)
        with chdir(folder):
            exec(compile(text, "README.md", "exec"), {"__name__": "readme"})
        assert text.count("reconstruct(") + text.count("import_acclaim(") == (
            len(bpy.data.armatures) - armatures
        )
